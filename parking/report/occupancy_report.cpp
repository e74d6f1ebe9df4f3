// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/report/occupancy_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <utility>

#include "parking/report/space_drawing.h"
#include "parking/report/street_scene.h"
#include "parking/spaces/kerb_rows.h"
#include "vdbmap/render/decoration.h"
#include "vdbmap/render/draw.h"
#include "vdbmap/render/text.h"

namespace vdbmap::parking {
namespace {

constexpr int kPageWidth = 2480, kPageHeight = 1754;  // [pixels]
constexpr double kMargin = 80;                        // [pixels]
constexpr double kInnerWidth = kPageWidth - 2 * kMargin;
constexpr double kHeaderHeight = 150, kFooterHeight = 60;
constexpr double kSectionLength = 100, kSectionWidth = 28;  // [m]
constexpr Rgb8 kInk = rgb8(0x1c1c1c), kQuiet = rgb8(0x5c6166), kRule = rgb8(0xc9ced3), kPanel = rgb8(0xf3f5f7);

struct Spot {
  double x, y;
};

Eigen::AlignedBox2d box_at(double left, double top, double width, double height) {
  return {Eigen::Vector2d(left, top), Eigen::Vector2d(left + width, top + height)};
}

void write(Image& page, const Spot& spot, const std::string& text, int size, Rgb8 color = kInk, bool is_bold = false,
           TextAlign align = TextAlign::kLeft) {
  draw_text(page, {spot.x, spot.y}, text, {.size = size, .ink = {color}, .align = align, .is_bold = is_bold});
}

// A text that is not wider than there is room, cut with "...".
std::string fitted(const std::string& text, int size, double width) {
  if (text_width(text, {.size = size}) <= width) return text;
  std::string cut = text;
  while (!cut.empty() && text_width(cut + "...", {.size = size}) > width) cut.pop_back();
  return cut + "...";
}

// Ids may be anything, the font knows ASCII.
std::string ascii(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return c < ' ' || c > '~'; }, '?');
  return text;
}

std::string percent(double share) { return std::to_string(std::lround(100 * share)) + " %"; }

void paste(Image& page, const Image& picture, int left, int top) {
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) page.at(left + x, top + y) = picture.at(x, y);
  }
  draw_box(page, box_at(left, top, picture.width(), picture.height()), 2, {kRule});
}

// What all pages have.
class Pages {
 public:
  explicit Pages(const OccupancyRecord& record) : record_(record) {}

  Image& add(const std::string& title) {
    pages_.emplace_back(kPageWidth, kPageHeight);
    Image& page = pages_.back();
    write(page, {kMargin, 70}, "Parking occupancy", 52, kInk, true);
    write(page, {kMargin, 122}, title, 28, kQuiet);
    const double right = kPageWidth - kMargin;
    write(page, {right, 66}, fitted(ascii(record_.place), 36, 1100), 36, kInk, true, TextAlign::kRight);
    write(page, {right, 118}, record_.date.empty() ? "date not known" : record_.date, 28, kQuiet, false,
          TextAlign::kRight);
    fill_box(page, box_at(kMargin, kHeaderHeight, kInnerWidth, 3), {kInk});
    return page;
  }

  std::vector<Image> take() {
    for (std::size_t i = 0; i < pages_.size(); ++i) {
      const std::string number = "page " + std::to_string(i + 1) + " of " + std::to_string(pages_.size());
      write(pages_[i], {kPageWidth - kMargin, kPageHeight - 42}, number, 22, kQuiet, false, TextAlign::kRight);
      write(pages_[i], {kMargin, kPageHeight - 42}, footer(), 22, kQuiet);
    }
    return std::move(pages_);
  }

 private:
  std::string footer() const {
    const std::string rule = record_.rule.as_paper
                                 ? "vacant: no vehicle point (rule of Mortazavi et al. 2023)"
                                 : "vacant: laser rays passed through the space; unknown: nothing tells, mostly hidden";
    return "map " + fitted(ascii(record_.map_name), 22, 500) + "   |   " + rule;
  }

  const OccupancyRecord& record_;
  std::vector<Image> pages_;
};

