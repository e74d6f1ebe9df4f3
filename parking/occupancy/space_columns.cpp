// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/occupancy/space_columns.h"

#include "parking/spaces/outline.h"

namespace vdbmap::parking {

SpaceColumns::SpaceColumns(const ParkingSpace& space, const GroundPlane& ground) : ground_(ground) {
  const UprightBox box = box_of(space);
  middle_ = box.center.head<2>();
  along_ = box.along();
  across_ = box.across();
  corner_ = middle_ - box.length / 2 * along_ - box.width / 2 * across_;
  radius_ = std::hypot(box.length, box.width) / 2;
  const auto count = [](double size) {
    return std::max<std::int32_t>(1, static_cast<std::int32_t>(std::lround(size / kEdge)));
  };
  count_u_ = count(box.length);
  count_v_ = count(box.width);
  edge_u_ = box.length / count_u_;
  edge_v_ = box.width / count_v_;
  for (std::int32_t u = 0; u < count_u_; ++u) {
    for (std::int32_t v = 0; v < count_v_; ++v) {
      const Eigen::Vector2d place = corner_ + (u + 0.5) * edge_u_ * along_ + (v + 0.5) * edge_v_ * across_;
      columns_.push_back(contains(space.outline, place) ? static_cast<std::int32_t>(num_columns_++) : kOutside);
    }
  }
  is_inner_.resize(num_columns_);
  for (std::int32_t u = 1; u + 1 < count_u_; ++u) {
    for (std::int32_t v = 1; v + 1 < count_v_; ++v) {
      std::int32_t num_there = 0;  // of it and its eight neighbours
      for (std::int32_t side = 0; side < 9; ++side) {
        const std::int32_t near = columns_[static_cast<std::size_t>((u + side / 3 - 1) * count_v_ + v + side % 3 - 1)];
        num_there += near != kOutside ? 1 : 0;
      }
      const std::int32_t column = columns_[static_cast<std::size_t>(u * count_v_ + v)];
      if (column != kOutside) is_inner_[static_cast<std::size_t>(column)] = num_there == 9 ? 1 : 0;
    }
  }
}

std::optional<std::size_t> SpaceColumns::column_at(double u, double v) const {
  if (!(u >= 0 && v >= 0 && u < edge_u_ * count_u_ && v < edge_v_ * count_v_)) return std::nullopt;
  const auto cell_u = std::min(static_cast<std::int32_t>(u / edge_u_), count_u_ - 1);
  const auto cell_v = std::min(static_cast<std::int32_t>(v / edge_v_), count_v_ - 1);
  const std::int32_t column = columns_[static_cast<std::size_t>(cell_u * count_v_ + cell_v)];
  return column == kOutside ? std::nullopt : std::optional(static_cast<std::size_t>(column));
}

std::vector<Eigen::Vector3d> SpaceColumns::middles() const {
  std::vector<Eigen::Vector3d> middles(num_columns_);
  for (std::int32_t u = 0; u < count_u_; ++u) {
    for (std::int32_t v = 0; v < count_v_; ++v) {
      const std::int32_t column = columns_[static_cast<std::size_t>(u * count_v_ + v)];
      if (column == kOutside) continue;
      const Eigen::Vector2d place = corner_ + (u + 0.5) * edge_u_ * along_ + (v + 0.5) * edge_v_ * across_;
      middles[static_cast<std::size_t>(column)] << place, ground_.height_at(place);
    }
  }
  return middles;
}

}  // namespace vdbmap::parking
