// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/segmentation/network_weights.h"

#include <cstdint>
#include <limits>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>
#include <zlib.h>

#include "parking/segmentation/surface_class.h"
#include "vdbmap/core/error.h"
#include "vdbmap/io/file/byte_reader.h"

namespace vdbmap::parking {
namespace {

using Json = nlohmann::json;

constexpr std::string_view kMagic = "vdbmapkp";
constexpr std::uint32_t kVersion = 1;
constexpr double kFinest = 0.1;  // [m]
constexpr int kNeighbours = 28;
constexpr std::size_t kWidest = 4096;
constexpr std::size_t kMostBlocks = 16;
constexpr std::array<std::string_view, kNumFeatures> kFeatures = {"one", "height over 2.5 m", "height over 8.5 m",
                                                                  "points"};

// The matrices one after the other, each where the header says that it is, and of the shape that the network asks for.
class MatrixReader {
 public:
  MatrixReader(ByteReader& file, const Json& names) : file_(file), names_(names) {}

  Layer layer(const std::string& name, std::size_t inputs, std::size_t outputs) {
    return {matrix(name + ".weights", inputs, outputs), matrix(name + ".bias", 1, outputs)};
  }

  void finish() const {
    if (next_ != names_.size()) file_.fail("has more matrices than its network");
    if (file_.remaining() != sizeof(std::uint32_t)) file_.fail("has more bytes than its matrices");
  }

 private:
  Rows matrix(const std::string& name, std::size_t rows, std::size_t columns) {
    if (next_ >= names_.size()) file_.fail("has no matrix " + name);
    if (names_[next_] != Json::array({name, rows, columns})) {
      file_.fail("has matrix " + names_[next_].dump() + " where " + Json::array({name, rows, columns}).dump() +
                 " belongs");
    }
    ++next_;
    const std::string_view bytes = file_.bytes(2 * rows * columns);
    Rows values(rows, columns);
    for (std::size_t i = 0; i < rows * columns; ++i) {
      values.data()[i] = Eigen::half_impl::half_to_float(
          Eigen::half_impl::raw_uint16_to_half(load<std::uint16_t>(bytes.data() + 2 * i)));
    }
    if (!values.allFinite()) file_.fail("has a weight in " + name + " that is no number");
    return values;
  }

  ByteReader& file_;
  const Json& names_;
  std::size_t next_ = 0;
};

Json read_header(ByteReader& file) {
  if (file.size() < kMagic.size() || file.bytes(kMagic.size()) != kMagic) {
    throw IoError::malformed(file.path(), "is no file of network weights");
  }
  const auto version = file.read_le<std::uint32_t>();
  if (version != kVersion) {
    file.fail("weights of version " + std::to_string(version) + ", this program reads version " +
              std::to_string(kVersion));
  }
  const auto length = file.read_le<std::uint32_t>();
  const std::string_view text = file.bytes(length);
  if (file.remaining() < sizeof(std::uint32_t)) file.fail("ends before its checksum");
  const std::string_view all = file.all();
  const std::string_view checked = all.substr(0, all.size() - sizeof(std::uint32_t));
  const uLong sum = crc32_z(crc32_z(0, nullptr, 0), reinterpret_cast<const Bytef*>(checked.data()), checked.size());
  if (sum != load<std::uint32_t>(checked.data() + checked.size())) {
    throw IoError::malformed(file.path(), "is damaged or cut off: its checksum does not fit");
  }
  const Json header = Json::parse(text, nullptr, false);
  if (!header.is_object()) file.fail("has no header");
  return header;
}

template <typename Names>
bool are(const Json& found, const Names& wanted) {
  Json list = Json::array();
  for (const auto& name : wanted) list.push_back(name);
  return found == list;
}

// The network is for what this program tells it of voxels, and says what this program makes of it.
void check_meaning(const ByteReader& file, const Json& header) {
  std::vector<std::string_view> classes;
  for (std::size_t i = 0; i < kNumClasses; ++i) classes.push_back(name_of(static_cast<SurfaceClass>(i)));
  if (!are(header.value("classes", Json()), classes)) file.fail("tells other classes apart than this program");
  if (!are(header.value("features", Json()), kFeatures)) file.fail("wants other features than this program has");
  if (header.value("finest", Json()) != kFinest) file.fail("is for voxels of another size than 0.1 m");
  if (header.value("neighbours", Json()) != kNeighbours) file.fail("wants another number of neighbours than 28");
}

// A list of a number a level, each from 1 to `most`.
std::array<std::size_t, kNumLevels> sizes(const ByteReader& file, const Json& header, const char* key,
                                          std::size_t most) {
  const Json list = header.value(key, Json());
  std::array<std::size_t, kNumLevels> result{};
  if (!list.is_array() || list.size() != kNumLevels) file.fail(std::string("wants five \"") + key + "\"");
  for (std::size_t i = 0; i < kNumLevels; ++i) {
    if (!list[i].is_number_unsigned() || list[i] < 1 || list[i] > most) {
      file.fail(std::string("has \"") + key + "\" that are none from 1 to " + std::to_string(most));
    }
    result[i] = list[i];
  }
  return result;
}

Bottleneck read_bottleneck(MatrixReader& reader, const std::string& name, std::size_t inputs, std::size_t outputs) {
  const std::size_t half = outputs / 2;
  Bottleneck block;
  block.reduce = reader.layer(name + ".reduce", inputs, half);
  block.convolution = reader.layer(name + ".convolution", kNumKernelPoints * half, half);
  block.expand = reader.layer(name + ".expand", half, outputs);
  if (inputs != outputs) block.shortcut = reader.layer(name + ".shortcut", inputs, outputs);
  return block;
}

}  // namespace

std::shared_ptr<const NetworkWeights> read_network(const std::filesystem::path& path) {
  ByteReader file(path);
  const Json header = read_header(file);
  check_meaning(file, header);
  const auto widths = sizes(file, header, "widths", kWidest);
  const auto blocks = sizes(file, header, "blocks", kMostBlocks);
  for (const std::size_t width : widths) {
    if (width % 8 != 0) file.fail("has a width that is no multiple of 8");
  }

  const Json names = header.value("matrices", Json::array());
  MatrixReader reader(file, names);
  const auto network = std::make_shared<NetworkWeights>();
  network->training = header.value("training", Json()).dump();
  network->first = reader.layer("first", kNumKernelPoints * kNumFeatures, widths[0]);
  for (std::size_t level = 0; level < kNumLevels; ++level) {
    for (std::size_t i = 0; i < blocks[level]; ++i) {
      const std::size_t inputs = i == 0 ? widths[level == 0 ? 0 : level - 1] : widths[level];
      const std::string name = "encoder." + std::to_string(level) + "." + std::to_string(i);
      network->encoder[level].push_back(read_bottleneck(reader, name, inputs, widths[level]));
    }
  }
  for (std::size_t level = 0; level + 1 < kNumLevels; ++level) {
    network->decoder[level] =
        reader.layer("decoder." + std::to_string(level), widths[level + 1] + widths[level], widths[level]);
  }
  network->head = reader.layer("head", widths[0], widths[0]);
  network->scores = reader.layer("scores", widths[0], kNumClasses);
  reader.finish();
  return network;
}

}  // namespace vdbmap::parking
