// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/folders.h"
#include "tests/support/run_command.h"
#include "tools/cli/exit_code.h"
#include "vdbmap/core/point_cloud.h"

namespace vdbmap::cli {

/// [m] a place in UTM zone 32.
extern const Eigen::Vector3d kUtm;

/// Runs the command that was built.
test::CommandResult vdbmap(const std::vector<std::string>& arguments);

/// What the command prints with --json; expects that it succeeds.
nlohmann::json json_of(std::vector<std::string> arguments);

std::size_t num_lines(const std::string& text);

/// Expects the code, nothing on stdout, and one line on stderr with `part` in it.
void expect_error(const test::CommandResult& result, ExitCode code, const std::string& part);

/// A scan of ground and a wall around the origin, with intensities.
PointCloud scan(unsigned seed, std::size_t count = 5'000);

PointCloud points(std::vector<Eigen::Vector3d> positions);
PointCloud moved(PointCloud cloud, const Eigen::Vector3d& offset);

/// A folder with point files and the maps made of them.
class MapCommand : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_ / name; }

  /// Writes a cloud; returns its path.
  std::string ply(const std::string& name, const PointCloud& cloud) const;

  /// Builds the map `name` of a cloud that lies beside it as "<name>.ply"; returns its path.
  std::string built(const std::string& name, const PointCloud& cloud, std::vector<std::string> options = {}) const;

  /// A folder of scans "0.bin", "1.bin", ..., each a metre further along x and turned, and their poses in "poses.txt";
  /// returns its path.
  std::string scans(std::size_t count) const;

  /// Builds the map `name` of some files.
  void build(const std::vector<std::string>& inputs, const std::string& name,
             const std::vector<std::string>& options = {}) const;

  void expect_same_bytes(const std::string& name_a, const std::string& name_b) const;

  test::TemporaryFolder folder_;
};

}  // namespace vdbmap::cli