void write_count(Image& page, const Eigen::AlignedBox2d& panel, std::size_t count, const std::string& name,
                 Rgb8 color) {
  fill_box(page, panel, {kPanel});
  fill_box(page, box_at(panel.min().x(), panel.min().y(), 12, panel.sizes().y()), {color});
  write(page, {panel.min().x() + 40, panel.min().y() + 62}, std::to_string(count), 68, color, true);
  write(page, {panel.min().x() + 40, panel.max().y() - 34}, name, 28, kQuiet);
}

// The share of occupied spaces between its bounds, on a bar of all of them.
void draw_share(Image& page, const Eigen::AlignedBox2d& panel, const StreetOccupancy& street) {
  fill_box(page, panel, {kPanel});
  const double left = panel.min().x() + 30, top = panel.min().y(), width = panel.sizes().x() - 60;
  const std::string known = street.known() ? percent(*street.known()) : "not known";
  write(page, {left, top + 46}, known + " occupied", 46, kInk, true);
  const std::string range = street.num_unknown == 0
                                ? "the state of every space is known"
                                : "between " + percent(street.low()) + " and " + percent(street.high()) + ": " +
                                      std::to_string(street.num_unknown) + " of " +
                                      std::to_string(street.num_spaces()) + " spaces are unknown";
  write(page, {left, top + 92}, range, 25, kQuiet);
  const double all = static_cast<double>(std::max<std::size_t>(street.num_spaces(), 1));
  double at = left;
  const std::array<std::pair<std::size_t, SpaceState>, 3> parts = {{{street.num_occupied, SpaceState::kOccupied},
                                                                    {street.num_unknown, SpaceState::kUnknown},
                                                                    {street.num_vacant, SpaceState::kVacant}}};
  for (const auto& [count, state] : parts) {
    const double part = width * static_cast<double>(count) / all;
    fill_box(page, box_at(at, top + 116, part, 34), {color_of(state)});
    at += part;
  }
  for (const double share : {street.low(), street.high()}) {
    fill_box(page, box_at(left + width * share - 2, top + 110, 4, 46), {kInk});
  }
}

// Ids of spaces, cut where there is no room.
std::string list_of(const OccupancyRecord& record, SpaceState state, std::size_t& count) {
  std::string ids;
  count = 0;
  for (std::size_t i = 0; i < record.spaces.size(); ++i) {
    if (record.spaces[i].is_candidate || !has_changed(record.states[i]) || record.states[i].state != state) continue;
    ids += (ids.empty() ? "" : ", ") + ascii(record.spaces[i].id);
    ++count;
  }
  return ids;
}

std::string last_date(const OccupancyRecord& record) {
  for (const ParkingSpace& space : record.spaces) {
    if (!space.history.empty() && !space.history.back().date.empty()) return space.history.back().date;
  }
  return "";
}

void write_changes(Image& page, const Eigen::AlignedBox2d& panel, const OccupancyRecord& record) {
  fill_box(page, panel, {kPanel});
  const double left = panel.min().x() + 30, top = panel.min().y(), width = panel.sizes().x() - 60;
  const StreetTurnover change = turnover(record.spaces, record.states, record.date);
  const std::string before = last_date(record);
  write(page, {left, top + 36}, "Since " + (before.empty() ? "the epoch before" : before), 30, kInk, true);
  const std::string share = std::to_string(change.num_left + change.num_came) + " of " +
                            std::to_string(change.num_known) + " spaces known in both changed";
  write(page, {panel.max().x() - 30, top + 36}, share, 23, kQuiet, false, TextAlign::kRight);
  double y = top + 88;
  for (const SpaceState state : {SpaceState::kVacant, SpaceState::kOccupied}) {
    std::size_t count = 0;
    const std::string ids = list_of(record, state, count);
    draw_disc(page, {left + 10, y}, 10, {color_of(state)});
    const std::string text =
        std::to_string(count) + " became " + std::string(text_of(state)) + (count == 0 ? "" : ": " + ids);
    write(page, {left + 34, y}, fitted(text, 25, width - 40), 25);
    y += 44;
  }
}

