// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/vdb/vdb_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/atomic_file.h"
#include "vdbmap/io/vdb/vdb_checksum.h"
#include "vdbmap/io/vdb/vdb_outline.h"

namespace vdbmap {
namespace {

// The archive of openvdb::io::File on streams of ours: File itself sees neither a full disk nor the end of a file that
// promises more than it holds, behind which it goes on reading nothing into ever more memory.
class SeekableArchive : public openvdb::io::Archive {
 public:
  // The stream throws at its end.
  VdbContent read_from(std::istream& stream, const GridFilter& is_wanted) {
    readHeader(stream);
    VdbContent content;
    content.metadata = std::make_shared<openvdb::MetaMap>();
    content.metadata->readMeta(stream);
    const std::int32_t num_grids = readGridCount(stream);
    if (!inputHasGridOffsets()) {
      content.grids = read_in_turn(stream, num_grids, is_wanted);
    } else {
      content.grids = read_chosen(stream, read_entries(stream, num_grids), is_wanted);
    }
    return content;
  }

  void write_to(std::ostream& stream, const openvdb::GridCPtrVec& grids, const openvdb::MetaMap& metadata) const {
    Archive::write(stream, grids, /*seekable=*/true, metadata);
  }

  // What Archive::write() does, grid by grid.
  void write_to(std::ostream& stream, const std::vector<GridMaker>& grids, const openvdb::MetaMap& metadata) const {
    openvdb::io::StreamMetadata::Ptr stream_metadata(new openvdb::io::StreamMetadata);
    openvdb::io::setStreamMetadataPtr(stream, stream_metadata, /*transfer=*/false);
    openvdb::io::setDataCompression(stream, compression());
    openvdb::io::setWriteGridStatsMetadata(stream, isGridStatsMetadataEnabled());
    writeHeader(stream, /*seekable=*/true);
    metadata.writeMeta(stream);
    const auto count = static_cast<std::int32_t>(grids.size());
    stream.write(reinterpret_cast<const char*>(&count), sizeof(count));
    for (const GridMaker& make : grids) {
      const openvdb::GridBase::ConstPtr grid = make();
      openvdb::io::GridDescriptor descriptor(grid->getName(), grid->type(), grid->saveFloatAsHalf());
      if (grid->constBaseTree().leafCount() > 0) {
        writeGrid(descriptor, grid, stream, /*seekable=*/true);
      } else {
        write_streamed(descriptor, *grid, stream);
      }
      openvdb::io::setDataCompression(stream, compression());  // the grid may have set its own
    }
    openvdb::io::clearStreamMetadataPtr(stream);
  }

 private:
  // What Archive::writeGrid() does, but for a table of the leaves that readers load later: it would be that of a tree
  // whose leaves are not there, and readers end at its end.
  void write_streamed(openvdb::io::GridDescriptor& descriptor, const openvdb::GridBase& grid,
                      std::ostream& stream) const {
    descriptor.writeHeader(stream);
    const std::streampos offsets = stream.tellp();
    descriptor.writeStreamPos(stream);
    descriptor.setGridPos(stream.tellp());
    setGridCompression(stream, grid);
    const auto described = openvdb::ConstPtrCast<openvdb::GridBase>(grid.copyGrid());
    described->addStatsMetadata();
    described->writeMeta(stream);
    grid.writeTransform(stream);
    grid.writeTopology(stream);
    descriptor.setBlockPos(stream.tellp());
    grid.writeBuffers(stream);
    descriptor.setEndPos(stream.tellp());
    stream.seekp(offsets);
    descriptor.writeStreamPos(stream);
    stream.seekp(descriptor.getEndPos());
  }

  struct Entry {
    openvdb::io::GridDescriptor descriptor;
    openvdb::GridBase::Ptr grid;  // of its type, without content
  };

  static Entry read_entry(std::istream& stream) {
    Entry entry;
    entry.grid = entry.descriptor.read(stream);
    return entry;
  }

  // In the order of their names, as File has them.
  static std::vector<Entry> read_entries(std::istream& stream, std::int32_t num_grids) {
    std::vector<Entry> entries;
    for (std::int32_t i = 0; i < num_grids; ++i) {
      entries.push_back(read_entry(stream));
      entries.back().descriptor.seekToEnd(stream);
    }
    std::ranges::stable_sort(entries, std::less(), [](const Entry& entry) { return entry.descriptor.gridName(); });
    return entries;
  }

