// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/glb_points.h"

#include <cstring>
#include <stdexcept>

#include <meshoptimizer.h>
#include <nlohmann/json.hpp>

namespace vdbmap::test {
namespace {

std::uint32_t word(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  if (at + 4 > bytes.size()) throw std::runtime_error("the glTF file ends too early");
  std::memcpy(&value, bytes.data() + at, 4);
  return value;
}

std::string chunk(const std::string& glb, std::size_t at, std::uint32_t type) {
  if (word(glb, at + 4) != type) throw std::runtime_error("the glTF file has another chunk there");
  const std::uint32_t size = word(glb, at);
  if (size % 4 != 0 || at + 8 + size > glb.size()) throw std::runtime_error("the chunk is no multiple of four bytes");
  return glb.substr(at + 8, size);
}

constexpr std::uint32_t kJson = 0x4E4F534A, kBin = 0x004E4942;

std::string view_of(const nlohmann::json& gltf, const std::string& binary, std::size_t number) {
  const nlohmann::json& packed = gltf["bufferViews"][number]["extensions"]["EXT_meshopt_compression"];
  const std::size_t count = packed["count"], stride = packed["byteStride"];
  std::string bytes(count * stride, '\0');
  const auto* source = reinterpret_cast<const unsigned char*>(binary.data()) + packed["byteOffset"].get<std::size_t>();
  if (packed["mode"] != "ATTRIBUTES" || gltf["bufferViews"][number]["byteLength"] != bytes.size() ||
      meshopt_decodeVertexBuffer(bytes.data(), count, stride, source, packed["byteLength"]) != 0) {
    throw std::runtime_error("the view cannot be decompressed");
  }
  return bytes;
}

Eigen::Affine3d transform_of(const nlohmann::json& node) {
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  if (node.contains("matrix")) {
    for (Eigen::Index i = 0; i < 16; ++i) transform.matrix().data()[i] = node["matrix"][static_cast<std::size_t>(i)];
  }
  const auto vector = [&](const char* name) {
    return Eigen::Vector3d(node[name][0].get<double>(), node[name][1].get<double>(), node[name][2].get<double>());
  };
  if (node.contains("translation")) transform.translate(vector("translation"));
  if (node.contains("scale")) transform.scale(vector("scale"));
  return transform;
}

class Decoder {
 public:
  explicit Decoder(const std::string& glb) : gltf_(json_of_glb(glb)) {
    binary_ = chunk(glb, 12 + 8 + word(glb, 12), kBin);
  }

  std::vector<GlbPoint> points() {
    const nlohmann::json& scene = gltf_["scenes"][gltf_["scene"].get<std::size_t>()];
    Eigen::Affine3d z_up = Eigen::Affine3d::Identity();
    z_up.linear() << 1, 0, 0, 0, 0, -1, 0, 1, 0;  // 3D Tiles 1.1: y up of glTF to z up
    for (const nlohmann::json& node : scene["nodes"]) visit(node, z_up);
    return std::move(points_);
  }

 private:
  void visit(std::size_t number, const Eigen::Affine3d& parent) {
    const nlohmann::json node = gltf_["nodes"][number];
    const Eigen::Affine3d transform = parent * transform_of(node);
    if (node.contains("children")) {
      for (const nlohmann::json& child : node["children"]) visit(child, transform);
    }
    if (node.contains("mesh")) add_points(node, transform);
  }

  // Bytes of an attribute, `width` a point; the stride of its view between points.
  std::vector<std::array<int, 4>> values_of(std::size_t number, std::size_t width) const {
    const nlohmann::json& accessor = gltf_["accessors"][number];
    const std::size_t view = accessor["bufferView"], offset = accessor["byteOffset"], count = accessor["count"];
    const std::size_t stride = gltf_["bufferViews"][view]["byteStride"];
    const std::string type = accessor["type"];
    if (accessor["componentType"] != 5121 || type != "VEC" + std::to_string(width))
      throw std::runtime_error("other type");
    const std::string bytes = view_of(gltf_, binary_, view);
    std::vector<std::array<int, 4>> values(count);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < width; ++k)
        values[i][k] = static_cast<unsigned char>(bytes.at(i * stride + offset + k));
    }
    return values;
  }

  void add_points(const nlohmann::json& node, const Eigen::Affine3d& transform) {
    const nlohmann::json& primitive = gltf_["meshes"][node["mesh"].get<std::size_t>()]["primitives"][0];
    const nlohmann::json& attributes = primitive["attributes"];
    if (primitive["mode"] != 0) throw std::runtime_error("no points");
    const auto positions = values_of(attributes["POSITION"], 3);
    const auto voxels = values_of(attributes["_VOXEL"], 4);
    const bool has_color = attributes.contains("COLOR_0");
    const auto colors = has_color ? values_of(attributes["COLOR_0"], 3) : std::vector<std::array<int, 4>>();
    const nlohmann::json& extras = node["extras"];
    const VoxelIndex low(extras["min_index"][0].get<int>(), extras["min_index"][1].get<int>(),
                         extras["min_index"][2].get<int>());
    const std::size_t first = extras.value("first_detail", std::size_t{0});
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const auto& p = positions[i];
      GlbPoint point;
      point.position = transform * Eigen::Vector3d(p[0], p[1], p[2]);
      point.voxel = low.offsetBy(p[0], p[1], p[2]);
      if (has_color) point.color = {colors[i][0], colors[i][1], colors[i][2]};
      point.attributes = voxels[i];
      point.voxel_size = extras["voxel_size"];
      point.detail = first + i;
      points_.push_back(point);
    }
  }

  nlohmann::json gltf_;
  std::string binary_;
  std::vector<GlbPoint> points_;
};

}  // namespace

nlohmann::json json_of_glb(const std::string& glb) {
  constexpr std::uint32_t kMagic = 0x46546C67;
  if (word(glb, 0) != kMagic || word(glb, 4) != 2 || word(glb, 8) != glb.size())
    throw std::runtime_error("no glTF 2.0");
  return nlohmann::json::parse(chunk(glb, 12, kJson));
}

std::vector<GlbPoint> points_of_glb(const std::string& glb) { return Decoder(glb).points(); }

}  // namespace vdbmap::test
