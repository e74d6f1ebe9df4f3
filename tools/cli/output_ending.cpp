// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/output_ending.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <stdexcept>
#include <string_view>

namespace vdbmap::cli {
namespace {

// Endings that programs choose a reader by.
constexpr std::array<std::string_view, 56> kKnownEndings = {
    ".vdb",     ".nvdb", ".png", ".jpg", ".jpeg", ".jpe",  ".jp2", ".tif", ".tiff", ".bmp", ".gif",  ".webp",
    ".avif",    ".svg",  ".pdf", ".eps", ".exr",  ".hdr",  ".tga", ".ppm", ".pgm",  ".pnm", ".ply",  ".pcd",
    ".las",     ".laz",  ".xyz", ".csv", ".asc",  ".pts",  ".ptx", ".e57", ".txt",  ".bin", ".obj",  ".stl",
    ".gltf",    ".glb",  ".fbx", ".usd", ".abc",  ".pcap", ".npy", ".npz", ".json", ".xml", ".yaml", ".yml",
    ".geojson", ".zip",  ".gz",  ".bz2", ".xz",   ".zst",  ".tar", ".html"};

std::string ending_of(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending;
}

}  // namespace

const OutputKind kMapKind = {"an OpenVDB file", {".vdb"}};
const OutputKind kPictureKind = {"a PNG or JPEG picture", {".png", ".jpg", ".jpeg"}};
const OutputKind kPosesKind = {"poses as text", {".txt"}};
const OutputKind kPointsKind = {"points", {".ply", ".las", ".xyz"}};
const OutputKind kLabelsKind = {"SemanticKITTI's labels", {".label"}};
const OutputKind kJsonKind = {"JSON", {".json", ".txt"}};
const OutputKind kGeoJsonKind = {"GeoJSON", {".geojson", ".json"}};
const OutputKind kTableKind = {"a table", {".csv", ".txt"}};

bool has_ending(const std::filesystem::path& output, const OutputKind& kind) {
  return std::ranges::count(kind.endings, ending_of(output)) > 0;
}

void check_ending(const std::filesystem::path& output, const OutputKind& kind) {
  const std::string ending = ending_of(output);
  if (has_ending(output, kind) || std::ranges::count(kKnownEndings, ending) == 0) return;
  throw std::invalid_argument(output.string() + ": is written as " + kind.name + ", but '" + ending +
                              "' stands for another format: choose a name with " + kind.endings.front());
}

}  // namespace vdbmap::cli
