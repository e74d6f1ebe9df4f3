// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/progress.h"

#include <cmath>
#include <cstdio>
#include <utility>

#include <spdlog/fmt/fmt.h>
#include <unistd.h>

namespace vdbmap::cli {
namespace {

constexpr std::chrono::milliseconds kPause(100);  // between two prints: often enough for the eye
constexpr const char* kClearLine = "\r\033[K";

std::string duration_text(double seconds) {
  const auto whole = static_cast<long>(std::ceil(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

}  // namespace

std::string progress_text(const std::string& activity, std::size_t done, std::size_t total,
                          std::chrono::duration<double> elapsed) {
  std::string text = fmt::format("{}: {} of {}", activity, done, total);
  if (done == 0 || elapsed.count() <= 0) return text;

  const double rate = static_cast<double>(done) / elapsed.count();  // [1/s]
  text += fmt::format(", {:.{}f}/s", rate, rate < 10 ? 1 : 0);
  if (done < total) text += ", " + duration_text(static_cast<double>(total - done) / rate) + " left";
  return text;
}

Progress::Progress(std::string activity, std::size_t total, const CommonOptions& options)
    : activity_(std::move(activity)), total_(total), shown_(!options.quiet && ::isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (shown_) std::fputs(kClearLine, stderr);
}

void Progress::advance(std::size_t steps) {
  if (!shown_) return;
  const std::lock_guard lock(mutex_);
  done_ += steps;
  const Clock::time_point now = Clock::now();
  if (now - last_print_ < kPause) return;
  last_print_ = now;
  std::fputs((kClearLine + progress_text(activity_, done_, total_, now - start_)).c_str(), stderr);
}

}  // namespace vdbmap::cli
