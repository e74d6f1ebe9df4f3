// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/points/point_cloud_filter.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "vdbmap/core/error.h"

namespace vdbmap {
namespace {

template <typename Predicate>
std::vector<std::size_t> places_where(const std::vector<Eigen::Vector3d>& positions, Predicate&& predicate) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (predicate(positions[i])) places.push_back(i);
  }
  return places;
}

// Removes the values at these places, which rise; an attribute that the cloud does not have stays empty.
template <typename T>
void remove_at(std::vector<T>& values, std::span<const std::size_t> places) {
  if (values.empty() || places.empty()) return;
  auto next = places.begin();
  std::size_t kept = places.front();
  for (std::size_t i = kept; i < values.size(); ++i) {
    if (next != places.end() && *next == i) {
      ++next;
    } else {
      values[kept++] = values[i];
    }
  }
  values.resize(kept);
}

// Places among all, from places among those that are left without the dropped ones; both rise.
std::vector<std::size_t> places_among_all(std::span<const std::size_t> places, std::span<const std::size_t> dropped) {
  std::vector<std::size_t> result;
  std::size_t num_before = 0;
  for (const std::size_t place : places) {
    while (num_before < dropped.size() && dropped[num_before] <= place + num_before) ++num_before;
    result.push_back(place + num_before);
  }
  return result;
}

// Adds places among those that are left without the dropped ones.
void add_dropped(ReadResult& read, std::span<const std::size_t> places) {
  const std::vector<std::size_t> added = places_among_all(places, read.dropped);
  const auto middle = read.dropped.insert(read.dropped.end(), added.begin(), added.end());
  std::inplace_merge(read.dropped.begin(), middle, read.dropped.end());
}

}  // namespace

void remove_points(PointCloud& cloud, std::span<const std::size_t> places) {
  remove_at(cloud.positions, places);
  remove_at(cloud.colors, places);
  remove_at(cloud.intensities, places);
  remove_at(cloud.times, places);
  remove_at(cloud.rings, places);
  remove_at(cloud.labels, places);
}

std::vector<std::size_t> drop_non_finite(PointCloud& cloud) {
  std::vector<std::size_t> dropped =
      places_where(cloud.positions, [](const Eigen::Vector3d& point) { return !point.allFinite(); });
  remove_points(cloud, dropped);
  return dropped;
}

void drop_points(ReadResult& read, std::span<const std::size_t> places) {
  if (places.empty()) return;
  add_dropped(read, places);
  remove_points(read.cloud, places);
}

void drop_points(ReadResult& read, std::span<const std::size_t> places, const ReadFinding& finding) {
  if (places.empty()) return;
  drop_points(read, places);
  add_finding(read.findings, finding);
}

void drop_points_at_origin(const std::filesystem::path& path, ReadResult& read, bool is_in_sensor_frame) {
  constexpr double kNearerThanAnyReturn = 0.01;  // [m]
  const double radius = is_in_sensor_frame ? kNearerThanAnyReturn : 0;
  const std::vector<std::size_t> places = places_where(
      read.cloud.positions, [radius](const Eigen::Vector3d& point) { return point.squaredNorm() <= radius * radius; });
  if (places.size() < (is_in_sensor_frame ? 1U : 2U)) return;
  if (places.size() == read.cloud.size())
    throw IoError::malformed(path, "all of its points lie at the sensor's origin");
  drop_points(read, places, {"points at the sensor's origin, beams without a return, left out", places.size()});
}

std::size_t drop_out_of_range(ReadResult& read, const RangeLimits& limits) {
  const std::vector<std::size_t> places = places_where(read.cloud.positions, [&](const Eigen::Vector3d& point) {
    const double range = point.norm();
    return range < limits.min || range > limits.max;
  });
  drop_points(read, places);
  return places.size();
}

ReadResult finish_reading(const std::filesystem::path& path, PointCloud cloud, const std::vector<std::size_t>& broken,
                          std::vector<ReadFinding> findings) {
  ReadResult result;
  result.findings = std::move(findings);
  result.dropped = broken;
  const std::vector<std::size_t> non_finite = drop_non_finite(cloud);
  add_dropped(result, non_finite);
  result.num_non_finite = non_finite.size();
  if (cloud.empty()) {
    const std::string dropped = std::to_string(non_finite.size());
    throw IoError::malformed(
        path, non_finite.empty() ? "the file holds no points" : "none of the " + dropped + " points is finite");
  }
  result.cloud = std::move(cloud);
  return result;
}

}  // namespace vdbmap
