// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/segmentation/voxel_features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <utility>
#include <vector>

#include "vdbmap/core/parallel.h"

namespace vdbmap::parking {
namespace {

constexpr double kColumnSize = 0.5;  // [m]
constexpr int kNearReach = 2;        // [columns] to each side
constexpr int kFarReach = 8;
constexpr double kHeightUnit = 2;  // [m]
constexpr double kPointsUnit = 6;

// A column of 0.5 m.
struct Column {
  std::int32_t x;
  std::int32_t y;

  bool operator==(const Column&) const = default;
};

Column column_of(const Eigen::Vector3d& point) {
  return {static_cast<std::int32_t>(std::floor(point.x() / kColumnSize)),
          static_cast<std::int32_t>(std::floor(point.y() / kColumnSize))};
}

// Heights of columns in blocks of 32 x 32, those that hold a voxel.
class ColumnHeights {
 public:
  static constexpr int kSide = 32;
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  using Block = std::array<double, kSide * kSide>;

  double& at(const Column& column) {
    Block& block = blocks_.try_emplace(key_of(column), filled()).first->second;
    return block[place_of(column)];
  }

  // The lowest of the columns up to `reach` away.
  double lowest_around(const Column& column, int reach) const {
    double lowest = kNone;
    for (std::int32_t x = column.x - reach; x <= column.x + reach;) {
      const std::int32_t x_end = std::min((x | (kSide - 1)) + 1, column.x + reach + 1);
      for (std::int32_t y = column.y - reach; y <= column.y + reach;) {
        const std::int32_t y_end = std::min((y | (kSide - 1)) + 1, column.y + reach + 1);
        const auto block = blocks_.find(key_of({x, y}));
        if (block != blocks_.end()) lowest = std::min(lowest, lowest_in(block->second, {x, y}, {x_end, y_end}));
        y = y_end;
      }
      x = x_end;
    }
    return lowest;
  }

  std::vector<Column> columns() const {
    std::vector<Column> all;
    for (const auto& [key, block] : blocks_) {
      const auto x = static_cast<std::int32_t>(key >> 32) * kSide;
      const auto y = static_cast<std::int32_t>(key & 0xffffffff) * kSide;
      for (int i = 0; i < kSide * kSide; ++i) {
        if (block[static_cast<std::size_t>(i)] != kNone) all.push_back({x + i / kSide, y + i % kSide});
      }
    }
    return all;
  }

 private:
  static Block filled() {
    Block block;
    block.fill(kNone);
    return block;
  }

  static std::uint64_t key_of(const Column& column) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(column.x >> 5)) << 32 |
           static_cast<std::uint32_t>(column.y >> 5);
  }

  static std::size_t place_of(const Column& column) {
    return static_cast<std::size_t>((column.x & (kSide - 1)) * kSide + (column.y & (kSide - 1)));
  }

  static double lowest_in(const Block& block, const Column& low, const Column& end) {
    double lowest = kNone;
    for (std::int32_t x = low.x; x < end.x; ++x) {
      const double* row = block.data() + place_of({x, low.y});
      for (std::int32_t y = 0; y < end.y - low.y; ++y) lowest = std::min(lowest, row[y]);
    }
    return lowest;
  }

  std::unordered_map<std::uint64_t, Block> blocks_;
};

// The lowest mean around each column, within the small window and within the large one.
std::pair<ColumnHeights, ColumnHeights> lowest_around(const ColumnHeights& lowest) {
  std::pair<ColumnHeights, ColumnHeights> result;
  const std::vector<Column> columns = lowest.columns();
  std::vector<std::pair<double*, double*>> places;
  places.reserve(columns.size());
  for (const Column& column : columns) places.emplace_back(&result.first.at(column), &result.second.at(column));
  parallel_for(
      columns.size(),
      [&](std::size_t i) {
        *places[i].first = lowest.lowest_around(columns[i], kNearReach);
        *places[i].second = lowest.lowest_around(columns[i], kFarReach);
      },
      256);
  return result;
}

float height_feature(double height, double lowest) {
  return static_cast<float>(std::clamp((height - lowest) / kHeightUnit, -1.0, 4.0));
}

}  // namespace

Rows voxel_features(const VoxelLevel& finest) {
  const std::span<const VoxelRecord> records = finest.records();
  std::vector<Eigen::Vector3d> means(finest.size());
  parallel_for_each_voxel(finest, [&](const VoxelIndex& voxel, std::size_t number) {
    means[number] = mean_of(records[number], voxel, finest.voxel_size());
  });
  ColumnHeights lowest;
  for (const Eigen::Vector3d& mean : means) {
    double& height = lowest.at(column_of(mean));
    height = std::min(height, mean.z());
  }
  auto [near, far] = lowest_around(lowest);

  Rows features(static_cast<Eigen::Index>(finest.size()), static_cast<Eigen::Index>(kNumFeatures));
  for (std::size_t i = 0; i < means.size(); ++i) {
    const Column column = column_of(means[i]);
    const double points = std::log2(static_cast<double>(records[i].count)) / kPointsUnit;
    features.row(static_cast<Eigen::Index>(i)) << 1.0F, height_feature(means[i].z(), near.at(column)),
        height_feature(means[i].z(), far.at(column)), static_cast<float>(std::min(points, 2.0));
  }
  return features;
}

}  // namespace vdbmap::parking
