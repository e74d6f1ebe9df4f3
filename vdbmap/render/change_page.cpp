// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/render/change_page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "vdbmap/change/change_colors.h"
#include "vdbmap/render/close_up.h"
#include "vdbmap/render/draw.h"
#include "vdbmap/render/render.h"
#include "vdbmap/render/text.h"

namespace vdbmap {
namespace {

constexpr int kWidth = 2400;
constexpr int kPageMargin = 80;
constexpr int kInnerWidth = kWidth - 2 * kPageMargin;
constexpr int kHeaderHeight = 210;
constexpr int kPlanHeight = 920;
constexpr int kCloseUpWidth = 700;
constexpr int kCloseUpHeight = 340;
constexpr int kGap = 16;
constexpr int kTableLeft = kPageMargin + 2 * kCloseUpWidth + kGap + 50;
constexpr std::size_t kMostCloseUps = 5;
constexpr Rgb8 kInkColor = rgb8(0x1c1c1c);
constexpr Rgb8 kQuietInk = rgb8(0x666666);
constexpr Rgb8 kRuleColor = rgb8(0xc8c8c8);

Eigen::AlignedBox2d rectangle(double left, double top, double width, double height) {
  return {Eigen::Vector2d(left, top), Eigen::Vector2d(left + width, top + height)};
}

void paste(Image& page, const Image& picture, int left, int top) {
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) page.at(left + x, top + y) = picture.at(x, y);
  }
}

std::string decimals(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

std::string grouped(std::uint64_t number) {
  std::string text = std::to_string(number);
  for (auto place = static_cast<std::ptrdiff_t>(text.size()) - 3; place > 0; place -= 3) {
    text.insert(static_cast<std::size_t>(place), 1, ',');
  }
  return text;
}

std::string title_of(const PageMap& map) { return map.date.empty() ? map.name : map.date; }

void write(Image& page, double x, double y, const std::string& text, int size, Rgb8 color = kInkColor,
           bool is_bold = false, TextAlign align = TextAlign::kLeft) {
  draw_text(page, {x, y}, text, {.size = size, .ink = {color}, .align = align, .is_bold = is_bold});
}

std::size_t count_of(std::span<const ChangeRegion> regions, Change kind) {
  return static_cast<std::size_t>(std::ranges::count(regions, kind, &ChangeRegion::kind));
}

// How much of what either survey holds the other looked at.
double compared_percent(const ChangeCounts& counts) {
  const std::uint64_t compared = counts.appeared + counts.vanished + counts.changed + counts.unchanged;
  const std::uint64_t all = compared + counts.unobserved;
  return all == 0 ? 0 : 100.0 * static_cast<double>(compared) / static_cast<double>(all);
}

void draw_header(Image& page, const PageMap& earlier, const PageMap& later, const MapDiff& diff,
                 std::span<const ChangeRegion> regions) {
  write(page, kPageMargin, 90, "What changed between " + title_of(earlier) + " and " + title_of(later), 52, kInkColor,
        true);
  double x = kPageMargin;
  for (const Change kind : {Change::kAppeared, Change::kVanished, Change::kChanged}) {
    const std::string text = std::to_string(count_of(regions, kind)) + " " + name_of(kind);
    fill_box(page, rectangle(x, 143, 30, 30), {rgb8(color_code_of(kind))});
    write(page, x + 44, 158, text, 30);
    x += 44 + text_width(text, {.size = 30}) + 50;
  }
  write(page, x, 158,
        "of what either survey saw, the other looked at " + decimals(compared_percent(diff.counts), 0) + " %", 30,
        kQuietInk);
}

Image plan_of(const PageMap& later, const MapDiff& diff, std::span<const ChangeRegion> regions) {
  RenderOptions options;
  options.size = {kInnerWidth, kPlanHeight};
  options.view = View::kPlan;
  options.color_by = ColorBy::kChange;
  RenderOverlays overlays;
  overlays.diff = &diff;
  overlays.regions.assign(regions.begin(), regions.end());
  return render(later.map, options, overlays).image;
}

void draw_pair(Image& page, int top, const CloseUps& pictures, const ChangeRegion& region) {
  paste(page, pictures.before, kPageMargin, top);
  paste(page, pictures.after, kPageMargin + kCloseUpWidth + kGap, top);
  for (const int left : {kPageMargin, kPageMargin + kCloseUpWidth + kGap}) {
    draw_box(page, rectangle(left, top, kCloseUpWidth, kCloseUpHeight), 2, {kRuleColor});
  }
  fill_box(page, rectangle(kPageMargin - 34, top, 26, kCloseUpHeight), {rgb8(color_code_of(region.kind))});
  write(page, kPageMargin - 21, top + 26, std::to_string(region.id), 24, rgb8(0xffffff), true, TextAlign::kCenter);
}

struct Column {
  const char* title;
  int left;  // [pixels] or, of numbers, the right end
  TextAlign align;
};
constexpr std::array kColumns = {Column{"no.", 50, TextAlign::kRight}, Column{"what", 76, TextAlign::kLeft},
                                 Column{"class", 200, TextAlign::kLeft}, Column{"size [m]", 630, TextAlign::kRight},
                                 Column{"sure", 745, TextAlign::kRight}};

void draw_row(Image& page, int y, const std::array<std::string, kColumns.size()>& cells, int size, Rgb8 color,
              bool is_bold) {
  for (std::size_t i = 0; i < kColumns.size(); ++i) {
    write(page, kTableLeft + kColumns[i].left, y, cells[i], size, color, is_bold, kColumns[i].align);
  }
}

void draw_region_row(Image& page, int y, const ChangeRegion& region, LabelScheme scheme) {
  const Eigen::Vector3d size = region.size();
  fill_box(page, rectangle(kTableLeft - 14, y - 14, 22, 28), {rgb8(color_code_of(region.kind))});
  draw_row(page, y,
           {std::to_string(region.id), name_of(region.kind),
            region.label == kNoLabel ? "-" : label_name(scheme, region.label),
            decimals(size.x(), 1) + " x " + decimals(size.y(), 1) + " x " + decimals(size.z(), 1),
            decimals(100 * region.confidence, 0) + " %"},
           25, kInkColor, false);
}

void draw_table(Image& page, int top, int bottom, const MapDiff& diff, std::span<const ChangeRegion> regions) {
  constexpr int kRow = 42;
  std::array<std::string, kColumns.size()> titles;
  for (std::size_t i = 0; i < titles.size(); ++i) titles[i] = kColumns[i].title;
  draw_row(page, top, titles, 23, kQuietInk, false);
  draw_line(page, {kTableLeft - 14.0, top + 22.0}, {kWidth - kPageMargin + 0.0, top + 22.0}, 2, {kRuleColor});
  const auto room = static_cast<std::size_t>(std::max(0, (bottom - top - 60) / kRow));
  const std::size_t shown = std::min(regions.size(), room);
  int y = top + 50;
  for (std::size_t i = 0; i < shown; ++i, y += kRow) draw_region_row(page, y, regions[i], diff.label_scheme);
  if (shown < regions.size()) {
    write(page, kTableLeft - 14, y, "and " + std::to_string(regions.size() - shown) + " smaller ones", 25, kQuietInk);
  }
  if (regions.empty()) write(page, kTableLeft - 14, y, "nothing", 25, kQuietInk);
}

void draw_footer(Image& page, const PageMap& earlier, const PageMap& later, const MapDiff& diff) {
  const ChangeCounts& counts = diff.counts;
  const std::string system = diff.frame.epsg ? "EPSG:" + std::to_string(*diff.frame.epsg) : "a local system";
  write(page, kPageMargin, page.height() - 45,
        earlier.name + " and " + later.name + ", voxels of " + decimals(diff.voxel_size(), 2) + " m in " + system +
            ": " + grouped(counts.appeared) + " appeared, " + grouped(counts.vanished) + " vanished, " +
            grouped(counts.changed) + " changed, " + grouped(counts.unchanged) + " unchanged, " +
            grouped(counts.unobserved) + " not observed by the other survey",
        24, kQuietInk);
}

}  // namespace

