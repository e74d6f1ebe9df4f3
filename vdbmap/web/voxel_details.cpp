// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/web/voxel_details.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace vdbmap {
namespace {

static_assert(std::endian::native == std::endian::little, "details are written as they lie in memory");

// In the bytes of the file.
struct Detail {
  std::uint32_t count;
  std::array<float, 3> mean;
  std::array<float, 6> covariance;
  LabelCode label;
  std::array<std::int8_t, 3> normal;
};
static_assert(sizeof(Detail) == kDetailBytes);

Detail detail_of(const TileLevel& source, const TilePoint& point, std::size_t number) {
  const VoxelRecord& record = source.level.records()[number];
  const Eigen::Vector3f mean = mean_of(record, VoxelIndex(0, 0, 0), source.level.voxel_size()).cast<float>();
  const Eigen::Vector3d normal = normal_of(record);
  const auto code = [](double unit) { return static_cast<std::int8_t>(std::lround(127 * unit)); };
  return {record.count,
          {mean.x(), mean.y(), mean.z()},
          record.covariance,
          point.label,
          {code(normal.x()), code(normal.y()), code(normal.z())}};
}

}  // namespace

std::string details_of(const TileLevel& source, std::span<const TileBlock> blocks) {
  std::string bytes;
  for (const TileBlock& block : blocks) {
    for (std::size_t i = 0; i < block.points.size(); ++i) {
      const Detail detail = detail_of(source, block.points[i], block.records[i]);
      bytes.append(reinterpret_cast<const char*>(&detail), sizeof(detail));
    }
  }
  return bytes;
}

}  // namespace vdbmap
