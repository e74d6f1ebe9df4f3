// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/render/render.h"

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include "tools/cli/command.h"
#include "tools/cli/map_output.h"
#include "tools/cli/number_list.h"
#include "tools/cli/output.h"
#include "tools/cli/reading.h"
#include "tools/cli/short_names.h"
#include "vdbmap/core/error.h"
#include "vdbmap/io/file/text.h"
#include "vdbmap/io/points/point_reader.h"
#include "vdbmap/io/poses/trajectory_file.h"
#include "vdbmap/io/vdb/diff_file.h"
#include "vdbmap/io/vdb/map_file.h"
#include "vdbmap/render/city_picture.h"

namespace vdbmap::cli {
namespace {

const std::map<std::string, View> kViews = {
    {"plan", View::kPlan}, {"perspective", View::kPerspective}, {"orbit", View::kOrbit}};
const std::map<std::string, ColorBy> kColors = {{"rgb", ColorBy::kRgb},       {"height", ColorBy::kHeight},
                                                {"normal", ColorBy::kNormal}, {"intensity", ColorBy::kIntensity},
                                                {"label", ColorBy::kLabel},   {"epoch", ColorBy::kEpoch},
                                                {"age", ColorBy::kAge},       {"change", ColorBy::kChange}};

struct RenderCommandOptions {
  std::filesystem::path map;
  std::filesystem::path output;
  std::string view = "orbit";
  std::string color_by;
  std::string size = "1920x1080";
  std::vector<std::filesystem::path> trajectories;
  std::vector<std::filesystem::path> points;
  std::filesystem::path diff;
  bool is_plain = false;
  ReadOptions read;
  RenderOptions render;
};

template <typename Value>
std::vector<std::string> names_of(const std::map<std::string, Value>& values) {
  std::vector<std::string> names;
  for (const auto& [name, value] : values) names.push_back(name);
  return names;
}

std::optional<int> side_of(const std::string& text) {
  const std::optional<std::uint64_t> count = parse_count(text);
  if (!count || *count < 1 || *count > static_cast<std::uint64_t>(kMaxImageSize)) return std::nullopt;
  return static_cast<int>(*count);
}

std::optional<ImageSize> parse_size(const std::string& text) {
  const std::size_t cross = text.find('x');
  if (cross == std::string::npos) return std::nullopt;
  const std::optional<int> width = side_of(text.substr(0, cross));
  const std::optional<int> height = side_of(text.substr(cross + 1));
  if (!width || !height) return std::nullopt;
  return ImageSize{*width, *height};
}

std::string check_size(const std::string& text) {
  if (parse_size(text)) return "";
  return fmt::format("is '{}', expected WIDTHxHEIGHT of 1 to {} pixels each", text, kMaxImageSize);
}

void add_overlay_options(CLI::App& app, RenderCommandOptions& options) {
  app.add_option("--trajectory", options.trajectories,
                 "Poses (KITTI or TUM) to draw over the map: red, green, blue, ...; the perspective follows the first")
      ->type_name("FILE...");
  app.add_option("--points", options.points, "Points in the frame of the map to draw over it")->type_name("FILE...");
}

void add_options(CLI::App& app, RenderCommandOptions& options) {
  app.add_option("MAP", options.map, "The map (.vdb), or a city")->type_name("FILE")->required();
  app.add_option("-o,--output", options.output, "Write the picture to this .png or .jpg file")
      ->type_name("FILE")
      ->required();
  app.add_option("--view", options.view,
                 "plan (from above), perspective (along the street) or orbit (all of it), [orbit]")
      ->check(CLI::IsMember(names_of(kViews)).description(""))
      ->type_name("NAME");
  app.add_option("--color-by", options.color_by,
                 "rgb, height, normal, intensity, label, epoch, age (how old each part of the map is) or change (with "
                 "--diff); by "
                 "default rgb where the map has colours, else height; change with --diff")
      ->check(CLI::IsMember(names_of(kColors)).description(""))
      ->type_name("NAME");
  app.add_option("--size", options.size, "Of the picture in pixels, [1920x1080]")->check(check_size)->type_name("WxH");
  add_number_list(
      app, "--camera", options.render.camera, 0, "N,...",
      "Instead of the camera that suits the map. plan: X,Y,WIDTH in m. perspective: "
      "X,Y,Z,HEADING,ELEVATION[,FIELD_OF_VIEW]. orbit: HEADING,ELEVATION[,DISTANCE]. Angles in degrees, the "
      "heading from +x to the left, elevation below the horizon negative");
  app.add_option("--level", options.render.voxel_size,
                 "Voxel size of the level to draw [m]; by default the finest, or a coarser one where points are sparse")
      ->check(CLI::PositiveNumber.description(""))
      ->type_name("S");
  app.add_flag("--plain", options.is_plain, "Only the picture: no grid, scale bar, north arrow and legend");
  app.add_option(
         "--diff", options.diff,
         "What `vdbmap diff EARLIER MAP -o` wrote: draw what appeared green, what vanished red, what changed amber, "
         "and outline the regions")
      ->type_name("FILE");
  add_overlay_options(app, options);
  add_read_options(app, options.read);
}

RenderOptions render_options(const RenderCommandOptions& options) {
  RenderOptions result = options.render;
  result.view = kViews.at(options.view);
  if (!options.color_by.empty()) result.color_by = kColors.at(options.color_by);
  result.size = *parse_size(options.size);
  result.has_decoration = !options.is_plain;
  return result;
}

RenderOverlays read_overlays(const RenderCommandOptions& options) {
  std::vector<std::filesystem::path> files = options.trajectories;
  files.insert(files.end(), options.points.begin(), options.points.end());
  const std::vector<std::string> names = short_names(files);
  RenderOverlays overlays;
  auto name = names.begin();
  for (const auto& file : options.trajectories) overlays.trajectories.push_back({*name++, read_trajectory(file)});
  ReadingReport reading;
  for (const auto& file : options.points) {
    ReadResult read = read_points(file, options.read);
    reading.add(file, read.findings);
    overlays.points.push_back({*name++, std::move(read.cloud.positions)});
  }
  reading.warn();
  return overlays;
}

void check_inputs(const RenderCommandOptions& options) {
  std::vector<std::filesystem::path> inputs = {options.map};
  inputs.insert(inputs.end(), options.trajectories.begin(), options.trajectories.end());
  inputs.insert(inputs.end(), options.points.begin(), options.points.end());
  if (!options.diff.empty()) inputs.push_back(options.diff);
  check_output(options.output, kPictureKind, inputs);
  if (options.diff.empty() && options.color_by == "change") {
    throw std::invalid_argument("--color-by change needs --diff, the file that `vdbmap diff -o` wrote");
  }
}

std::optional<MapDiff> read_diff(const RenderCommandOptions& options, RenderOverlays& overlays) {
  if (options.diff.empty()) return std::nullopt;
  MapDiff diff = load_diff(options.diff);
  overlays.regions = find_regions(diff);
  return diff;
}

struct Picture {
  RenderResult result;
  std::uint64_t num_voxels;  // of the map's finest level
  double seconds;            // of a city with what is loaded on the way
};

template <typename Render>
Picture timed(std::uint64_t num_voxels, const Render& render) {
  const auto start = std::chrono::steady_clock::now();
  RenderResult result = render();
  return {std::move(result), num_voxels,
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()};
}

void check_not_empty(std::uint64_t num_voxels, const std::filesystem::path& path) {
  if (num_voxels == 0) throw IoError::malformed(path, "holds no voxels to draw");
}

Picture draw(const RenderCommandOptions& options, const RenderOverlays& overlays) {
  if (is_city(options.map)) {
    City city = open_city(options.map);
    const std::uint64_t count = city.manifest.tiles.empty() ? 0 : num_voxels(city.manifest).front();
    check_not_empty(count, options.map);
    return timed(count, [&] { return render_city(city, render_options(options), overlays); });
  }
  const VoxelMap map = load_map(options.map);
  const std::uint64_t count = map.levels.empty() ? 0 : map.finest().size();
  check_not_empty(count, options.map);
  return timed(count, [&] { return render(map, render_options(options), overlays); });
}

ExitCode run(const RenderCommandOptions& options, const CommonOptions& common) {
  check_inputs(options);
  RenderOverlays overlays = read_overlays(options);
  const std::optional<MapDiff> diff = read_diff(options, overlays);
  if (diff) overlays.diff = &*diff;
  const Picture picture = draw(options, overlays);
  const RenderResult& result = picture.result;
  if (result.is_camera_in_voxel)
    spdlog::warn("the camera is inside of a voxel: the picture shows what is seen from there");
  write_picture(options.output, result.image);

  if (common.json) {
    print_json({{"output", options.output.string()},
                {"width", result.image.width()},
                {"height", result.image.height()},
                {"voxels", picture.num_voxels},
                {"camera_in_voxel", result.is_camera_in_voxel},
                {"seconds", picture.seconds}});
  } else {
    print_result(fmt::format("{}: {} x {} pixels, drawn in {:.2f} s\n", options.output.string(), result.image.width(),
                             result.image.height(), picture.seconds));
  }
  return ExitCode::kDone;
}

}  // namespace

Command render_command() {
  return make_command<RenderCommandOptions>(
      "render", "Draw a map as a picture",
      "vdbmap render map.vdb -o street.png\n"
      "vdbmap render map.vdb -o plan.png --view plan --color-by height --trajectory poses.txt truth.txt\n"
      "vdbmap render map2.vdb --diff diff.vdb -o changes.png --view plan\n"
      "vdbmap render map.vdb -o view.png --view perspective --camera=-5,0,1.5,20,-5 --points scan.ply",
      add_options, run);
}

}  // namespace vdbmap::cli
