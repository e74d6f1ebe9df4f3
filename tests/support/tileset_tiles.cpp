// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/tileset_tiles.h"

#include <string>

#include <nlohmann/json.hpp>

#include "tests/support/raw_files.h"

namespace vdbmap::test {
namespace {

Eigen::AlignedBox3d box_of(const nlohmann::json& volume) {
  const auto box = volume.at("box").get<std::vector<double>>();
  const Eigen::Vector3d center(box.at(0), box.at(1), box.at(2));
  const Eigen::Vector3d half(box.at(3), box.at(7), box.at(11));  // the other numbers are 0: along the axes
  return {center - half, center + half};
}

Eigen::Affine3d transform_of_tile(const nlohmann::json& tile) {
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  if (!tile.contains("transform")) return transform;
  for (Eigen::Index i = 0; i < 16; ++i)
    transform.matrix().data()[i] = tile["transform"].at(static_cast<std::size_t>(i));
  return transform;
}

class Walk {
 public:
  void visit_file(const std::filesystem::path& file, const Eigen::Affine3d& parent, std::optional<std::size_t> above) {
    const nlohmann::json tileset = nlohmann::json::parse(read_raw(file));
    if (tileset.at("asset").at("version") != "1.1") throw std::runtime_error("another version of 3D Tiles");
    tileset.at("geometricError").get<double>();
    visit(tileset.at("root"), file, parent, above);
  }

  std::vector<TilesetTile> tiles;

 private:
  void visit(const nlohmann::json& tile, const std::filesystem::path& file, const Eigen::Affine3d& parent,
             std::optional<std::size_t> above) {
    const Eigen::Affine3d world_from_tile = parent * transform_of_tile(tile);
    const Eigen::AlignedBox3d box = box_of(tile.at("boundingVolume"));
    const double error = tile.at("geometricError");
    if (tile.contains("content")) {
      const std::string uri = tile["content"].at("uri");
      if (uri.ends_with(".json")) {
        visit_file(file.parent_path() / uri, world_from_tile, above);
      } else {
        tiles.push_back({file.parent_path() / uri, world_from_tile, box, error, !tile.contains("children"), above});
        above = tiles.size() - 1;
      }
    }
    if (!tile.contains("children")) return;
    for (const nlohmann::json& child : tile["children"]) visit(child, file, world_from_tile, above);
  }
};

}  // namespace

std::vector<TilesetTile> tiles_of_tileset(const std::filesystem::path& tileset) {
  Walk walk;
  walk.visit_file(tileset, Eigen::Affine3d::Identity(), std::nullopt);
  return std::move(walk.tiles);
}

}  // namespace vdbmap::test
