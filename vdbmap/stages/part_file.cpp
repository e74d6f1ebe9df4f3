// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/stages/part_file.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/core/parallel.h"
#include "vdbmap/io/file/atomic_file.h"
#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/store/content_hash.h"
#include "vdbmap/store/json_field.h"
#include "vdbmap/store/source_hash.h"
#include "vdbmap/store/sums_file.h"

namespace vdbmap {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kPartName = "vdbmap part";
constexpr std::int32_t kPartFormat = 1;

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

std::string description_of(const Job& job, std::size_t source, const PartNotes& found,
                           const std::vector<PartTile>& tiles) {
  Json json = {{"format", kPartName}, {"version", kPartFormat}, {"plan", job.key}, {"source", source}};
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

std::string end_of(const std::string& description) {
  std::uint64_t size = description.size();
  if constexpr (std::endian::native == std::endian::big) size = swap_bytes(size);
  std::string end(sizeof(size), '\0');
  std::memcpy(end.data(), &size, sizeof(size));
  return end + hash_of_bytes(description) + std::string(kMark);
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

// The description of a part that is whole, and how many bytes lie before it.
std::pair<Json, std::uint64_t> read_description(const std::filesystem::path& path) {
  ByteReader file(path, ByteReader::Loading::kOnDemand);
  const char* const is_cut = "is no part, or was cut";
  if (file.size() < kEndSize) throw IoError::malformed(path, is_cut);
  file.seek(file.size() - kEndSize);
  const auto size = file.read_le<std::uint64_t>();
  const std::string hash(file.bytes(ContentHash::kNumDigits));
  if (file.bytes(kMark.size()) != kMark || size > file.size() - kEndSize) throw IoError::malformed(path, is_cut);
  const std::uint64_t begin = file.size() - kEndSize - size;
  file.seek(begin);
  const std::string_view text = file.bytes(size);
  if (hash_of_bytes(text) != hash) throw IoError::malformed(path, "is damaged");
  return {parse_json(text, path), begin};
}

}  // namespace

void write_part(const Job& job, std::size_t source, const PartNotes& found, TileSums& sums) {
  std::vector<TileId> ids = sums.tiles();
  std::ranges::sort(ids, {}, [&](const TileId& id) { return std::tuple(bucket_of(id, job.plan.num_buckets), id); });
  std::vector<PartTile> tiles(ids.size());
  AtomicFile file(part_path(job.folder, source));
  std::vector<std::string> packed(num_threads());
  for (std::size_t begin = 0; begin < ids.size(); begin += packed.size()) {
    const std::size_t count = std::min(packed.size(), ids.size() - begin);
    parallel_for(count, [&](std::size_t i) {
      packed[i] = pack_sums(sums.take(ids[begin + i]));
      tiles[begin + i] = {ids[begin + i], 0, packed[i].size(), hash_of_bytes(packed[i])};
    });
    for (std::size_t i = 0; i < count; ++i) file.write(packed[i]);
  }
  const std::string description = description_of(job, source, found, tiles);
  file.write(description);
  file.write(end_of(description));
  file.commit();
  sync_folder(parts_path(job.folder));
}

Part open_part(const Job& job, std::size_t source) {
  const std::filesystem::path path = part_path(job.folder, source);
  const auto [json, num_bytes] = read_description(path);
  const JsonField root(json, "", path);
  root.check_format(kPartName, kPartFormat);
  if (root.at("plan").text() != job.key) throw IoError::malformed(path, "is of another plan");
  if (root.at("source").count() != source) {
    throw IoError::malformed(path, "is of source " + std::to_string(root.at("source").count()));
  }
  const MapInput& input = job.plan.sources[source].input;
  Part part{path, {}, part_tiles(root.at("tiles"), num_bytes)};
  part.found.source = {source_name(input), root.at("hash").hash(ContentHash::kNumDigits), root.at("counted").count()};
  part.found.kinds = {root.at("has_color").truth(), root.at("has_intensity").truth(), root.at("has_labels").truth()};
  part.found.notes = notes_of(root.at("notes"), input.scan.file);
  return part;
}

void add_tile_of_part(const Part& part, const PartTile& tile, VoxelBlocks& blocks) {
  ByteReader file(part.path, ByteReader::Loading::kOnDemand);
  if (tile.num_bytes > file.size() || tile.offset > file.size() - tile.num_bytes) {
    throw IoError::malformed(part.path, "was cut");
  }
  file.seek(tile.offset);
  const std::string_view bytes = file.bytes(tile.num_bytes);
  if (hash_of_bytes(bytes) != tile.hash) {
    throw IoError::malformed_at_byte(part.path, tile.offset, "the sums are damaged: remove the file and map it again");
  }
  add_packed_sums(bytes, part.path, blocks);
}

}  // namespace vdbmap
