// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/city_lock.h"

#include <array>
#include <csignal>
#include <filesystem>
#include <optional>
#include <string>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "vdbmap/core/error.h"

namespace vdbmap {
namespace {

// An empty folder, gone at the end.
class EmptyCity {
 public:
  EmptyCity() {
    std::string name = (std::filesystem::temp_directory_path() / "city_lock.XXXXXX").string();
    if (::mkdtemp(name.data())) path_ = name;
  }
  ~EmptyCity() { std::filesystem::remove_all(path_); }
  EmptyCity(const EmptyCity&) = delete;
  EmptyCity& operator=(const EmptyCity&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// What a writer is told that comes second; empty where it may write.
std::string refusal(const std::filesystem::path& city) {
  try {
    const CityLock lock(city);
    return "";
  } catch (const IoError& error) {
    return error.what();
  }
}

// A process that holds the lock until it is killed.
pid_t start_holder(const std::filesystem::path& city) {
  std::array<int, 2> ready{};
  if (::pipe(ready.data()) != 0) return -1;
  const pid_t child = ::fork();
  if (child == 0) {
    const CityLock lock(city);
    if (::write(ready[1], "x", 1) == 1) ::pause();
    ::_exit(0);
  }
  ::close(ready[1]);
  char byte = 0;
  const bool has_lock = ::read(ready[0], &byte, 1) == 1;
  ::close(ready[0]);
  return has_lock ? child : -1;
}

TEST(CityLock, ASecondWriterIsToldProcessAndHostOfTheFirst) {
  const EmptyCity city;
  const pid_t holder = start_holder(city.path());
  ASSERT_GT(holder, 0);

  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  const std::string expected = "process " + std::to_string(holder) + " on " + host.data() + " is writing it";
  EXPECT_NE(refusal(city.path()).find(expected), std::string::npos) << refusal(city.path());

  ::kill(holder, SIGKILL);
  ::waitpid(holder, nullptr, 0);
}

TEST(CityLock, EndsWithAProcessThatIsKilled) {
  const EmptyCity city;
  const pid_t holder = start_holder(city.path());
  ASSERT_GT(holder, 0);
  ASSERT_NE(refusal(city.path()), "");

  ::kill(holder, SIGKILL);
  ::waitpid(holder, nullptr, 0);

  EXPECT_EQ(refusal(city.path()), "");
}

TEST(CityLock, EndsWithItsObject) {
  const EmptyCity city;
  std::optional<CityLock> lock(std::in_place, city.path());
  EXPECT_NE(refusal(city.path()), "");

  lock.reset();

  EXPECT_EQ(refusal(city.path()), "");
}

TEST(CityLock, AMissingFolderIsNamed) {
  const EmptyCity city;
  const std::string text = refusal(city.path() / "none");
  EXPECT_NE(text.find("none: cannot be written"), std::string::npos) << text;
}

}  // namespace
}  // namespace vdbmap
