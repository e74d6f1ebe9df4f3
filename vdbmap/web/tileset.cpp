// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/web/tileset.h"

#include <limits>
#include <utility>

#include <nlohmann/json.hpp>

#include "vdbmap/core/tile_id.h"

namespace vdbmap {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostTilesInAFile = 1024;
constexpr double kRounding = 1e-3;  // [m] that boxes are larger: what is inside of them stays so however it is rounded

// A tile of a tileset and all below it.
struct Node {
  Json json;
  Eigen::Affine3d world_from_tile;
  Eigen::AlignedBox3d box;  // in the tile's own frame
};

Json json_of_box(const Eigen::AlignedBox3d& box) {
  const Eigen::Vector3d c = box.center(), h = box.sizes() / 2;
  return {{"box", {c.x(), c.y(), c.z(), h.x(), 0, 0, 0, h.y(), 0, 0, 0, h.z()}}};
}

// Column by column.
Json json_of_transform(const Eigen::Affine3d& transform) {
  Json numbers = Json::array();
  for (Eigen::Index i = 0; i < 16; ++i) numbers.push_back(transform.matrix().data()[i]);
  return numbers;
}

Eigen::AlignedBox3d moved(const Eigen::AlignedBox3d& box, const Eigen::Affine3d& transform) {
  Eigen::AlignedBox3d result;
  for (int corner = 0; corner < 8; ++corner) {
    result.extend(transform * box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
  }
  return result;
}

Eigen::AlignedBox3d box_of_voxels(const openvdb::CoordBBox& voxels, double voxel_size) {
  return {corner_of_voxel(voxels.min(), voxel_size), corner_of_voxel(voxels.max().offsetBy(1), voxel_size)};
}

Eigen::AlignedBox3d grown(Eigen::AlignedBox3d box, double by) {
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(by);
  return {box.min() - margin, box.max() + margin};
}

Json json_of_file(Json root, double error) {
  const Json tileset = {
      {"asset", {{"version", "1.1"}, {"generator", "vdbmap"}}}, {"geometricError", error}, {"root", std::move(root)}};
  return tileset;
}

class TilesetWriter {
 public:
  TilesetWriter(const TileFiles& tiles, const SiteGrid& grid, const SitePlacement& placement, std::string id)
      : tiles_(tiles), grid_(grid), placement_(placement), id_(std::move(id)) {
    if (tiles.size() <= kMostTilesInAFile) return;
    subtree_level_ = 0;
    while (grid.edge(subtree_level_) < kTileSize * (1 - 1e-9)) ++subtree_level_;
  }

  std::vector<TilesetFile> write() {
    Node root = make_root();
    root.json["transform"] = json_of_transform(root.world_from_tile);
    const double error = 2 * root.json["geometricError"].get<double>();
    files_.insert(files_.begin(), {"tileset_" + id_ + ".json", json_of_file(std::move(root.json), error).dump()});
    return std::move(files_);
  }

 private:
  // The tile of the highest level, or one without a file around those of it.
  Node make_root() {
    const std::int32_t top = tiles_.rbegin()->first.level;
    std::vector<Node> nodes;
    for (auto it = tiles_.lower_bound({top, std::numeric_limits<std::int32_t>::min(), 0}); it != tiles_.end(); ++it) {
      nodes.push_back(make_node(it->second));
    }
    if (nodes.size() == 1) return std::move(nodes.front());

    Node root{Json::object(), nodes.front().world_from_tile, {}};
    root.json["geometricError"] = 2 * grid_.voxel_size(top);
    add_children(root, std::move(nodes));
    return root;
  }

  Node make_node(const TileFile& file) {
    const double voxel_size = grid_.voxel_size(file.tile.level);
    const Eigen::Vector3d origin = origin_of_tile(file.tile, file.voxels, grid_);
    const Eigen::Affine3d world_from_local = placement_.world_from_local(box_of_tile(file.tile, file.voxels, grid_));
    Node node{Json::object(), world_from_local * Eigen::Translation3d(origin), {}};
    node.box = grown(box_of_voxels(file.voxels, voxel_size).translated(-origin), kRounding);
    node.json["geometricError"] = file.tile.level == 0 ? 0.0 : voxel_size;
    const char* const tiles = subtree_level_ >= file.tile.level ? "../../tiles/" : "tiles/";
    Json content = {{"uri", tiles + file.name}};
    add_children(node, children_of(file.tile));
    node.json["content"] = std::move(content);
    return file.tile.level == subtree_level_ ? put_aside(std::move(node), file) : node;
  }

  std::vector<Node> children_of(const QuadTile& tile) {
    std::vector<Node> children;
    for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
      const auto child = tiles_.find({tile.level - 1, 2 * tile.x + x, 2 * tile.y + y});
      if (child != tiles_.end()) children.push_back(make_node(child->second));
    }
    return children;
  }

  // Takes children in, and what they need of the box.
  void add_children(Node& node, std::vector<Node> children) const {
    Json list = Json::array();
    for (Node& child : children) {
      const Eigen::Affine3d node_from_child = node.world_from_tile.inverse() * child.world_from_tile;
      node.box.extend(grown(moved(child.box, node_from_child), kRounding));
      child.json["transform"] = json_of_transform(node_from_child);
      list.push_back(std::move(child.json));
    }
    node.json["boundingVolume"] = json_of_box(node.box);
    node.json["refine"] = "REPLACE";
    if (!list.empty()) node.json["children"] = std::move(list);
  }

  // A tile that a file of its own has, in whose place the file is named.
  Node put_aside(Node node, const TileFile& file) {
    const std::string name = "subtrees/" + id_ + "/" + name_of(file.tile) + ".json";
    const double error = 2 * grid_.voxel_size(file.tile.level);
    Node reference{Json::object(), node.world_from_tile, grown(node.box, kRounding)};
    reference.json["boundingVolume"] = json_of_box(reference.box);
    reference.json["geometricError"] = error;
    reference.json["refine"] = "REPLACE";
    reference.json["content"] = {{"uri", name}};
    files_.push_back({name, json_of_file(std::move(node.json), error).dump()});
    return reference;
  }

  const TileFiles& tiles_;
  const SiteGrid& grid_;
  const SitePlacement& placement_;
  std::string id_;
  std::int32_t subtree_level_ = -1;
  std::vector<TilesetFile> files_;
};

}  // namespace

Eigen::AlignedBox3d box_of_tile(const QuadTile& tile, const openvdb::CoordBBox& voxels, const SiteGrid& grid) {
  const double edge = grid.edge(tile.level);
  Eigen::AlignedBox3d box = box_of_voxels(voxels, grid.voxel_size(tile.level));
  box.min().head<2>() << tile.x * edge, tile.y * edge;
  box.max().head<2>() << (tile.x + 1) * edge, (tile.y + 1) * edge;
  return box;
}

Eigen::Vector3d origin_of_tile(const QuadTile& tile, const openvdb::CoordBBox& voxels, const SiteGrid& grid) {
  const Eigen::AlignedBox3d box = box_of_tile(tile, voxels, grid);
  return {box.center().x(), box.center().y(), box.min().z()};
}

std::vector<TilesetFile> tileset_of(const TileFiles& tiles, const SiteGrid& grid, const SitePlacement& placement,
                                    const std::string& id) {
  return TilesetWriter(tiles, grid, placement, id).write();
}

}  // namespace vdbmap