Image draw_change_page(const PageMap& earlier, const PageMap& later, const MapDiff& diff,
                       std::span<const ChangeRegion> regions) {
  const auto num_pictures = static_cast<int>(std::min(regions.size(), kMostCloseUps));
  const int pictures_top = kHeaderHeight + kPlanHeight + 90;
  const int pictures_height = std::max(3, num_pictures) * (kCloseUpHeight + kGap);
  Image page(kWidth, pictures_top + pictures_height + 90);
  draw_header(page, earlier, later, diff, regions);
  paste(page, plan_of(later, diff, regions), kPageMargin, kHeaderHeight);
  draw_box(page, rectangle(kPageMargin, kHeaderHeight, kInnerWidth, kPlanHeight), 2, {kRuleColor});
  if (num_pictures > 0) {
    write(page, kPageMargin, pictures_top - 34, "before: " + title_of(earlier), 28, kInkColor, true);
    write(page, kPageMargin + kCloseUpWidth + kGap, pictures_top - 34, "after: " + title_of(later), 28, kInkColor,
          true);
  }
  int top = pictures_top;
  for (const ChangeRegion& region : regions.first(static_cast<std::size_t>(num_pictures))) {
    const CloseUps pictures = draw_close_ups(earlier.map, later.map, diff, region, {kCloseUpWidth, kCloseUpHeight});
    draw_pair(page, top, pictures, region);
    top += kCloseUpHeight + kGap;
  }
  draw_table(page, pictures_top - 34, pictures_top + pictures_height, diff, regions);
  draw_footer(page, earlier, later, diff);
  return page;
}

}  // namespace vdbmap
