// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/diff_report.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "vdbmap/core/label_scheme.h"
#include "vdbmap/io/geodesy/geodetic_transform.h"

namespace vdbmap::cli {
namespace {

constexpr std::size_t kMostLines = 20;
constexpr std::size_t kLongestBar = 24;

char sign_of(Change kind) { return kind == Change::kAppeared ? '+' : kind == Change::kVanished ? '-' : '~'; }

double yaw_deg(const ChangeRegion& region) { return region.plan.yaw * 180 / std::numbers::pi; }

// Millimetres are all that a coordinate of a region means.
double rounded(double value, double step = 1e-3) { return std::round(value / step) * step; }

std::string label_of(const ChangeRegion& region, LabelScheme scheme) {
  return region.label == kNoLabel ? "" : label_name(scheme, region.label);
}

std::string line_of(const ChangeRegion& region, const DiffReport& report, std::size_t most_voxels) {
  const double share = std::sqrt(static_cast<double>(region.num_voxels) / static_cast<double>(most_voxels));
  const auto bar = std::max<std::size_t>(1, static_cast<std::size_t>(share * kLongestBar));
  const Eigen::Vector3d center = region.center(), size = region.size();
  return fmt::format(" {:>3} {:<8} {:<12} {:6.2f} m3 {:5.1f} x {:.1f} x {:.1f} m at {:.1f} {:.1f} {:.1f} | {:>6} {}\n",
                     region.id, name_of(region.kind), label_of(region, report.diff.label_scheme), region.volume,
                     size.x(), size.y(), size.z(), center.x(), center.y(), center.z(), region.num_voxels,
                     std::string(bar, sign_of(region.kind)));
}

std::size_t num_of(const std::vector<ChangeRegion>& regions, Change kind) {
  return static_cast<std::size_t>(std::ranges::count(regions, kind, &ChangeRegion::kind));
}

nlohmann::ordered_json json_of_vector(const Eigen::Vector3d& vector) {
  return {rounded(vector.x()), rounded(vector.y()), rounded(vector.z())};
}

nlohmann::ordered_json json_of_region(const ChangeRegion& region, LabelScheme scheme) {
  const std::string label = label_of(region, scheme);
  return {{"id", region.id},
          {"kind", name_of(region.kind)},
          {"center", json_of_vector(region.center())},
          {"size", json_of_vector(region.size())},
          {"yaw", rounded(yaw_deg(region))},
          {"volume_m3", rounded(region.volume, 1e-6)},
          {"voxels", region.num_voxels},
          {"label", label.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(label)},
          {"confidence", rounded(region.confidence)}};
}

// Longitude and latitude to 1e-8 degrees, a millimetre.
nlohmann::ordered_json ring_of(const ChangeRegion& region, const GeodeticTransform& transform) {
  auto ring = nlohmann::ordered_json::array();
  const auto corners = region.plan.corners();
  for (std::size_t i = 0; i <= corners.size(); ++i) {
    const Eigen::Vector2d& corner = corners[i % corners.size()];
    const Eigen::Vector3d place = transform.to_wgs84({corner.x(), corner.y(), region.bottom});
    ring.push_back({rounded(place.x(), 1e-8), rounded(place.y(), 1e-8)});
  }
  return ring;
}

}  // namespace

std::string text_of(const DiffReport& report) {
  const std::vector<ChangeRegion>& regions = report.regions;
  const ChangeCounts& counts = report.diff.counts;
  std::string text = fmt::format("{} -> {}\n", report.earlier, report.later);
  for (std::size_t i = 0; i < std::min(regions.size(), kMostLines); ++i) {
    text += line_of(regions[i], report, regions.front().num_voxels);
  }
  if (regions.size() > kMostLines) text += fmt::format(" ... and {} smaller ones\n", regions.size() - kMostLines);
  text += fmt::format(
      " {} regions: {} appeared (+), {} vanished (-), {} changed (~)\n"
      " voxels: {} appeared, {} vanished, {} changed, {} unchanged, {} unobserved\n",
      regions.size(), num_of(regions, Change::kAppeared), num_of(regions, Change::kVanished),
      num_of(regions, Change::kChanged), counts.appeared, counts.vanished, counts.changed, counts.unchanged,
      counts.unobserved);
  return text;
}

nlohmann::ordered_json json_of(const DiffReport& report) {
  const ChangeCounts& counts = report.diff.counts;
  auto regions = nlohmann::ordered_json::array();
  for (const ChangeRegion& region : report.regions) {
    regions.push_back(json_of_region(region, report.diff.label_scheme));
  }
  return {{"voxels",
           {{"appeared", counts.appeared},
            {"vanished", counts.vanished},
            {"changed", counts.changed},
            {"unchanged", counts.unchanged},
            {"unobserved", counts.unobserved}}},
          {"regions", std::move(regions)}};
}

std::string csv_of(const DiffReport& report) {
  std::string text = "id,kind,x,y,z,length,width,height,yaw,volume_m3,voxels,label,confidence\n";
  for (const ChangeRegion& region : report.regions) {
    const Eigen::Vector3d center = region.center(), size = region.size();
    text += fmt::format("{},{},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.6f},{},{},{:.3f}\n", region.id,
                        name_of(region.kind), center.x(), center.y(), center.z(), size.x(), size.y(), size.z(),
                        yaw_deg(region), region.volume, region.num_voxels, label_of(region, report.diff.label_scheme),
                        region.confidence);
  }
  return text;
}

nlohmann::ordered_json geojson_of(const DiffReport& report) {
  const std::optional<int> epsg = report.diff.frame.epsg;
  if (!epsg) throw std::invalid_argument("places on the globe need the EPSG code of a map: build it with --epsg");
  const GeodeticTransform transform(*epsg);
  auto features = nlohmann::ordered_json::array();
  for (const ChangeRegion& region : report.regions) {
    auto properties = json_of_region(region, report.diff.label_scheme);
    features.push_back(
        {{"type", "Feature"},
         {"geometry",
          {{"type", "Polygon"}, {"coordinates", nlohmann::ordered_json::array({ring_of(region, transform)})}}},
         {"properties", std::move(properties)}});
  }
  return {{"type", "FeatureCollection"}, {"features", std::move(features)}};
}

}  // namespace vdbmap::cli
