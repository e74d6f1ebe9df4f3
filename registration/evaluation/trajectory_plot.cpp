// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/evaluation/trajectory_plot.h"

#include <stdexcept>
#include <vector>

#include "registration/evaluation/error_panels.h"
#include "registration/evaluation/trajectory_alignment.h"
#include "registration/trajectory_error.h"
#include "vdbmap/render/draw.h"
#include "vdbmap/render/plot_area.h"
#include "vdbmap/render/text.h"

namespace vdbmap::registration {
namespace {

constexpr Rgb8 kTruthColor = rgb8(0x2ca02c);  // green and red as in figure 8 of the paper
constexpr Rgb8 kEstimateColor = rgb8(0xd62728);
constexpr Rgb8 kMissingColor = rgb8(0x202020);
constexpr Rgb8 kTextColor = rgb8(0x202020);
constexpr double kTruthWidth = 7;     // [pixels] wide enough to be seen beneath a good estimate
constexpr double kEstimateWidth = 2;  // [pixels]
constexpr double kDotRadius = 3.5;    // [pixels]
constexpr double kMissingRadius = 6;  // [pixels]
constexpr double kMinExtent = 1;      // [m] shown of a trajectory that stands still

void check_size(const char* name, int size, int least) {
  if (size >= least && size <= kMaxImageSize) return;
  throw std::invalid_argument(std::string(name) + " of the plot is " + std::to_string(size) + " pixels, expected " +
                              std::to_string(least) + " to " + std::to_string(kMaxImageSize));
}

/// Where the parts of the picture lie [pixels].
struct Layout {
  Eigen::AlignedBox2d plan;
  Eigen::AlignedBox2d xy;
  Eigen::AlignedBox2d z;
  Eigen::Vector2d figures;
};

Eigen::AlignedBox2d box(double left, double top, double right, double bottom) {
  return {Eigen::Vector2d(left, top), Eigen::Vector2d(right, bottom)};
}

// A long way from left to right lies above the histograms, any other beside them.
Layout layout_of(const TrajectoryPlotOptions& options, const Eigen::Vector2d& extent) {
  constexpr double kFiguresWidth = 450;
  const double width = options.width;
  const double height = options.height;
  if (extent.x() > 1.6 * extent.y()) {
    const double middle = 0.56 * height;
    const double bar_width = (width - kFiguresWidth - 230) / 2;
    return {box(85, 100, width - 25, middle),
            box(85, middle + 110, 85 + bar_width, height - 60),
            box(185 + bar_width, middle + 110, 185 + 2 * bar_width, height - 60),
            {width - kFiguresWidth + 20, middle + 120}};
  }
  const double split = width - 560;
  const double bar_height = (height - 550) / 2;
  return {box(85, 100, split, height - 60),
          box(split + 100, 100, width - 25, 100 + bar_height),
          box(split + 100, 210 + bar_height, width - 25, 210 + 2 * bar_height),
          {split + 70, 310 + 2 * bar_height}};
}

using Positions = std::vector<Eigen::Vector2d>;

// The pieces of a trajectory between missing poses.
std::vector<Positions> pieces_of(const Trajectory& trajectory) {
  std::vector<Positions> pieces(1);
  for (const auto& pose : trajectory.map_from_scan) {
    if (pose) {
      pieces.back().emplace_back(pose->translation().head<2>());
    } else if (!pieces.back().empty()) {
      pieces.emplace_back();
    }
  }
  if (pieces.back().empty()) pieces.pop_back();
  return pieces;
}

Positions missing_positions(const Trajectory& estimate, const Trajectory& truth) {
  Positions missing;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const auto& true_pose = truth.map_from_scan[i];
    if (true_pose && !estimate.map_from_scan[i]) missing.emplace_back(true_pose->translation().head<2>());
  }
  return missing;
}

Eigen::AlignedBox2d extent_of(const std::vector<Positions>& pieces) {
  Eigen::AlignedBox2d extent;
  for (const Positions& piece : pieces) {
    for (const Eigen::Vector2d& position : piece) extent.extend(position);
  }
  return extent;
}

// A margin around the positions; a few lost estimates far away do not make the truth a dot.
Eigen::AlignedBox2d shown_extent(const std::vector<Positions>& truth, const std::vector<Positions>& estimate) {
  Eigen::AlignedBox2d shown = extent_of(truth);
  const double margin = std::max(shown.sizes().maxCoeff(), kMinExtent);
  Eigen::AlignedBox2d allowed(shown.min().array() - margin, shown.max().array() + margin);
  const Eigen::AlignedBox2d estimated = extent_of(estimate);
  if (!estimated.isEmpty()) shown.extend(estimated);
  shown = shown.intersection(allowed);
  const double edge = std::max(0.06 * shown.sizes().maxCoeff(), kMinExtent / 2);
  return {shown.min().array() - edge, shown.max().array() + edge};
}

/// Draws into the frame of an area only.
class PlanPen {
 public:
  PlanPen(Image& image, const PlotArea& area) : image_(image), area_(area) {}

