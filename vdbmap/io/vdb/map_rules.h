// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

#include "vdbmap/io/vdb/standard_grids.h"
#include "vdbmap/io/vdb/vdb_outline.h"

/// The single rules of check_map_file().
namespace vdbmap {

/// A .vdb file with what its headers say beside the grids.
struct CheckedFile {
  std::filesystem::path path;
  VdbOutline outline;
  openvdb::GridPtrVec grids;
  openvdb::MetaMap::Ptr metadata;
  bool is_ours = false;  ///< a map or its channels; else only what readers of any .vdb file need is asked of it
};

/// What breaks a rule: the first place and how many there are. Voxels without end may break it, so they are not all
/// kept.
class Problems {
 public:
  Problems() = default;
  Problems(std::initializer_list<std::string> texts) {
    for (const std::string& text : texts) push_back(text);
  }

  void push_back(const std::string& text) {
    if (count_++ == 0) first_ = text;
  }

  bool empty() const { return count_ == 0; }
  std::size_t size() const { return count_; }
  const std::string& front() const { return first_; }

 private:
  std::string first_;
  std::size_t count_ = 0;
};

/// What a rule found.
struct Finding {
  Problems problems;   ///< none: the rule is kept
  std::string remark;  ///< told where the rule is kept
};

/// Name of a channel and of the level it belongs to: "cov_diag" and "_1m" of "cov_diag_1m".
struct GridRole {
  std::string channel;
  std::string suffix;
};

/// The role of a grid that our files may hold; empty for any other name.
GridRole role_of_grid(const openvdb::GridBase& grid);

/// The grid of a name, or nullptr.
openvdb::GridBase::ConstPtr find_grid(const CheckedFile& file, const std::string& name);

// Rules on the file.
Finding check_file_version(const CheckedFile& file);
Finding check_grid_offsets(const CheckedFile& file);
Finding check_compression(const CheckedFile& file);
Finding check_creator(const CheckedFile& file);
Finding check_grid_names(const CheckedFile& file);
Finding check_anchor_metadata(const CheckedFile& file);

// Rules on what every grid says of itself.
Finding check_grid_types(const CheckedFile& file);
Finding check_channel_types(const CheckedFile& file);
Finding check_vector_types(const CheckedFile& file);
Finding check_grid_classes(const CheckedFile& file);
Finding check_backgrounds(const CheckedFile& file);
Finding check_half_floats(const CheckedFile& file);
Finding check_statistics(const CheckedFile& file);
Finding check_transforms(const CheckedFile& file);

// Rules on voxels.
Finding check_finite_values(const CheckedFile& file);
Finding check_index_range(const CheckedFile& file);
Finding check_empty_leaves(const CheckedFile& file);
Finding check_mean_offsets(const CheckedFile& file);
Finding check_dense_size(const CheckedFile& file);

// Rules on points and the fog that stands for them.
Finding check_density_and_color(const CheckedFile& file);
Finding check_point_attributes(const CheckedFile& file);
Finding check_known_point(const CheckedFile& file);

}  // namespace vdbmap
