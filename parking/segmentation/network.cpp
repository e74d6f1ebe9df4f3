// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/segmentation/network.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "vdbmap/core/parallel.h"

namespace vdbmap::parking {
namespace {

using Eigen::Index;

constexpr float kSlope = 0.1F;         // of the leaky rectifier
constexpr float kKernelRadius = 1.5F;  // [voxels]
constexpr float kKernelReach = 1.2F;   // [voxels] sigma of equation 3
constexpr std::size_t kLanes = 16;     // kernel points, and one that nothing reaches
constexpr Index kRowsAtOnce = 64;      // of a product: they stay in the cache
constexpr float kLowest = -1e4F;       // less than any channel

template <typename Block>
void rectify(Block&& block) {
  block = block.cwiseMax(kSlope * block);
}

// Calls body(begin, count) for blocks of rows that together cover all.
template <typename Body>
void for_row_blocks(Index rows, const Body& body) {
  const auto blocks = static_cast<std::size_t>((rows + kRowsAtOnce - 1) / kRowsAtOnce);
  parallel_for(
      blocks,
      [&](std::size_t i) {
        const Index begin = static_cast<Index>(i) * kRowsAtOnce;
        body(begin, std::min(kRowsAtOnce, rows - begin));
      },
      4);
}

enum class Activation { kNone, kRectified };

Rows apply(const Layer& layer, const Rows& rows, Activation activation) {
  Rows result(rows.rows(), layer.weights.cols());
  for_row_blocks(rows.rows(), [&](Index begin, Index count) {
    auto out = result.middleRows(begin, count);
    out.noalias() = rows.middleRows(begin, count) * layer.weights;
    out.rowwise() += layer.bias;
    if (activation == Activation::kRectified) rectify(out);
  });
  return result;
}

// Coordinates of the kernel points, a lane each.
struct Kernel {
  alignas(64) std::array<float, kLanes> x{};
  alignas(64) std::array<float, kLanes> y{};
  alignas(64) std::array<float, kLanes> z{};

