#include "app/report/map_picture.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "app/report/map_canvas.h"
#include "app/report/number_text.h"
#include "maps/atomic_file.h"
#include "maps/error.h"

namespace rovigo::app {
namespace {

using namespace drawing;
using maps::OccupancyGrid;

constexpr int kScaleBarWidth = 150;  ///< room for it beside the legend
constexpr int kTitleHeight = 40, kLegendRow = 30;
constexpr double kFontScale = 0.5;

void draw_path(Canvas& canvas, const std::vector<TPoint2D>& path, const cv::Scalar& color,
               int thickness) {
  cv::Mat map = canvas.image(canvas.map_area());  // lines end at the map's edge
  std::vector<cv::Point2d> piece;
  const cv::Point2d corner = canvas.map_area().tl();
  for (const TPoint2D& p : path) {
    if (std::isfinite(p.x) && std::isfinite(p.y)) {
      piece.push_back(canvas.pixel(p) - corner);
      continue;
    }
    draw_line(map, piece, color, thickness);
    piece.clear();
  }
  draw_line(map, piece, color, thickness);
}

void draw_layers(Canvas& canvas, const MapPictureLayers& layers) {
  cv::Mat& image = canvas.image;
  for (const TPose2D& k : layers.keyframes) {
    if (!maps::is_finite(k)) continue;
    const cv::Point2d at = canvas.pixel(maps::position_of(k));
    draw_line(image, {at, at + 7.0 * cv::Point2d(std::cos(k.phi), -std::sin(k.phi))},
              kKeyframeColor, 1);
    draw_disc(image, at, 2, kKeyframeColor);
  }
  for (const auto& outline : layers.footprints) draw_path(canvas, outline, kPlannedColor, 1);
  draw_path(canvas, layers.planned_path, kPlannedColor, layers.footprints.empty() ? 6 : 2);
  draw_path(canvas, layers.estimated_path, kEstimatedColor, 2);  // seen where it leaves the truth
  draw_path(canvas, layers.driven_path, kDrivenColor, 2);
  for (const TPoint2D& via : layers.via_points) {
    if (std::isfinite(via.x) && std::isfinite(via.y)) {
      draw_diamond(image, canvas.pixel(via), 8, kPlannedColor);
    }
  }
  if (layers.start && maps::is_finite(*layers.start)) {
    const cv::Point2d at = canvas.pixel(maps::position_of(*layers.start));
    draw_arrow(image, at, layers.start->phi, 26, kStartColor);
    draw_disc(image, at, 7, kStartColor);
  }
  if (layers.goal && maps::is_finite(*layers.goal)) {
    const cv::Point2d at = canvas.pixel(maps::position_of(*layers.goal));
    if (layers.goal_heading_given) draw_arrow(image, at, layers.goal->phi, 28, kGoalColor);
    draw_target(image, at, kGoalColor);
  }
}

struct LegendEntry {
  std::string name;
  enum class Mark { kLine, kPatch, kDisc, kTarget, kDiamond, kTick } mark;
  cv::Scalar color;
  int thickness = 2;
};

std::vector<LegendEntry> legend_of(const MapPictureLayers& layers) {
  using Mark = LegendEntry::Mark;
  std::vector<LegendEntry> entries;
  const auto add = [&](bool shown, const LegendEntry& entry) {
    if (shown) entries.push_back(entry);
  };
  add(layers.start.has_value(), {"start", Mark::kDisc, kStartColor});
  add(layers.goal.has_value(), {"goal", Mark::kTarget, kGoalColor});
  add(!layers.via_points.empty(), {"via point", Mark::kDiamond, kPlannedColor});
  add(!layers.planned_path.empty(),
      {"planned path", Mark::kLine, kPlannedColor, layers.footprints.empty() ? 6 : 2});
  add(!layers.driven_path.empty(), {"driven path", Mark::kLine, kDrivenColor, 2});
  add(!layers.estimated_path.empty(), {"estimated path", Mark::kLine, kEstimatedColor, 2});
  add(!layers.keyframes.empty(), {"keyframe", Mark::kTick, kKeyframeColor});
  add(true, {"obstacle", Mark::kPatch, kOccupiedColor});
  add(layers.costmap.has_value(), {"too near for the rover", Mark::kPatch, kLethalColor});
  add(true, {"free", Mark::kPatch, kFreeColor});
  add(true, {"not seen", Mark::kPatch, kUnknownColor});
  return entries;
}

int entry_width(const LegendEntry& entry) { return 32 + text_width(entry.name, kFontScale) + 22; }

int legend_width(int map_width) { return map_width - kScaleBarWidth; }

/// How many rows the entries need in a given width.
int legend_rows(const std::vector<LegendEntry>& entries, int width) {
  int rows = 1, x = 0;
  for (const auto& e : entries) {
    if (x > 0 && x + entry_width(e) > width) {
      ++rows;
      x = 0;
    }
    x += entry_width(e);
  }
  return rows;
}

void draw_mark(cv::Mat& image, const LegendEntry& e, const cv::Point& at) {
  const cv::Point2d middle(at.x + 12, at.y);
  switch (e.mark) {
    case LegendEntry::Mark::kLine:
      draw_line(image, {{at.x * 1.0, at.y * 1.0}, {at.x + 24.0, at.y * 1.0}}, e.color, e.thickness);
      break;
    case LegendEntry::Mark::kPatch:
      cv::rectangle(image, cv::Rect(at.x + 2, at.y - 7, 20, 14), e.color, cv::FILLED);
      cv::rectangle(image, cv::Rect(at.x + 2, at.y - 7, 20, 14), kSoftInk, 1);
      break;
    case LegendEntry::Mark::kDisc:
      draw_disc(image, middle, 7, e.color);
      break;
    case LegendEntry::Mark::kTarget:
      draw_target(image, middle, e.color);
      break;
    case LegendEntry::Mark::kDiamond:
      draw_diamond(image, middle, 8, e.color);
      break;
    case LegendEntry::Mark::kTick:
      draw_line(image, {middle, middle + cv::Point2d(7, 0)}, e.color, 1);
      draw_disc(image, middle, 2, e.color);
      break;
  }
}

void draw_legend(Canvas& canvas, const std::vector<LegendEntry>& entries) {
  const cv::Rect map = canvas.map_area();
  int x = map.x, y = map.y + map.height + kLegendRow - 6;
  for (const auto& e : entries) {
    if (x > map.x && x + entry_width(e) > map.x + legend_width(map.width)) {
      x = map.x;
      y += kLegendRow;
    }
    draw_mark(canvas.image, e, {x, y});
    draw_text(canvas.image, e.name, {x + 32, y + 5}, kFontScale, kInk);
    x += entry_width(e);
  }
}

/// A bar of a round length, about an eighth of the picture wide, at the right of the legend.
void draw_scale_bar(Canvas& canvas) {
  const cv::Rect map = canvas.map_area();
  const double widest_m = (kScaleBarWidth - 10) / canvas.px_per_m();
  double length_m = std::pow(10.0, std::floor(std::log10(widest_m)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * length_m <= widest_m) {
      length_m *= factor;
      break;
    }
  }
  const int length_px = static_cast<int>(std::lround(length_m * canvas.px_per_m()));
  const std::string label = fixed(length_m, length_m >= 1.0 ? 0 : (length_m >= 0.1 ? 1 : 2)) + " m";
  const cv::Point to(map.x + map.width - 2, map.y + map.height + kLegendRow - 2);
  const cv::Point from = to - cv::Point(length_px, 0);
  cv::line(canvas.image, from, to, kInk, 2);
  cv::line(canvas.image, from - cv::Point(0, 5), from + cv::Point(0, 5), kInk, 2);
  cv::line(canvas.image, to - cv::Point(0, 5), to + cv::Point(0, 5), kInk, 2);
  const int middle = (from.x + to.x - text_width(label, kFontScale)) / 2;
  draw_text(canvas.image, label, {middle, from.y - 8}, kFontScale, kInk);
}

/// The title shortened until it fits.
std::string fitting(std::string title, int width) {
  constexpr double kTitleScale = 0.65;
  if (text_width(title, kTitleScale) <= width) return title;
  while (!title.empty() && text_width(title + "...", kTitleScale) > width) title.pop_back();
  return title + "...";
}

}  // namespace

std::string map_picture_png(const OccupancyGrid& grid, const MapPictureLayers& layers) {
  const auto entries = legend_of(layers);
  const int title_px = layers.title.empty() ? 0 : kTitleHeight - kBorder / 2;
  // The legend's height depends on the map's width, which a first canvas tells.
  const Canvas sized(grid, layers, title_px, 0);
  const int legend_px = kLegendRow * legend_rows(entries, legend_width(sized.map_area().width));
  Canvas canvas(grid, layers, title_px, legend_px);
  draw_layers(canvas, layers);
  draw_scale_bar(canvas);
  draw_legend(canvas, entries);
  if (!layers.title.empty()) {
    draw_text(canvas.image, fitting(layers.title, canvas.map_area().width),
              {kBorder, kBorder + title_px - 14}, 0.65, kInk);
  }
  std::vector<uchar> bytes;
  if (!cv::imencode(".png", canvas.image, bytes, {cv::IMWRITE_PNG_COMPRESSION, 9})) {
    throw maps::InputError("The picture of the map could not be encoded as PNG.");
  }
  return {bytes.begin(), bytes.end()};
}

void write_map_picture(const std::filesystem::path& png, const OccupancyGrid& grid,
                       const MapPictureLayers& layers) {
  maps::write_file_atomically(png, std::string_view(map_picture_png(grid, layers)));
}

}  // namespace rovigo::app