void draw_legend(Image& page, double left, double y) {
  const std::array<std::pair<std::string, Rgb8>, 4> entries = {{{"occupied", color_of(SpaceState::kOccupied)},
                                                                {"vacant", color_of(SpaceState::kVacant)},
                                                                {"unknown", color_of(SpaceState::kUnknown)},
                                                                {"free kerb (candidate)", kCandidateColor}}};
  for (const auto& [name, color] : entries) {
    fill_box(page, box_at(left, y - 12, 24, 24), {color});
    write(page, {left + 36, y}, name, 24, kQuiet);
    left += 70 + text_width(name, {.size = 24});
  }
  draw_disc(page, {left + 12, y}, 11, {kInk});
  draw_disc(page, {left + 12, y}, 9, {kChangeColor});
  write(page, {left + 36, y}, "changed", 24, kQuiet);
}

// A bar of a round length, its right end at `right`.
void draw_scale(Image& page, double right, double y, double pixels_per_metre) {
  double length = 1;
  for (const double step : {2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0}) {
    if (step * pixels_per_metre < 320) length = step;
  }
  const double width = length * pixels_per_metre, left = right - width;
  fill_box(page, box_at(left, y - 6, width, 12), {kInk});
  fill_box(page, box_at(left + width / 2, y - 4, width / 2 - 2, 8), {rgb8(0xffffff)});
  write(page, {left - 14, y}, std::to_string(static_cast<int>(length)) + " m", 24, kQuiet, false, TextAlign::kRight);
}

// What is drawn on all pages.
struct Drawing {
  const OccupancyRecord& record;
  const VoxelLevel& scene;
  const VoxelColors& colors;
  StreetFrame frame;

  double view_heading_deg() const { return frame.heading_deg(); }
};

// North, in the upper right corner of a picture on the page.
void draw_north(Image& page, double right, double top, double heading_deg) {
  constexpr int kSide = 200;
  Image corner(kSide * 56 / 28, kSide * 56 / 28, rgb8(0xffffff));  // its letters decide how large the arrow is
  const int left = static_cast<int>(right) - corner.width();
  for (int y = 0; y < corner.height(); ++y) {
    for (int x = 0; x < corner.width(); ++x) corner.at(x, y) = page.at(left + x, static_cast<int>(top) + y);
  }
  Image large(kPageWidth, kPageHeight);
  for (int y = 0; y < corner.height(); ++y) {
    for (int x = 0; x < corner.width(); ++x) large.at(kPageWidth - corner.width() + x, y) = corner.at(x, y);
  }
  draw_north_arrow(large, heading_deg);
  for (int y = 0; y < corner.height(); ++y) {
    for (int x = 0; x < corner.width(); ++x) {
      page.at(left + x, static_cast<int>(top) + y) = large.at(kPageWidth - corner.width() + x, y);
    }
  }
}

void add_overview(Pages& pages, const Drawing& drawing) {
  const OccupancyRecord& record = drawing.record;
  Image& page = pages.add("The street as a whole");
  const StreetOccupancy street = street_occupancy(record.spaces, record.states);
  const double top = kHeaderHeight + 30;
  const std::array<std::pair<std::size_t, SpaceState>, 3> counts = {{{street.num_occupied, SpaceState::kOccupied},
                                                                     {street.num_vacant, SpaceState::kVacant},
                                                                     {street.num_unknown, SpaceState::kUnknown}}};
  double left = kMargin;
  for (const auto& [count, state] : counts) {
    write_count(page, box_at(left, top, 210, 170), count, std::string(text_of(state)), color_of(state));
    left += 230;
  }
  draw_share(page, box_at(left, top, 780, 170), street);
  left += 800;
  write_changes(page, box_at(left, top, kPageWidth - kMargin - left, 170), record);

  const StreetFrame& frame = drawing.frame;
  const Eigen::Vector2d reach = frame.high - frame.low;
  const double width = std::max(reach.x() + 12, 40.0);
  const double pixels_per_metre = kInnerWidth / width;
  const int plan_height = static_cast<int>(std::clamp((reach.y() + 14) * pixels_per_metre, 240.0, 640.0));
  const int plan_top = static_cast<int>(top) + 200;
  paste(page,
        draw_plan(record, drawing.scene, drawing.colors, frame, (frame.low + frame.high) / 2, width,
                  {static_cast<int>(kInnerWidth), plan_height}),
        static_cast<int>(kMargin), plan_top);
  draw_north(page, kPageWidth - kMargin, plan_top, drawing.view_heading_deg());
  const double legend = plan_top + plan_height + 34;
  draw_legend(page, kMargin, legend);
  draw_scale(page, kPageWidth - kMargin, legend, pixels_per_metre);

  const int view_top = static_cast<int>(legend) + 34;
  const int view_height = kPageHeight - static_cast<int>(kFooterHeight) - 20 - view_top;
  if (view_height < 200) return;
  paste(page,
        draw_perspective(record, drawing.scene, drawing.colors, frame, {static_cast<int>(kInnerWidth), view_height}),
        static_cast<int>(kMargin), view_top);
}

