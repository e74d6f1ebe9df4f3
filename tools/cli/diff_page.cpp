// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/diff_page.h"

#include "tools/cli/short_names.h"
#include "vdbmap/io/vdb/map_file.h"
#include "vdbmap/render/change_page.h"
#include "vdbmap/render/image.h"
#include "vdbmap/store/city_folder.h"
#include "vdbmap/store/city_window.h"

namespace vdbmap::cli {
namespace {

// The day of the latest epoch of a map file; empty where nobody said.
std::string date_of(const std::filesystem::path& map) {
  if (is_city(map)) return "";
  const MapHistory history = load_history(map);
  return history.epochs.empty() ? "" : history.epochs.back().date;
}

}  // namespace

void write_diff_page(const std::filesystem::path& output, const DiffPage& page, const MapDiff& diff,
                     const std::vector<ChangeRegion>& regions) {
  const std::vector<std::string> names = short_names({page.earlier, page.later});
  const VoxelMap earlier = load_map_or_city(page.earlier), later = load_map_or_city(page.later);
  const std::vector<std::string> dates =
      page.dates.empty() ? std::vector{date_of(page.earlier), date_of(page.later)} : page.dates;
  write_picture(output, draw_change_page({earlier, names[0], dates[0]}, {later, names[1], dates[1]}, diff, regions));
}

}  // namespace vdbmap::cli
