// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/voxel_text.h"

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

namespace vdbmap::cli {
namespace {

using Json = nlohmann::ordered_json;

// 0..255 of 0..65535.
int byte_of(std::uint16_t code) { return (code + 128) / 257; }

std::string line(const std::string& name, const std::string& value) { return fmt::format("  {:<13}{}\n", name, value); }

std::string text_of(const Eigen::Vector3d& vector, int digits) {
  return fmt::format("{:.{}f} {:.{}f} {:.{}f}", vector.x(), digits, vector.y(), digits, vector.z(), digits);
}

std::string covariance_text(const Eigen::Matrix3d& c) {
  return fmt::format("xx {:.4g}  yy {:.4g}  zz {:.4g}  xy {:.4g}  xz {:.4g}  yz {:.4g} m^2", c(0, 0), c(1, 1), c(2, 2),
                     c(0, 1), c(0, 2), c(1, 2));
}

std::string features_text(const EigenFeatures& features) {
  const Eigen::Vector3d& l = features.eigenvalues;
  return line("eigenvalues", fmt::format("{:.4g} {:.4g} {:.4g} m^2", l[0], l[1], l[2])) +
         line("shape", fmt::format("linearity {:.3f}, planarity {:.3f}, scattering {:.3f}, verticality {:.3f}",
                                   features.linearity, features.planarity, features.scattering, features.verticality)) +
         line("", fmt::format(
                      "omnivariance {:.4g} m^2, anisotropy {:.3f}, eigenentropy {:.3f}, surface variation {:.3f}",
                      features.omnivariance, features.anisotropy, features.eigenentropy, features.surface_variation));
}

std::string channels_text(const VoxelInfo& voxel) {
  std::string text;
  if (voxel.linear_color && voxel.color) {
    text += line("colour", fmt::format("sRGB {} {} {}, linear {}", byte_of(voxel.color->r), byte_of(voxel.color->g),
                                       byte_of(voxel.color->b), text_of(*voxel.linear_color, 4)));
  }
  if (voxel.intensity) text += line("intensity", fmt::format("{:.4g}", *voxel.intensity));
  if (voxel.label) text += line("class", fmt::format("{} ({})", voxel.label_name, *voxel.label));
  if (voxel.first_epoch) text += line("first epoch", std::to_string(*voxel.first_epoch));
  if (voxel.last_epoch) text += line("last epoch", std::to_string(*voxel.last_epoch));
  return text;
}

std::string text_of(const VoxelInfo& voxel) {
  return fmt::format("voxel {} of the {:g} m level\n", to_string(voxel.id), voxel.voxel_size) +
         line("index", fmt::format("{} {} {}", voxel.index.x(), voxel.index.y(), voxel.index.z())) +
         line("points", std::to_string(voxel.count)) + line("mean", text_of(voxel.mean, 4) + " m") +
         line("covariance", covariance_text(voxel.covariance)) + features_text(voxel.features) +
         line("normal",
              fmt::format("{}, planarity {:.3f}, of 3 x 3 x 3 voxels", text_of(voxel.normal, 3), voxel.planarity)) +
         channels_text(voxel);
}

template <typename Value>
Json json_of(const std::optional<Value>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json json_of(const Eigen::Vector3d& vector) { return {vector.x(), vector.y(), vector.z()}; }

Json json_of(const Eigen::Matrix3d& c) {
  return {{c(0, 0), c(0, 1), c(0, 2)}, {c(1, 0), c(1, 1), c(1, 2)}, {c(2, 0), c(2, 1), c(2, 2)}};
}

Json json_of(const EigenFeatures& features) {
  return {{"eigenvalues_m2", json_of(features.eigenvalues)},
          {"linearity", features.linearity},
          {"planarity", features.planarity},
          {"scattering", features.scattering},
          {"omnivariance_m2", features.omnivariance},
          {"anisotropy", features.anisotropy},
          {"eigenentropy", features.eigenentropy},
          {"surface_variation", features.surface_variation},
          {"verticality", features.verticality}};
}

Json json_of_color(const VoxelInfo& voxel) {
  if (!voxel.linear_color || !voxel.color) return nullptr;
  return {{"linear", json_of(*voxel.linear_color)},
          {"srgb", {byte_of(voxel.color->r), byte_of(voxel.color->g), byte_of(voxel.color->b)}}};
}

Json json_of(const VoxelInfo& voxel) {
  return {{"id", to_string(voxel.id)},
          {"voxel_size_m", voxel.voxel_size},
          {"index", {voxel.index.x(), voxel.index.y(), voxel.index.z()}},
          {"count", voxel.count},
          {"mean", json_of(voxel.mean)},
          {"covariance_m2", json_of(voxel.covariance)},
          {"normal", json_of(voxel.normal)},
          {"planarity", voxel.planarity},
          {"features", json_of(voxel.features)},
          {"color", json_of_color(voxel)},
          {"intensity", json_of(voxel.intensity)},
          {"label", json_of(voxel.label)},
          {"label_name", voxel.label ? Json(voxel.label_name) : Json(nullptr)},
          {"first_epoch", json_of(voxel.first_epoch)},
          {"last_epoch", json_of(voxel.last_epoch)}};
}

}  // namespace

std::string text_of_voxels(const std::vector<VoxelInfo>& voxels) {
  std::string text;
  for (const VoxelInfo& voxel : voxels) {
    if (!text.empty()) text += '\n';
    text += text_of(voxel);
  }
  return text;
}

Json json_of_voxels(const std::vector<VoxelInfo>& voxels) {
  auto array = Json::array();
  for (const VoxelInfo& voxel : voxels) array.push_back(json_of(voxel));
  return array;
}

}  // namespace vdbmap::cli
