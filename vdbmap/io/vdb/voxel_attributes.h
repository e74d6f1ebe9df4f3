// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <openvdb/points/AttributeArray.h>

#include "vdbmap/io/vdb/standard_grids.h"

/// Types of the attributes of a voxel grid, and access to their codes.
namespace vdbmap {

using PointLeaf = openvdb::points::PointDataTree::LeafNodeType;

using PositionArray = openvdb::points::TypedAttributeArray<openvdb::Vec3f, openvdb::points::FixedPointCodec<false>>;
using VectorArray = openvdb::points::TypedAttributeArray<openvdb::Vec3f>;
using NormalArray = openvdb::points::TypedAttributeArray<openvdb::Vec3f, openvdb::points::UnitVecCodec>;
using ShareArray =
    openvdb::points::TypedAttributeArray<float, openvdb::points::FixedPointCodec<true, openvdb::points::UnitRange>>;
using FloatArray = openvdb::points::TypedAttributeArray<float>;
using IntArray = openvdb::points::TypedAttributeArray<std::int32_t>;

/// The type that holds the values of a channel.
template <typename Value>
using ChannelArray = openvdb::points::TypedAttributeArray<Value>;

/// Writes codes as they are: OpenVDB's own encoders round down, so a value written and read back would drift.
template <typename Array>
class CodeWriter {
 public:
  using Storage = typename Array::StorageType;

  CodeWriter(PointLeaf& leaf, const char* name) {
    openvdb::points::AttributeArray& array = leaf.attributeArray(name);
    array.expand(/*fill=*/false);
    // The only way to the codes is const; the memory behind it is not.
    codes_ = const_cast<Storage*>(static_cast<const Array&>(array).constData());
  }
  Storage& operator[](std::size_t i) { return codes_[i]; }

 private:
  Storage* codes_;
};

/// Reads codes as they are.
template <typename Array>
class CodeReader {
 public:
  explicit CodeReader(const openvdb::points::AttributeArray& array)
      : is_uniform_(array.isUniform()), codes_(static_cast<const Array&>(array).constData()) {}
  const typename Array::StorageType& operator[](std::size_t i) const { return codes_[is_uniform_ ? 0 : i]; }

 private:
  bool is_uniform_;
  const typename Array::StorageType* codes_;
};

}  // namespace vdbmap
