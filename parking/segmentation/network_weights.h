// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace vdbmap::parking {

/// A row a voxel, a column a channel.
using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

inline constexpr std::size_t kNumLevels = 5;         ///< of the pyramid: 0.1, 0.2, 0.4, 0.8, 1.6 m
inline constexpr std::size_t kNumFeatures = 4;       ///< of a voxel, voxel_features.h
inline constexpr std::size_t kNumKernelPoints = 15;  ///< of a convolution

/// rows * weights + bias, norms folded in. Of a convolution the weights of the kernel points stand one below the other.
struct Layer {
  Rows weights;             ///< inputs x outputs
  Eigen::RowVectorXf bias;  ///< of the outputs
};

/// A bottleneck (He et al., CVPR 2016) around a convolution of half as many channels.
struct Bottleneck {
  Layer reduce;
  Layer convolution;
  Layer expand;
  std::optional<Layer> shortcut;  ///< where outputs are not as many as inputs
};

/// Weights of a KPConv network (Thomas et al., ICCV 2019): an encoder of five levels with bottlenecks, a decoder that
/// takes the level above and what the encoder had, and scores of the classes.
struct NetworkWeights {
  Layer first;
  std::array<std::vector<Bottleneck>, kNumLevels> encoder;
  std::array<Layer, kNumLevels - 1> decoder;
  Layer head;
  Layer scores;
  std::string training;  ///< what the file says of it, as JSON
};

/// Reads a file of tools/training/weights.py. Throws IoError: not such a file, damaged (checksum), cut off, of another
/// version, of other classes or features than ours, or with matrices of other shapes than its widths ask for.
///
/// Shared, so that the library frees what it has allocated: Eigen's matrices are aligned as -march asks for, and that
/// of the caller may be another.
std::shared_ptr<const NetworkWeights> read_network(const std::filesystem::path& path);

}  // namespace vdbmap::parking
