// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/web/glb.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <vector>

#include <meshoptimizer.h>
#include <nlohmann/json.hpp>

namespace vdbmap {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kUnsignedByte = 5121;  // of WebGL, as the two below
constexpr int kArrayBuffer = 34962;
constexpr int kPoints = 0;

constexpr std::uint32_t kMagic = 0x46546C67;      // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004E4942;   // "BIN\0"

// The points' bytes as the file has them; without colours eight a point.
std::vector<unsigned char> vertices_of(const TileBlock& block, std::size_t stride) {
  std::vector<unsigned char> vertices(block.points.size() * stride);
  unsigned char* vertex = vertices.data();
  for (const TilePoint& point : block.points) {
    std::memcpy(vertex, point.position.data(), 4);
    if (stride == sizeof(TilePoint)) std::memcpy(vertex + 4, point.color.data(), 4);
    std::memcpy(vertex + stride - 4, &point.label, 4);
    vertex += stride;
  }
  return vertices;
}

std::string compress(const std::vector<unsigned char>& vertices, std::size_t stride) {
  const std::size_t count = vertices.size() / stride;
  std::string bytes(meshopt_encodeVertexBufferBound(count, stride), '\0');
  meshopt_encodeVertexVersion(0);
  bytes.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(bytes.data()), bytes.size(), vertices.data(),
                                          count, stride));
  return bytes;
}

// Lowest and highest position of a block on each axis.
Json bound_of(const TileBlock& block, bool is_upper) {
  std::array<std::uint8_t, 3> bound = block.points.front().position;
  for (const TilePoint& point : block.points) {
    for (std::size_t i = 0; i < 3; ++i) {
      bound[i] = is_upper ? std::max(bound[i], point.position[i]) : std::min(bound[i], point.position[i]);
    }
  }
  return {bound[0], bound[1], bound[2]};
}

Json accessor(std::size_t view, std::size_t offset, std::size_t count, const char* type) {
  return {
      {"bufferView", view}, {"byteOffset", offset}, {"componentType", kUnsignedByte}, {"count", count}, {"type", type}};
}

// The parts of a glTF file that grow with its blocks.
class GltfParts {
 public:
  explicit GltfParts(const GlbOptions& options) : options_(options), stride_(options.has_color ? 12 : 8) {}

  void add(const TileBlock& block) {
    const std::size_t count = block.points.size();
    const Json attributes = add_accessors(count, block);
    add_view(block);
    Json primitive = {{"attributes", attributes}, {"mode", kPoints}, {"material", 0}};
    nodes_.push_back(node_of(block));
    meshes_.push_back({{"primitives", Json::array({std::move(primitive)})}});
    num_points_ += count;
  }

  Json json() const {
    Json children = Json::array();
    for (std::size_t i = 1; i <= nodes_.size(); ++i) children.push_back(i);
    Json nodes = Json::array();
    // Exact, where a rotation would be off by a rounding: z up to y up.
    nodes.push_back({{"matrix", {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1}}, {"children", children}});
    for (const Json& node : nodes_) nodes.push_back(node);
    return {{"asset", {{"version", "2.0"}, {"generator", "vdbmap"}}},
            {"extensionsUsed", {"KHR_mesh_quantization", "KHR_materials_unlit", "EXT_meshopt_compression"}},
            {"extensionsRequired", {"KHR_mesh_quantization", "EXT_meshopt_compression"}},
            {"scene", 0},
            {"scenes", Json::array({{{"nodes", Json::array({0})}}})},
            {"nodes", std::move(nodes)},
            {"meshes", meshes_},
            {"materials", Json::array({{{"extensions", {{"KHR_materials_unlit", Json::object()}}}}})},
            {"accessors", accessors_},
            {"bufferViews", views_},
            {"buffers", buffers()}};
  }

  const std::string& binary() const { return binary_; }