  Kernel() {
    const auto points = kernel_points();
    for (std::size_t i = 0; i < kNumKernelPoints; ++i) {
      x[i] = points(0, static_cast<Index>(i));
      y[i] = points(1, static_cast<Index>(i));
      z[i] = points(2, static_cast<Index>(i));
    }
    x[kNumKernelPoints] = 1e6F;
  }
};

using Influences = std::array<float, kLanes>;

// Equation 3: 1 - distance / sigma, not below 0, on each kernel point.
inline void find_influences(const Kernel& kernel, const Eigen::Vector3f& away, Influences& influences) {
  for (std::size_t i = 0; i < kLanes; ++i) {
    const float x = away.x() - kernel.x[i], y = away.y() - kernel.y[i], z = away.z() - kernel.z[i];
    influences[i] = std::max(0.0F, 1.0F - std::sqrt(x * x + y * y + z * z) / kKernelReach);
  }
}

inline void add_scaled(float* sums, const float* values, float factor, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) sums[i] += factor * values[i];
}

// Sums over the neighbours of a voxel, weighted by their influence on each kernel point, divided by their number:
// equation 2 before its matrix. 15 times as many numbers as there are channels.
void sum_neighbours(const Kernel& kernel, const PyramidLevel& level, std::size_t voxel, const Rows& rows, float* sums) {
  const std::span<const VoxelIndex> steps = neighbour_steps();
  const auto channels = static_cast<std::size_t>(rows.cols());
  std::fill_n(sums, kNumKernelPoints * channels, 0.0F);
  const auto near = level.neighbours_of(voxel);
  const float share = 1.0F / static_cast<float>(near.size());
  alignas(64) Influences influences;
  for (const PyramidLevel::Neighbour& neighbour : near) {
    const VoxelIndex& step = steps[neighbour.step];
    const Eigen::Vector3f away =
        level.places[neighbour.voxel] - level.places[voxel] +
        Eigen::Vector3f(static_cast<float>(step.x()), static_cast<float>(step.y()), static_cast<float>(step.z()));
    find_influences(kernel, away, influences);
    const float* values = rows.data() + neighbour.voxel * channels;
    for (std::size_t i = 0; i < kNumKernelPoints; ++i) {
      if (influences[i] > 0) add_scaled(sums + i * channels, values, share * influences[i], channels);
    }
  }
}

Rows convolve(const Layer& layer, const Rows& rows, const PyramidLevel& level) {
  static const Kernel kKernel;
  Rows result(rows.rows(), layer.weights.cols());
  PerThread<Rows> working;
  for_row_blocks(rows.rows(), [&](Index begin, Index count) {
    Rows& sums = working.mine();
    sums.resize(kRowsAtOnce, layer.weights.rows());
    for (Index i = 0; i < count; ++i) {
      sum_neighbours(kKernel, level, static_cast<std::size_t>(begin + i), rows, sums.row(i).data());
    }
    auto out = result.middleRows(begin, count);
    out.noalias() = sums.topRows(count) * layer.weights;
    out.rowwise() += layer.bias;
    rectify(out);
  });
  return result;
}

Rows apply(const Bottleneck& block, const Rows& rows, const PyramidLevel& level) {
  Rows inner = convolve(block.convolution, apply(block.reduce, rows, Activation::kRectified), level);
  Rows result(rows.rows(), block.expand.weights.cols());
  for_row_blocks(rows.rows(), [&](Index begin, Index count) {
    auto out = result.middleRows(begin, count);
    out.noalias() = inner.middleRows(begin, count) * block.expand.weights;
    out.rowwise() += block.expand.bias;
    if (block.shortcut) {
      out.noalias() += rows.middleRows(begin, count) * block.shortcut->weights;
      out.rowwise() += block.shortcut->bias;
    } else {
      out += rows.middleRows(begin, count);
    }
    rectify(out);
  });
  return result;
}

// Of each parent the largest of its children's channels.
Rows pool(const Rows& rows, const PyramidLevel& level, std::size_t num_parents) {
  Rows result = Rows::Constant(static_cast<Index>(num_parents), rows.cols(), kLowest);
  for (std::size_t i = 0; i < level.size(); ++i) {
    auto parent = result.row(level.parents[i]);
    parent = parent.cwiseMax(rows.row(static_cast<Index>(i)));
  }
  return result;
}

// rows of the level above for each voxel, beside its own, through a layer.
Rows decode(const Layer& layer, const Rows& above, const Rows& own, const PyramidLevel& level) {
  Rows result(own.rows(), layer.weights.cols());
  PerThread<Rows> working;
  for_row_blocks(own.rows(), [&](Index begin, Index count) {
    Rows& beside = working.mine();
    beside.resize(kRowsAtOnce, above.cols() + own.cols());
    for (Index i = 0; i < count; ++i) {
      beside.row(i).head(above.cols()) = above.row(level.parents[static_cast<std::size_t>(begin + i)]);
      beside.row(i).tail(own.cols()) = own.row(begin + i);
    }
    auto out = result.middleRows(begin, count);
    out.noalias() = beside.topRows(count) * layer.weights;
    out.rowwise() += layer.bias;
    rectify(out);
  });
  return result;
}

}  // namespace

Eigen::Matrix<float, 3, kNumKernelPoints> kernel_points() {
  Eigen::Matrix<float, 3, kNumKernelPoints> points;
  Index next = 0;
  points.col(next++).setZero();
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {-1.0F, 1.0F}) points.col(next++) = sign * Eigen::Vector3f::Unit(axis);
  }
  const float corner = 1.0F / std::sqrt(3.0F);
  for (const float x : {-corner, corner}) {
    for (const float y : {-corner, corner}) {
      for (const float z : {-corner, corner}) points.col(next++) << x, y, z;
    }
  }
  return kKernelRadius * points;
}

Rows class_scores(const NetworkWeights& network, const VoxelPyramid& pyramid, const Rows& features) {
  std::array<Rows, kNumLevels> encoded;
  Rows rows = convolve(network.first, features, pyramid[0]);
  for (std::size_t level = 0; level < kNumLevels; ++level) {
    for (const Bottleneck& block : network.encoder[level]) rows = apply(block, rows, pyramid[level]);
    encoded[level] = std::move(rows);
    if (level + 1 < kNumLevels) rows = pool(encoded[level], pyramid[level], pyramid[level + 1].size());
  }
  rows = std::move(encoded.back());
  for (std::size_t level = kNumLevels - 1; level-- > 0;) {
    rows = decode(network.decoder[level], rows, encoded[level], pyramid[level]);
    encoded[level] = {};
  }
  return apply(network.scores, apply(network.head, rows, Activation::kRectified), Activation::kNone);
}

}  // namespace vdbmap::parking
