// SPDX-License-Identifier: GPL-3.0-or-later
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/raw_files.h"
#include "tests/tools/map_command.h"
#include "vdbmap/io/kitti/kitti_bin.h"
#include "vdbmap/io/las/las.h"
#include "vdbmap/io/ply/ply.h"

namespace vdbmap::cli {
namespace {

using test::read_raw;
using test::write_raw;

// An input that is wrong, and what the one line must say of it.
struct BrokenInput {
  std::string name;
  std::string part;
  std::function<std::vector<std::string>(const test::TemporaryFolder&)> write;  // returns the command's inputs
};

// GoogleTest prints parameters.
std::ostream& operator<<(std::ostream& stream, const BrokenInput& input) { return stream << input.name; }

std::string truncated(const std::filesystem::path& path, std::size_t num_bytes) {
  const std::string bytes = read_raw(path);
  return write_raw(path, bytes.substr(0, bytes.size() - num_bytes));
}

// Two scans and the text of their poses.
std::vector<std::string> scans_and_poses(const test::TemporaryFolder& folder, const std::string& poses) {
  std::filesystem::create_directories(folder / "scans");
  for (const char* name : {"0.bin", "1.bin"}) write_kitti_bin(folder / "scans" / name, scan(1, 100));
  write_raw(folder / "poses.txt", poses);
  return {folder / "scans", "--poses", folder / "poses.txt"};
}

const std::string kPose = "1 0 0 0 0 1 0 0 0 0 1 0\n";

std::vector<BrokenInput> broken_inputs() {
  using Folder = test::TemporaryFolder;
  using Arguments = std::vector<std::string>;
  return {
      {"Empty", "bad.ply: ", [](const Folder& f) { return Arguments{write_raw(f / "bad.ply", "")}; }},
      {"NoPoints", "bad.ply: the file holds no points",
       [](const Folder& f) {
         return Arguments{write_raw(f / "bad.ply",
                                    "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
                                    "property float z\nend_header\n")};
       }},
      {"OnlyNan", "bad.xyz: none of the 2 points is finite",
       [](const Folder& f) { return Arguments{write_raw(f / "bad.xyz", "nan nan nan\n1 inf 1\n")}; }},
      {"Truncated", "bad.ply: 1 points that the header promises are missing (it promises 100, the file holds 99)",
       [](const Folder& f) {
         write_ply(f / "bad.ply", scan(1, 100));
         return Arguments{truncated(f / "bad.ply", 1), "--strict"};
       }},
      {"TruncatedScan", "bad.bin: ",
       [](const Folder& f) {
         write_kitti_bin(f / "bad.bin", scan(1, 100));
         return Arguments{truncated(f / "bad.bin", 3), "--strict"};
       }},
      {"BadFileAfterAGoodOne", "bad.ply: ",
       [](const Folder& f) {
         write_ply(f / "good.ply", scan(1, 100));
         return Arguments{f / "good.ply", write_raw(f / "bad.ply", "ply\n")};
       }},
      {"BeyondTheRange", "m from the anchor, the farthest that voxel ids reach",
       [](const Folder& f) {
         write_ply(f / "far.ply", points({{0, 0, 0}, {200'000, 0, 0}}));
         return Arguments{f / "far.ply"};
       }},
      {"BeyondTheRangeByFile", "far.ply: point ",
       [](const Folder& f) {
         write_ply(f / "near.ply", points({{0, 0, 0}}));
         write_ply(f / "far.ply", points({kUtm}));
         return Arguments{f / "near.ply", f / "far.ply"};
       }},
      {"FolderWithoutScans", "empty: the folder holds no point files",
       [](const Folder& f) {
         std::filesystem::create_directory(f / "empty");
         return Arguments{f / "empty"};
       }},
      {"FewerPosesThanScans", "poses.txt: 1 poses for 2 scans",
       [](const Folder& f) { return scans_and_poses(f, kPose); }},
      {"FewerPosesThanScansOfASelection", "poses.txt: 1 poses for 2 scans",
       [](const Folder& f) {
         Arguments arguments = scans_and_poses(f, kPose);
         arguments.insert(arguments.end(), {"--every", "2"});
         return arguments;
       }},
      {"NoRotation", "poses.txt:2: matrix is not a rotation",
       [](const Folder& f) { return scans_and_poses(f, kPose + "2 0 0 0 0 1 0 0 0 0 1 0\n"); }},
      {"Reflection", "poses.txt:1: matrix is not a rotation",
       [](const Folder& f) { return scans_and_poses(f, "-1 0 0 0 0 1 0 0 0 0 1 0\n" + kPose); }},
      {"NoPoseAtAll", "poses.txt: none of the chosen scans has a pose",
       [](const Folder& f) {
         const std::string missing = "nan nan nan nan nan nan nan nan nan nan nan nan\n";
         return scans_and_poses(f, missing + missing);
       }},
      {"PosesOutOfRange", "1.bin: point ",
       [](const Folder& f) { return scans_and_poses(f, kPose + "1 0 0 1e300 0 1 0 0 0 0 1 0\n"); }},
      {"EpsgCodesThatDisagree", "b.las: is in EPSG:32632, files before it are in EPSG:25832",
       [](const Folder& f) {
         write_las(f / "a.las", moved(scan(1, 100), kUtm), {.epsg = 25832});
         write_las(f / "b.las", moved(scan(1, 100), kUtm), {.epsg = 32632});
         return Arguments{f / "a.las", f / "b.las"};
       }},
  };
}

class BuildRefuses : public testing::TestWithParam<BrokenInput> {};

TEST_P(BuildRefuses, InOneLineAndLeavesNoFile) {
  const test::TemporaryFolder folder;
  const test::TemporaryFolder target;
  std::vector<std::string> arguments = GetParam().write(folder);
  arguments.insert(arguments.begin(), {"build", "-o", target / "map.vdb"});
  for (const std::string threads : {"1", "2"}) {
    std::vector<std::string> with_threads = arguments;
    with_threads.insert(with_threads.end(), {"--threads", threads});
    expect_error(vdbmap(with_threads), ExitCode::kBadInput, GetParam().part);
  }
  EXPECT_TRUE(std::filesystem::is_empty(target.path()));
}

INSTANTIATE_TEST_SUITE_P(Input, BuildRefuses, testing::ValuesIn(broken_inputs()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace vdbmap::cli
