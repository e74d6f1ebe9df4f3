// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/evaluation/error_panels.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "registration/evaluation/error_histogram.h"
#include "vdbmap/render/draw.h"
#include "vdbmap/render/plot_area.h"
#include "vdbmap/render/text.h"

namespace vdbmap::registration {
namespace {

constexpr Rgb8 kBarColor = rgb8(0x4878a8);
constexpr Rgb8 kPanelTextColor = rgb8(0x202020);
constexpr Rgb8 kQuietColor = rgb8(0x606060);
constexpr int kTextSize = 15;         // [pixels]
constexpr double kLineHeight = 25;    // [pixels]
constexpr double kLargestInCm = 0.5;  // [m] errors below are easier to read in cm

/// The unit of an axis and how many of it make a metre.
struct Unit {
  const char* name;
  double per_metre;
};

Unit unit_of(const ErrorHistogram& histogram) {
  const double largest = std::max(std::abs(histogram.first), std::abs(histogram.last()));
  return largest <= kLargestInCm ? Unit{"cm", 100} : Unit{"m", 1};
}

PlotArea area_of(const ErrorHistogram& histogram, const Eigen::AlignedBox2d& frame, double per_metre) {
  const std::size_t most = *std::max_element(histogram.counts.begin(), histogram.counts.end());
  PlotArea area;
  area.frame = frame;
  area.values.min() = Eigen::Vector2d(histogram.first * per_metre, 0);
  area.values.max() =
      Eigen::Vector2d(histogram.last() * per_metre, 1.1 * static_cast<double>(std::max<std::size_t>(most, 4)));
  return area;
}

void draw_bars(Image& image, const PlotArea& area, const ErrorHistogram& histogram, double per_metre) {
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
    const double left = (histogram.first + histogram.width * static_cast<double>(i)) * per_metre;
    const double right = left + histogram.width * per_metre;
    Eigen::AlignedBox2d bar(area.pixel_of({left, 0}));
    bar.extend(area.pixel_of({right, static_cast<double>(histogram.counts[i])}));
    bar.min().x() += 1;
    bar.max().x() -= 1;
    if (histogram.counts[i] > 0) fill_box(image, bar, {kBarColor});
  }
}

std::string beyond_text(const ErrorHistogram& histogram) {
  const std::size_t count = histogram.num_below + histogram.num_above;
  return count == 0 ? "" : std::to_string(count) + (count == 1 ? " scan" : " scans") + " beyond this axis";
}

std::string formatted(const char* format, double a, double b = 0) {
  char text[128];
  std::snprintf(text, sizeof text, format, a, b);
  return text;
}

/// Writes lines of text one below the other.
class TextColumn {
 public:
  TextColumn(Image& image, const Eigen::Vector2d& corner) : image_(image), place_(corner) {}

  void add(const std::string& text, bool is_bold = false) {
    draw_text(image_, place_, text, {.size = kTextSize, .ink = {kPanelTextColor}, .is_bold = is_bold});
    place_.y() += kLineHeight;
  }

  /// A name and numbers in columns of their own.
  void add_row(const std::string& name, std::span<const std::string> cells, Rgb8 color = kPanelTextColor) {
    draw_text(image_, place_, name, {.size = kTextSize, .ink = {color}});
    double right = place_.x() + kNameWidth;
    for (const std::string& cell : cells) {
      right += kCellWidth;
      draw_text(image_, {right, place_.y()}, cell, {.size = kTextSize, .ink = {color}, .align = TextAlign::kRight});
    }
    place_.y() += kLineHeight;
  }

  void add_row(const std::string& name, const ErrorSummary& summary, double factor, const char* format) {
    std::vector<std::string> cells;
    for (const double value : {summary.median, summary.mean, summary.rms, summary.max}) {
      cells.push_back(std::isnan(value) ? "-" : formatted(format, value * factor));
    }
    add_row(name, cells);
  }

  void skip() { place_.y() += kLineHeight / 2; }

 private:
  static constexpr double kNameWidth = 105;
  static constexpr double kCellWidth = 76;

  Image& image_;
  Eigen::Vector2d place_;
};

void add_success(TextColumn& column, const TrajectoryError& error, const SuccessThreshold& threshold) {
  column.add(formatted("within %g m and %g deg: ", threshold.translation, threshold.rotation_deg) +
             formatted("%.1f %%", 100 * success_rate(error, threshold)));
}

}  // namespace

void draw_error_histogram(Image& image, const Eigen::AlignedBox2d& frame, const std::string& title,
                          std::span<const double> errors) {
  const ErrorHistogram histogram = histogram_of(errors);
  const Unit unit = unit_of(histogram);
  const PlotArea area = area_of(histogram, frame, unit.per_metre);
  draw_axes(image, area, {title, std::string("error [") + unit.name + "]", "scans"});
  draw_bars(image, area, histogram, unit.per_metre);
  const Eigen::Vector2d note(frame.max().x() - 10, frame.min().y() + 16);
  const std::string text = errors.empty() ? "no pose to judge" : beyond_text(histogram);
  draw_text(image, note, text, {.size = kTextSize, .ink = {kQuietColor}, .align = TextAlign::kRight});
}

void draw_error_figures(Image& image, const Eigen::Vector2d& corner, const TrajectoryError& error,
                        const std::optional<ErrorSummary>& aligned) {
  TextColumn column(image, corner);
  const bool is_small = !(error.translation.max > 10);  // [m]
  const double factor = is_small ? 100 : 1;
  const std::string unit = is_small ? " [cm]" : " [m]";
  column.add_row("error", std::vector<std::string>{"median", "mean", "rms", "max"}, kQuietColor);
  column.add_row("XY" + unit, error.xy, factor, "%.2f");
  column.add_row("Z" + unit, error.z, factor, "%.2f");
  column.add_row("XYZ" + unit, error.translation, factor, "%.2f");
  if (aligned) column.add_row("aligned" + unit, *aligned, factor, "%.2f");
  column.add_row("rotation [deg]", error.rotation_deg, 1, "%.3f");
  column.skip();
  column.add(
      std::to_string(error.num_judged - error.num_missing) + " of " + std::to_string(error.num_judged) + " scans found",
      true);
  add_success(column, error, kFineSuccess);
  add_success(column, error, kCoarseSuccess);
}

}  // namespace vdbmap::registration