  // Grids that share the tree of another need that one too.
  openvdb::GridPtrVec read_chosen(std::istream& stream, const std::vector<Entry>& entries,
                                  const GridFilter& is_wanted) const {
    NamedGridMap read;
    const auto read_once = [&](const Entry& entry) {
      if (!read.emplace(entry.descriptor.uniqueName(), entry.grid).second) return;
      entry.descriptor.seekToGrid(stream);
      readGrid(entry.grid, entry.descriptor, stream);
    };
    openvdb::GridPtrVec chosen;
    for (const Entry& entry : entries) {
      if (is_wanted && !is_wanted(openvdb::io::GridDescriptor::nameAsString(entry.descriptor.uniqueName()))) continue;
      read_once(entry);
      for (const Entry& other : entries) {
        if (other.descriptor.uniqueName() == entry.descriptor.instanceParentName()) read_once(other);
      }
      connectInstance(entry.descriptor, read);
      chosen.push_back(entry.grid);
    }
    return chosen;
  }

  // A stream's grids are read one after the other, wanted or not.
  openvdb::GridPtrVec read_in_turn(std::istream& stream, std::int32_t num_grids, const GridFilter& is_wanted) const {
    NamedGridMap read;
    openvdb::GridPtrVec chosen;
    for (std::int32_t i = 0; i < num_grids; ++i) {
      const Entry entry = read_entry(stream);
      readGrid(entry.grid, entry.descriptor, stream);
      read[entry.descriptor.uniqueName()] = entry.grid;
      connectInstance(entry.descriptor, read);
      const std::string name = openvdb::io::GridDescriptor::nameAsString(entry.descriptor.uniqueName());
      if (!is_wanted || is_wanted(name)) chosen.push_back(entry.grid);
    }
    return chosen;
  }
};

std::ifstream open_for_reading(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw IoError::system(path, "cannot open", errno);
  return stream;
}

template <typename Grids>
void write_grids(const std::filesystem::path& path, const Grids& grids, const openvdb::MetaMap& metadata) {
  SeekableArchive archive;
  archive.setCompression(openvdb::io::COMPRESS_ACTIVE_MASK | openvdb::io::COMPRESS_BLOSC);
  std::ofstream stream(path, std::ios::binary | std::ios::trunc);
  stream.exceptions(std::ios::badbit | std::ios::failbit);
  archive.write_to(stream, grids, metadata);
  stream.close();
}

VdbContent read_grids(const std::filesystem::path& path, const GridFilter& is_wanted) {
  auto stream_metadata = std::make_shared<openvdb::io::StreamMetadata>();
  std::ifstream stream = open_for_reading(path);
  stream.exceptions(std::ios::badbit | std::ios::failbit);
  openvdb::io::setStreamMetadataPtr(stream, stream_metadata);
  return SeekableArchive().read_from(stream, is_wanted);
}

}  // namespace

VdbContent read_vdb(const std::filesystem::path& path, const GridFilter& is_wanted) {
  read_vdb_outline(path);
  const bool is_whole = check_checksum(path);
  openvdb::initialize();
  try {
    return read_grids(path, is_wanted);
  } catch (const std::ios_base::failure&) {
    throw IoError::malformed(path, "is damaged: a grid goes on beyond the end of the file");
  } catch (const std::exception& error) {  // damage also ends in bad_alloc, and in messages of kilobytes
    if (is_whole && dynamic_cast<const std::bad_alloc*>(&error)) throw;
    constexpr std::size_t kMaxMessage = 80;
    const std::string message = std::string(error.what()).substr(0, kMaxMessage);
    throw IoError::malformed(path, "cannot be read as OpenVDB: " + message);
  }
}

namespace {

template <typename Grids>
void write_atomically(const std::filesystem::path& path, const Grids& grids, const openvdb::MetaMap& metadata) {
  openvdb::initialize();
  AtomicFile target(path);
  try {
    write_grids(target.temporary_path(), grids, metadata);
    write_checksum(target.temporary_path());
  } catch (const std::ios_base::failure&) {
    throw IoError::system(path, "cannot write", errno);
  } catch (const openvdb::Exception& error) {
    throw IoError::system(path, std::string("cannot write (") + error.what() + ")", errno);
  }
  target.commit();
}

}  // namespace

void write_vdb(const std::filesystem::path& path, const openvdb::GridCPtrVec& grids, const openvdb::MetaMap& metadata) {
  write_atomically(path, grids, metadata);
}

void write_vdb_grid_by_grid(const std::filesystem::path& path, const std::vector<GridMaker>& grids,
                            const openvdb::MetaMap& metadata) {
  write_atomically(path, grids, metadata);
}

}  // namespace vdbmap