// Middles [m, along and up] of the parts of the street that hold spaces, row by row from above, from left to right.
std::vector<Eigen::Vector2d> sections_of(const Drawing& drawing) {
  const StreetFrame& frame = drawing.frame;
  const Eigen::Vector2d reach = frame.high - frame.low;
  const auto count = [](double size, double most) { return std::max(1, static_cast<int>(std::ceil(size / most))); };
  const int columns = count(reach.x(), kSectionLength - 4), rows = count(reach.y(), kSectionWidth - 4);
  const Eigen::Vector2d step(reach.x() / columns, reach.y() / rows);
  std::vector<Eigen::Vector2d> middles;
  for (int row = rows - 1; row >= 0; --row) {
    for (int column = 0; column < columns; ++column) {
      const Eigen::Vector2d low = frame.low + Eigen::Vector2d(column * step.x(), row * step.y());
      const Eigen::AlignedBox2d cell(low, low + step);
      const bool has_space = std::ranges::any_of(drawing.record.spaces, [&](const ParkingSpace& space) {
        return cell.contains(frame.coordinates_of(middle_of(space)));
      });
      if (has_space) middles.push_back(cell.center());
    }
  }
  return middles;
}

void add_sections(Pages& pages, const Drawing& drawing) {
  constexpr int kGap = 24;
  const std::vector<Eigen::Vector2d> sections = sections_of(drawing);
  const double pixels_per_metre = kInnerWidth / kSectionLength;
  const int height = static_cast<int>(kSectionWidth * pixels_per_metre);
  const int first_top = static_cast<int>(kHeaderHeight) + 30;
  const std::size_t a_page = 2;
  for (std::size_t i = 0; i < sections.size(); i += a_page) {
    const std::size_t end = std::min(i + a_page, sections.size());
    const std::string title = sections.size() == 1 ? "The spaces"
                              : end == i + 1       ? "Section " + std::to_string(i + 1)
                                             : "Sections " + std::to_string(i + 1) + " and " + std::to_string(end);
    Image& page = pages.add(title + " of " + std::to_string(sections.size()));
    int top = first_top;
    for (std::size_t k = i; k < end; ++k) {
      paste(page,
            draw_plan(drawing.record, drawing.scene, drawing.colors, drawing.frame, sections[k], kSectionLength,
                      {static_cast<int>(kInnerWidth), height}),
            static_cast<int>(kMargin), top);
      draw_north(page, kPageWidth - kMargin, top, drawing.view_heading_deg());
      write(page, {kMargin + 20, top + 28.0}, std::to_string(k + 1), 34, kInk, true);
      top += height + kGap;
    }
    draw_legend(page, kMargin, kPageHeight - kFooterHeight - 40);
    draw_scale(page, kPageWidth - kMargin, kPageHeight - kFooterHeight - 40, pixels_per_metre);
  }
}

std::string short_reason(const SpaceOccupancy& state) {
  if (state.occupant == Occupant::kThing) return "no vehicle, a thing";
  if (state.state != SpaceState::kUnknown) return "";
  const SpaceEvidence& evidence = state.evidence;
  if (!evidence.is_in_map) return "no ground in the map";
  if (evidence.num_passed == 0 && evidence.vehicle_points == 0) return "not seen";
  return evidence.num_with_other > 0 && evidence.num_passed_low > 0 ? "no vehicle for sure" : "mostly hidden";
}

