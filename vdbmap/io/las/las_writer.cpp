// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>

#include "vdbmap/io/file/atomic_file.h"
#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/las/las.h"
#include "vdbmap/io/las/las_header.h"
#include "vdbmap/io/points/point_cloud_check.h"

namespace vdbmap {
namespace {

constexpr std::uint16_t kRecordHeaderSize = 54;  // [bytes]
constexpr std::uint16_t kHighestLabel = 31;      // 5 bits
constexpr std::uint8_t kFirstOfOneReturn = 0b001'001;

template <Scalar T>
void append(std::string& bytes, T value) {
  if constexpr (std::endian::native != std::endian::little) value = swap_bytes(value);
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

void append_padded(std::string& bytes, std::string_view text, std::size_t size) {
  bytes.append(text.substr(0, size));
  bytes.append(size - std::min(size, text.size()), '\0');
}

// How coordinates become 32-bit integers, and the box of those that did.
struct Quantization {
  double resolution = 0;
  Eigen::Vector3d offset;
  Eigen::Vector3d lowest;
  Eigen::Vector3d highest;

  std::int32_t quanta(double coordinate, int axis) const {
    return static_cast<std::int32_t>(std::llround((coordinate - offset[axis]) / resolution));
  }
  double coordinate(std::int32_t quanta, int axis) const { return quanta * resolution + offset[axis]; }
};

Quantization choose_quantization(const PointCloud& cloud, double resolution) {
  Eigen::Vector3d low = cloud.positions.front();
  Eigen::Vector3d high = low;
  for (const Eigen::Vector3d& position : cloud.positions) {
    low = low.cwiseMin(position);
    high = high.cwiseMax(position);
  }

  const double widest = resolution * std::numeric_limits<std::int32_t>::max();  // to either side of the offset
  Quantization quantization{resolution, (low / 2 + high / 2).array().round(), low, high};
  for (int axis = 0; axis < 3; ++axis) {
    const double offset = quantization.offset[axis];
    // Not a comparison with the extent alone: rounding the offset costs up to half a unit.
    if (!(high[axis] - offset <= widest && offset - low[axis] <= widest)) {
      throw std::invalid_argument("points span " + std::to_string(high[axis] - low[axis]) + " on axis " +
                                  std::to_string(axis) + ", a LAS file of resolution " + std::to_string(resolution) +
                                  " at most " + std::to_string(2 * widest));
    }
    quantization.lowest[axis] = quantization.coordinate(quantization.quanta(low[axis], axis), axis);
    quantization.highest[axis] = quantization.coordinate(quantization.quanta(high[axis], axis), axis);
  }
  return quantization;
}

void check_labels(const PointCloud& cloud) {
  const auto highest = std::ranges::max_element(cloud.labels);
  if (highest == cloud.labels.end() || *highest <= kHighestLabel) return;
  throw std::invalid_argument("label " + std::to_string(*highest) + " of point " +
                              std::to_string(highest - cloud.labels.begin()) + ", LAS 1.2 has room for 0 to 31");
}

unsigned choose_format(const PointCloud& cloud) {
  return (cloud.times.empty() ? 0 : 1) + (cloud.colors.empty() ? 0 : 2);
}

// GeoTIFF keys that name a projected system by its code.
std::string reference_system_record(const LasWriteOptions& options) {
  std::string bytes;
  if (!options.epsg) return bytes;
  const std::array<std::uint16_t, 12> keys = {1, 1, 0,    2, 1024, 0,
                                              1, 1, 3072, 0, 1,    static_cast<std::uint16_t>(*options.epsg)};
  append<std::uint16_t>(bytes, 0);
  append_padded(bytes, "LASF_Projection", 16);
  append<std::uint16_t>(bytes, 34735);
  append<std::uint16_t>(bytes, sizeof(keys));
  append_padded(bytes, "GeoTIFF keys", 32);
  for (const std::uint16_t key : keys) append(bytes, key);
  return bytes;
}

std::string header(const PointCloud& cloud, const Quantization& quantization, std::size_t records_size) {
  const auto num_points = static_cast<std::uint32_t>(cloud.size());
  const unsigned format = choose_format(cloud);
  std::string bytes = "LASF";
  append<std::uint32_t>(bytes, 0);  // source, global encoding
  append_padded(bytes, "", 16);     // project
  append<std::uint8_t>(bytes, 1);
  append<std::uint8_t>(bytes, 2);
  append_padded(bytes, "OTHER", 32);
  append_padded(bytes, "vdbmap", 32);
  append<std::uint32_t>(bytes, 0);  // no date: the same points make the same file
  append(bytes, kLasHeaderSize);
  append(bytes, static_cast<std::uint32_t>(kLasHeaderSize + records_size));
  append<std::uint32_t>(bytes, records_size == 0 ? 0 : 1);
  append(bytes, static_cast<std::uint8_t>(format));
  append(bytes, static_cast<std::uint16_t>(find_las_point_format(format)->length));
  append(bytes, num_points);
  append(bytes, num_points);                            // first returns
  append_padded(bytes, "", 4 * sizeof(std::uint32_t));  // later returns
  for (int axis = 0; axis < 3; ++axis) append(bytes, quantization.resolution);
  for (int axis = 0; axis < 3; ++axis) append(bytes, quantization.offset[axis]);
  for (int axis = 0; axis < 3; ++axis) {
    append(bytes, quantization.highest[axis]);
    append(bytes, quantization.lowest[axis]);
  }
  return bytes;
}

// Intensities of 0..1 are as common as those of 0..255, and would all become 0 or 1.
double intensity_factor(const PointCloud& cloud) {
  const bool is_fraction = std::ranges::all_of(cloud.intensities, [](float value) { return !(value > 1); });
  return is_fraction ? 65535 : 1;
}

std::uint16_t quantized_intensity(double intensity) {
  if (!(intensity > 0)) return 0;  // NaN too
  return static_cast<std::uint16_t>(std::lround(std::min(intensity, 65535.0)));
}

void write_points(AtomicFile& file, const PointCloud& cloud, const Quantization& quantization) {
  const double factor = intensity_factor(cloud);
  std::string record;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    record.clear();
    for (int axis = 0; axis < 3; ++axis) append(record, quantization.quanta(cloud.positions[i][axis], axis));
    append(record, cloud.intensities.empty() ? std::uint16_t{0} : quantized_intensity(cloud.intensities[i] * factor));
    append(record, kFirstOfOneReturn);
    append(record, static_cast<std::uint8_t>(cloud.labels.empty() ? 0 : cloud.labels[i]));
    append<std::uint32_t>(record, 0);  // scan angle, user data, source
    if (!cloud.times.empty()) append(record, cloud.times[i]);
    if (!cloud.colors.empty()) {
      append(record, cloud.colors[i].r);
      append(record, cloud.colors[i].g);
      append(record, cloud.colors[i].b);
    }
    file.write(record);
  }
}

}  // namespace

void LasWriteOptions::check() const {
  if (epsg && (*epsg < 1024 || *epsg > 32766)) {
    throw std::invalid_argument("EPSG code " + std::to_string(*epsg) + ", LAS has room for 1024 to 32766");
  }
  if (!(resolution > 0) || !std::isfinite(resolution)) {
    throw std::invalid_argument("resolution " + std::to_string(resolution) + ", expected a number above 0");
  }
}

void write_las(const std::filesystem::path& path, const PointCloud& cloud, const LasWriteOptions& options) {
  options.check();
  check_writable_cloud(cloud);
  check_labels(cloud);
  if (cloud.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw std::invalid_argument(std::to_string(cloud.size()) + " points, LAS 1.2 has room for 4294967295");
  }
  const Quantization quantization = choose_quantization(cloud, options.resolution);
  const std::string records = reference_system_record(options);

  AtomicFile file(path);
  file.write(header(cloud, quantization, records.size()));
  file.write(records);
  write_points(file, cloud, quantization);
  file.commit();
}

}  // namespace vdbmap