 private:
  Json add_accessors(std::size_t count, const TileBlock& block) {
    Json attributes = {{"POSITION", accessors_.size()}};
    Json position = accessor(views_.size(), 0, count, "VEC3");
    position["min"] = bound_of(block, false);
    position["max"] = bound_of(block, true);
    accessors_.push_back(std::move(position));
    if (options_.has_color) {
      attributes["COLOR_0"] = accessors_.size();
      Json color = accessor(views_.size(), 4, count, "VEC3");
      color["normalized"] = true;
      accessors_.push_back(std::move(color));
    }
    attributes["_VOXEL"] = accessors_.size();
    accessors_.push_back(accessor(views_.size(), stride_ - 4, count, "VEC4"));
    return attributes;
  }

  void add_view(const TileBlock& block) {
    const std::vector<unsigned char> vertices = vertices_of(block, stride_);
    const std::string compressed = compress(vertices, stride_);
    const Json compression = {
        {"buffer", 0},           {"byteOffset", binary_.size()}, {"byteLength", compressed.size()},
        {"byteStride", stride_}, {"count", block.points.size()}, {"mode", "ATTRIBUTES"}};
    views_.push_back({{"buffer", 1},
                      {"byteOffset", uncompressed_size_},
                      {"byteLength", vertices.size()},
                      {"byteStride", stride_},
                      {"target", kArrayBuffer},
                      {"extensions", {{"EXT_meshopt_compression", compression}}}});
    binary_ += compressed;
    binary_.resize((binary_.size() + 3) / 4 * 4, '\0');
    uncompressed_size_ += vertices.size();
  }

  // From voxel indices, whose centres are half a voxel on, to metres from the file's origin.
  Json node_of(const TileBlock& block) const {
    const double size = options_.voxel_size;
    const Eigen::Vector3d translation = center_of_voxel(block.min_index, size) - options_.origin;
    Json extras = {{"voxel_size", size},
                   {"min_index", {block.min_index.x(), block.min_index.y(), block.min_index.z()}}};
    if (!options_.details.empty()) {
      extras["details"] = options_.details;
      extras["first_detail"] = num_points_;
    }
    return {{"mesh", meshes_.size()},
            {"translation", {translation.x(), translation.y(), translation.z()}},
            {"scale", {size, size, size}},
            {"extras", std::move(extras)}};
  }

  // The second stands for what the first is decompressed to.
  Json buffers() const {
    const Json fallback = {{"EXT_meshopt_compression", {{"fallback", true}}}};
    return Json::array(
        {{{"byteLength", binary_.size()}}, {{"byteLength", uncompressed_size_}, {"extensions", fallback}}});
  }

  const GlbOptions& options_;
  std::size_t stride_;
  Json nodes_ = Json::array();
  Json meshes_ = Json::array();
  Json accessors_ = Json::array();
  Json views_ = Json::array();
  std::string binary_;
  std::size_t uncompressed_size_ = 0;
  std::size_t num_points_ = 0;
};

void append_number(std::string& bytes, std::size_t number) {
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(number >> shift & 0xff);
}

void append_chunk(std::string& bytes, std::uint32_t type, const std::string& content) {
  append_number(bytes, content.size());
  append_number(bytes, type);
  bytes += content;
}

}  // namespace

std::string glb_of(std::span<const TileBlock> blocks, const GlbOptions& options) {
  if (blocks.empty()) throw std::invalid_argument("a glTF file of no points");
  GltfParts parts(options);
  for (const TileBlock& block : blocks) parts.add(block);
  std::string json = parts.json().dump();
  json.resize((json.size() + 3) / 4 * 4, ' ');

  constexpr std::size_t kHeaders = 12 + 8 + 8;
  const std::size_t size = kHeaders + json.size() + parts.binary().size();
  if (size > std::numeric_limits<std::uint32_t>::max()) throw std::length_error("a tile of more than 4 GB");
  std::string glb;
  glb.reserve(size);
  append_number(glb, kMagic);
  append_number(glb, 2);
  append_number(glb, size);
  append_chunk(glb, kJsonChunk, json);
  append_chunk(glb, kBinChunk, parts.binary());
  return glb;
}

}  // namespace vdbmap
