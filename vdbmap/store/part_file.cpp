// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/part_file.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/core/parallel_tasks.h"
#include "vdbmap/io/file/atomic_file.h"
#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/store/content_hash.h"
#include "vdbmap/store/json_field.h"
#include "vdbmap/store/sums_file.h"

namespace vdbmap {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kPartName = "vdbmap part";
constexpr std::int32_t kPartFormat = 2;

// The end of a part: size of the description, its hash, and what tells parts from other files.
constexpr std::string_view kMark = "VDBMPART";
constexpr std::size_t kEndSize = sizeof(std::uint64_t) + ContentHash::kNumDigits + kMark.size();

Json json_of(const ReadFinding& finding) {
  return {{"what", finding.what}, {"count", finding.count}, {"first", finding.first}, {"is_damage", finding.is_damage}};
}

Json json_of(const PartTile& tile) {
  return {{"x", tile.id.x}, {"y", tile.id.y}, {"bytes", tile.num_bytes}, {"hash", tile.hash}};
}

Json json_of(const InputNotes& notes) {
  Json json = {{"points", notes.num_points}, {"dropped", notes.num_dropped}, {"out_of_range", notes.num_out_of_range}};
  json["findings"] = Json::array();
  json["of_dropped_classes"] = notes.num_of_dropped_classes;
  for (const FileFinding& finding : notes.findings) json["findings"].push_back(json_of(finding.finding));
  json["epsg"] = notes.epsg_of_files ? Json(*notes.epsg_of_files) : Json(nullptr);
  json["metres_per_unit"] = notes.foreign_units.empty() ? 1.0 : notes.foreign_units.front().metres_per_unit;
  json["label_scheme"] = std::string(text_of(notes.label_scheme));
  return json;
}

std::string description_of(const std::string& made_for, const PartNotes& found, const std::vector<PartTile>& tiles) {
  Json json = {{"format", kPartName}, {"version", kPartFormat}, {"made_for", made_for}};
  json["hash"] = found.source.hash;
  json["counted"] = found.source.num_points;
  json["has_color"] = found.kinds.has_color;
  json["has_intensity"] = found.kinds.has_intensity;
  json["has_labels"] = found.kinds.has_labels;
  json["notes"] = json_of(found.notes);
  json["tiles"] = Json::array();
  for (const PartTile& tile : tiles) json["tiles"].push_back(json_of(tile));
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string end_of(const std::string& description, const std::string& hash) {
  std::uint64_t size = description.size();
  if constexpr (std::endian::native == std::endian::big) size = swap_bytes(size);
  std::string end(sizeof(size), '\0');
  std::memcpy(end.data(), &size, sizeof(size));
  return end + hash + std::string(kMark);
}

InputNotes notes_of(const JsonField& field, const std::filesystem::path& file) {
  InputNotes notes;
  notes.num_points = field.at("points").count();
  notes.num_dropped = field.at("dropped").count();
  notes.num_out_of_range = field.at("out_of_range").count();
  notes.num_of_dropped_classes = field.at("of_dropped_classes").count();
  for (const JsonField& element : field.at("findings").elements()) {
    // Field by field: GCC 12 destroys members of nested braces twice where a later one throws.
    ReadFinding finding;
    finding.what = element.at("what").text();
    finding.count = element.at("count").count();
    finding.first = element.at("first").text();
    finding.is_damage = element.at("is_damage").truth();
    notes.findings.push_back({file, finding});
  }
  if (!field.at("epsg").is_null()) notes.epsg_of_files = field.at("epsg").integer();
  const double unit = field.at("metres_per_unit").number();
  if (unit != 1.0) notes.foreign_units.push_back({file, unit});
  const std::optional<LabelScheme> scheme = label_scheme_of(field.at("label_scheme").text());
  if (!scheme) field.at("label_scheme").fail("is not known");
  notes.label_scheme = *scheme;
  return notes;
}

std::vector<PartTile> part_tiles(const JsonField& field, std::uint64_t num_bytes_of_all) {
  std::vector<PartTile> tiles;
  std::uint64_t offset = 0;
  for (const JsonField& element : field.elements()) {
    PartTile tile;
    tile.id = {element.at("x").integer(), element.at("y").integer()};
    tile.offset = offset;
    tile.num_bytes = element.at("bytes").count();
    tile.hash = element.at("hash").hash(ContentHash::kNumDigits);
    if (tile.num_bytes > num_bytes_of_all - offset) element.fail("ends beyond the sums");
    offset += tile.num_bytes;
    tiles.push_back(std::move(tile));
  }
  if (offset != num_bytes_of_all) field.fail("are not all of the sums");
  return tiles;
}

// The description of a part that is whole.
struct Description {
  Json json;
  std::string hash;
  std::uint64_t num_bytes_before;
};

Description read_description(const std::filesystem::path& path) {
  ByteReader file(path, ByteReader::Loading::kOnDemand);
  const char* const is_cut = "is no part, or was cut";
  if (file.size() < kEndSize) throw IoError::malformed(path, is_cut);
  file.seek(file.size() - kEndSize);
  const auto size = file.read_le<std::uint64_t>();
  std::string hash(file.bytes(ContentHash::kNumDigits));
  if (file.bytes(kMark.size()) != kMark || size > file.size() - kEndSize) throw IoError::malformed(path, is_cut);
  const std::uint64_t begin = file.size() - kEndSize - size;
  file.seek(begin);
  const std::string_view text = file.bytes(size);
  if (hash_of_bytes(text) != hash) throw IoError::malformed(path, "is damaged");
  return {parse_json(text, path), std::move(hash), begin};
}

void add_notes(InputNotes& notes, const InputNotes& of_source) {
  notes.num_points += of_source.num_points;
  notes.num_dropped += of_source.num_dropped;
  notes.num_out_of_range += of_source.num_out_of_range;
  notes.num_of_dropped_classes += of_source.num_of_dropped_classes;
  notes.findings.insert(notes.findings.end(), of_source.findings.begin(), of_source.findings.end());
  notes.foreign_units.insert(notes.foreign_units.end(), of_source.foreign_units.begin(), of_source.foreign_units.end());
}

}  // namespace

PartNotes to_be_kept(PartNotes found, const std::optional<int>& given_epsg) {
  if (given_epsg) found.notes.epsg_of_files = given_epsg;
  return found;
}

CommonNotes common_notes(std::span<const PartNotes* const> sources) {
  CommonNotes common;
  InputAgreement agreement;
  for (const PartNotes* found : sources) {
    const std::filesystem::path& file = found->source.name;
    agreement.add_epsg(file, found->notes.epsg_of_files);
    if (found->kinds.has_labels) agreement.add_labels(file, found->notes.label_scheme);
    common.kinds.add(found->kinds);
    add_notes(common.notes, found->notes);
  }
  common.notes.epsg_of_files = agreement.epsg();
  common.notes.label_scheme = agreement.label_scheme();
  return common;
}

std::string write_part(const std::filesystem::path& path, const std::string& made_for, const PartNotes& found,
                       std::span<const TileId> ids, const PackedTile& packed) {
  std::vector<PartTile> tiles(ids.size());
  AtomicFile file(path);
  std::vector<std::string> batch(num_threads());
  for (std::size_t begin = 0; begin < ids.size(); begin += batch.size()) {
    const std::size_t count = std::min(batch.size(), ids.size() - begin);
    parallel_tasks(count, [&](std::size_t i) {
      batch[i] = packed(ids[begin + i]);
      tiles[begin + i] = {ids[begin + i], 0, batch[i].size(), hash_of_bytes(batch[i])};
    });
    for (std::size_t i = 0; i < count; ++i) file.write(batch[i]);
  }
  const std::string description = description_of(made_for, found, tiles);
  std::string hash = hash_of_bytes(description);
  file.write(description);
  file.write(end_of(description, hash));
  file.commit();
  return hash;
}

Part open_part(const std::filesystem::path& path, const std::string& source_name,
               const std::filesystem::path& source_file) {
  const Description description = read_description(path);
  const JsonField root(description.json, "", path);
  root.check_format(kPartName, kPartFormat);
  Part part{path, root.at("made_for").text(), description.hash, {}, {}};
  part.tiles = part_tiles(root.at("tiles"), description.num_bytes_before);
  part.found.source = {source_name, root.at("hash").hash(ContentHash::kNumDigits), root.at("counted").count()};
  part.found.kinds = {root.at("has_color").truth(), root.at("has_intensity").truth(), root.at("has_labels").truth()};
  part.found.notes = notes_of(root.at("notes"), source_file);
  return part;
}

std::string packed_tile(const Part& part, const PartTile& tile) {
  ByteReader file(part.path, ByteReader::Loading::kOnDemand);
  if (tile.num_bytes > file.size() || tile.offset > file.size() - tile.num_bytes) {
    throw IoError::malformed(part.path, "was cut");
  }
  file.seek(tile.offset);
  std::string bytes(file.bytes(tile.num_bytes));
  if (hash_of_bytes(bytes) != tile.hash) {
    throw IoError::malformed_at_byte(part.path, tile.offset,
                                     "the sums of a tile are damaged: the file must go and be made anew");
  }
  return bytes;
}

void add_tile_of_part(const Part& part, const PartTile& tile, VoxelBlocks& blocks) {
  add_packed_sums(packed_tile(part, tile), part.path, blocks);
}

std::vector<TileId> ids_of(const TilesOfParts& tiles) {
  std::vector<TileId> ids;
  for (const auto& [id, places] : tiles) ids.push_back(id);
  return ids;
}

VoxelBlocks sums_of(std::span<const TileInPart> places) {
  VoxelBlocks blocks;
  for (const TileInPart& place : places) add_tile_of_part(*place.part, *place.tile, blocks);
  return blocks;
}

}  // namespace vdbmap
