// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/city_folders.h"

#include <random>

#include "tests/support/raw_files.h"
#include "tests/support/sample_maps.h"
#include "vdbmap/core/map_builder.h"

namespace vdbmap::test {

const VoxelMap& street_of_tiles() {
  static const VoxelMap map = [] {
    std::mt19937 random(3);
    const auto number = [&] { return static_cast<double>(random()) * 0x1p-32; };
    PointCloud cloud;
    for (int i = 0; i < 10'000; ++i) {
      cloud.positions.emplace_back();
      for (const double factor : {300.0, 150.0, 4.0}) {
        const int axis = factor == 300 ? 0 : factor == 150 ? 1 : 2;
        cloud.positions.back()[axis] = factor * number() - factor / 2 + 5;
      }
      cloud.intensities.push_back(static_cast<float>(number()));
      cloud.labels.push_back(static_cast<std::uint16_t>(3 * number()));
    }
    BuildOptions options = anchored(Eigen::Vector3d::Zero());
    options.voxel_sizes = {0.1, 1, 8};
    options.epoch = 4;
    return build_map(cloud, options);
  }();
  return map;
}

std::map<std::string, std::string> files_of_city(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file() && entry.path().filename() != "lock") {
      files[std::filesystem::relative(entry.path(), folder).string()] = read_raw(entry.path());
    }
  }
  return files;
}

}  // namespace vdbmap::test