  void draw_pieces(const std::vector<Positions>& pieces, double width, const Ink& ink) {
    for (const Positions& piece : pieces) {
      Positions pixels;
      for (const Eigen::Vector2d& position : piece) pixels.push_back(area_.pixel_of(position));
      draw_polyline(image_, pixels, width, ink);
    }
  }

  void draw_dots(const std::vector<Positions>& pieces, const Ink& ink) {
    for (const Positions& piece : pieces) {
      for (const Eigen::Vector2d& position : piece) draw_disc(image_, area_.pixel_of(position), kDotRadius, ink);
    }
  }

  void draw_name(const Eigen::Vector2d& position, const std::string& name) {
    draw_text(image_, area_.pixel_of(position) + Eigen::Vector2d(0, 22), name,
              {.size = 15, .ink = {kTextColor}, .align = TextAlign::kCenter, .halo = 3});
  }

  void draw_missing(const Positions& positions) {
    for (const Eigen::Vector2d& position : positions) {
      draw_ring(image_, area_.pixel_of(position), kMissingRadius, 2, {kMissingColor});
    }
  }

 private:
  Image& image_;
  const PlotArea& area_;
};

void draw_legend(Image& image, const Eigen::AlignedBox2d& plan, std::size_t num_missing) {
  const double y = plan.min().y() - 17;
  double x = plan.max().x() - 390;
  const TextStyle style{.size = 15, .ink = {kTextColor}};
  draw_line(image, {x, y}, {x + 30, y}, kTruthWidth, {kTruthColor});
  draw_text(image, {x + 42, y}, "truth", style);
  x += 110;
  draw_line(image, {x, y}, {x + 30, y}, kEstimateWidth, {kEstimateColor});
  draw_disc(image, {x + 15, y}, kDotRadius, {kEstimateColor});
  draw_text(image, {x + 42, y}, "estimate", style);
  x += 145;
  draw_ring(image, {x + 10, y}, kMissingRadius, 2, {kMissingColor});
  draw_text(image, {x + 27, y}, std::to_string(num_missing) + " missing", style);
}

void draw_plan(Image& image, const Eigen::AlignedBox2d& frame, const Trajectory& estimate, const Trajectory& truth) {
  const std::vector<Positions> true_pieces = pieces_of(truth);
  const std::vector<Positions> estimated_pieces = pieces_of(estimate);
  const Positions missing = missing_positions(estimate, truth);
  const PlotArea area = with_equal_scale({frame, shown_extent(true_pieces, estimated_pieces)});
  Image inside(image);
  draw_axes(inside, area, {"Plan view", "x [m]", "y [m]"});
  draw_legend(inside, frame, missing.size());
  image = inside;

  PlanPen pen(inside, area);
  pen.draw_pieces(true_pieces, kTruthWidth, {kTruthColor});
  pen.draw_pieces(estimated_pieces, kEstimateWidth, {kEstimateColor});
  pen.draw_dots(estimated_pieces, {kEstimateColor});
  pen.draw_missing(missing);
  pen.draw_name(true_pieces.front().front(), "start");
  copy_box(image, inside, frame);
}

std::vector<double> values_of(const TrajectoryError& error, double PoseError::*member) {
  std::vector<double> values;
  for (const auto& pose : error.poses) {
    if (pose) values.push_back((*pose).*member);
  }
  return values;
}

std::optional<ErrorSummary> aligned_error(const Trajectory& estimate, const Trajectory& truth) {
  const std::optional<Eigen::Isometry3d> truth_from_estimate = align_trajectory(estimate, truth);
  if (!truth_from_estimate) return std::nullopt;
  return evaluate_trajectory(moved(estimate, *truth_from_estimate), truth).translation;
}

}  // namespace

void TrajectoryPlotOptions::check() const {
  check_size("width", width, 1000);
  check_size("height", height, 800);
}

Image plot_trajectory(const Trajectory& estimate, const Trajectory& truth, const TrajectoryPlotOptions& options) {
  options.check();
  const TrajectoryError error = evaluate_trajectory(estimate, truth);
  if (error.num_judged == 0) throw std::invalid_argument("no true pose to plot");

  Image image(options.width, options.height);
  const Layout layout = layout_of(options, extent_of(pieces_of(truth)).sizes());
  draw_text(image, {options.width / 2.0, 36}, options.title,
            {.size = 24, .ink = {kTextColor}, .align = TextAlign::kCenter, .is_bold = true});
  draw_plan(image, layout.plan, estimate, truth);
  draw_error_histogram(image, layout.xy, "XY error", values_of(error, &PoseError::xy));
  draw_error_histogram(image, layout.z, "Z error (estimate above truth: positive)", values_of(error, &PoseError::z));
  draw_error_figures(image, layout.figures, error, aligned_error(estimate, truth));
  return image;
}

}  // namespace vdbmap::registration