// Columns of the table: where they begin, or end where they are numbers.
struct TableColumn {
  const char* name;
  double place;  // [pixels] from the left of the table
  TextAlign align;
};
constexpr std::array<TableColumn, 9> kColumns = {{{"space", 0, TextAlign::kLeft},
                                                  {"side", 130, TextAlign::kLeft},
                                                  {"state", 200, TextAlign::kLeft},
                                                  {"before", 350, TextAlign::kLeft},
                                                  {"sure", 535, TextAlign::kRight},
                                                  {"points", 650, TextAlign::kRight},
                                                  {"rays", 770, TextAlign::kRight},
                                                  {"length", 880, TextAlign::kRight},
                                                  {"", 905, TextAlign::kLeft}}};
constexpr int kTableLetters = 22;
constexpr double kRowHeight = 33, kTableGap = 80;

void write_row(Image& page, double left, double y, const OccupancyRecord& record, std::size_t i) {
  const ParkingSpace& space = record.spaces[i];
  const SpaceOccupancy& state = record.states[i];
  std::array<char, 32> length;
  std::snprintf(length.data(), length.size(), "%.1f m", space.length);
  const std::array<std::string, 9> cells = {
      fitted(ascii(space.id), kTableLetters, 120),
      ascii(space.kerb_side),
      std::string(text_of(state.state)),
      state.previous ? std::string(text_of(*state.previous)) : "",
      state.state == SpaceState::kUnknown ? "" : percent(state.confidence),
      std::to_string(state.evidence.vehicle_points - state.evidence.neighbor_points),
      std::to_string(state.evidence.rays_through),
      length.data(),
      space.is_candidate   ? "candidate"
      : has_changed(state) ? "changed"
                           : short_reason(state)};
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const bool is_state = k == 2;
    const double x = left + kColumns[k].place + (is_state ? 30 : 0);
    if (is_state) fill_box(page, box_at(left + kColumns[k].place, y - 10, 20, 20), {color_of(state.state)});
    write(page, {x, y}, cells[k], kTableLetters, k == 8 ? kQuiet : kInk, k == 0, kColumns[k].align);
  }
}

void add_tables(Pages& pages, const OccupancyRecord& record) {
  const double width = (kInnerWidth - kTableGap) / 2, top = kHeaderHeight + 50;
  const auto rows = static_cast<std::size_t>((kPageHeight - kFooterHeight - top - 60) / kRowHeight);
  for (std::size_t first = 0; first < record.spaces.size(); first += 2 * rows) {
    Image& page = pages.add("All spaces");
    for (std::size_t half = 0; half < 2; ++half) {
      const std::size_t begin = first + half * rows, end = std::min(begin + rows, record.spaces.size());
      if (begin >= end) break;
      const double left = kMargin + static_cast<double>(half) * (width + kTableGap);
      for (const TableColumn& column : kColumns) {
        write(page, {left + column.place, top}, column.name, kTableLetters, kQuiet, true, column.align);
      }
      fill_box(page, box_at(left, top + 20, width, 2), {kInk});
      for (std::size_t i = begin; i < end; ++i) {
        const double y = top + 44 + static_cast<double>(i - begin) * kRowHeight;
        if ((i - begin) % 2 == 1) fill_box(page, box_at(left, y - kRowHeight / 2, width, kRowHeight), {kPanel});
        write_row(page, left, y, record, i);
      }
    }
  }
}

}  // namespace

std::vector<Image> draw_report(const OccupancyRecord& record, const VoxelMap& map, const VoxelMap& later,
                               const GroundPlan& ground) {
  if (record.spaces.empty()) throw std::invalid_argument("a report is about one space at least");
  OccupancyRecord placed = record;  // places without a height stand on the ground that is near
  for (ParkingSpace& space : placed.spaces) {
    if (const auto height = ground.height_near(middle_of(space), 6)) space.ground = height;
  }
  const VoxelMap scene = street_scene(map, later, ground, placed.spaces);
  const VoxelColors colors(scene, scene.finest(), ColorBy::kRgb);
  const Drawing drawing{placed, scene.finest(), colors, street_frame(placed.spaces)};
  Pages pages(placed);
  add_overview(pages, drawing);
  add_sections(pages, drawing);
  add_tables(pages, placed);
  return pages.take();
}

}  // namespace vdbmap::parking
