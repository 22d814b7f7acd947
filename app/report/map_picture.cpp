#include "app/report/map_picture.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "app/report/number_text.h"
#include "maps/atomic_file.h"
#include "maps/error.h"

namespace rovigo::app {
namespace {

using maps::Cell;
using maps::Costmap;
using maps::GridGeometry;
using maps::OccupancyGrid;

// Colours after Okabe and Ito, told apart by the colour-blind; OpenCV's order is blue, green, red.
const cv::Scalar kFreeColor(252, 252, 252), kUnknownColor(222, 217, 213),
    kOccupiedColor(48, 42, 38);
const cv::Scalar kLethalColor(205, 225, 250), kInk(40, 35, 31), kSoftInk(110, 99, 89);
const cv::Scalar kPlannedColor(178, 114, 0), kDrivenColor(0, 94, 213), kEstimatedColor(115, 158, 0);
const cv::Scalar kStartColor(115, 158, 0), kGoalColor(167, 60, 190), kWhite(255, 255, 255);
const cv::Scalar kKeyframeColor(160, 150, 140);

constexpr int kShortestLongerSide = 800, kLongestLongerSide = 1600;
constexpr int kScaleBarWidth = 150;  ///< room for it beside the legend
constexpr int kBorder = 24, kTitleHeight = 40, kLegendRow = 30;
constexpr int kSubPixelBits = 4;
constexpr double kMarginM = 0.4;
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kFontScale = 0.5;

/// The cells shown; may reach beyond the grid.
struct Crop {
  int left = 0, bottom = 0, right = -1, top = -1;  // inclusive
  int width() const { return right - left + 1; }
  int height() const { return top - bottom + 1; }
  void include(Cell c) {
    if (right < left) {
      left = right = c.x;
      bottom = top = c.y;
    }
    left = std::min(left, c.x);
    right = std::max(right, c.x);
    bottom = std::min(bottom, c.y);
    top = std::max(top, c.y);
  }
};

void require_drawable(const OccupancyGrid& grid) {
  constexpr int kMostCells = 40000;
  const GridGeometry& g = grid.geometry;
  if (g.width <= 0 || g.height <= 0 || grid.cells.size() != g.size() || !(g.resolution_m > 0.0)) {
    throw maps::InputError("The map holds no cells, so there is nothing to draw.");
  }
  if (g.width > kMostCells || g.height > kMostCells) {
    throw maps::InputError("A map of " + std::to_string(g.width) + " x " +
                           std::to_string(g.height) + " cells is too large to draw; the limit is " +
                           std::to_string(kMostCells) + " a side.");
  }
}

/// Every point of the layers, for the crop.
std::vector<TPoint2D> all_points(const MapPictureLayers& layers) {
  std::vector<TPoint2D> all;
  for (const auto* path :
       {&layers.planned_path, &layers.driven_path, &layers.estimated_path, &layers.via_points}) {
    all.insert(all.end(), path->begin(), path->end());
  }
  for (const auto& pose : layers.keyframes) all.push_back(maps::position_of(pose));
  if (layers.start) all.push_back(maps::position_of(*layers.start));
  if (layers.goal) all.push_back(maps::position_of(*layers.goal));
  return all;
}

Crop crop_to_what_matters(const OccupancyGrid& grid, const MapPictureLayers& layers) {
  constexpr double kFarthestOutsideM = 3.0;  // a wild estimate must not shrink the map to a dot
  const GridGeometry& g = grid.geometry;
  Crop crop;
  for (int y = 0; y < g.height; ++y) {
    for (int x = 0; x < g.width; ++x) {
      if (!OccupancyGrid::is_unknown(grid.at({x, y}))) crop.include({x, y});
    }
  }
  const int outside = static_cast<int>(kFarthestOutsideM / g.resolution_m) + 1;
  for (const TPoint2D& p : all_points(layers)) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) continue;
    const Cell c = g.cell_at(p);
    if (c.x >= -outside && c.y >= -outside && c.x < g.width + outside && c.y < g.height + outside) {
      crop.include(c);
    }
  }
  if (crop.right < crop.left) {  // nothing known at all
    crop.include({0, 0});
    crop.include({g.width - 1, g.height - 1});
  }
  const int margin = std::max(2, static_cast<int>(std::lround(kMarginM / g.resolution_m)));
  return {crop.left - margin, crop.bottom - margin, crop.right + margin, crop.top + margin};
}

/// A canvas with the map in it, and the way from metres to pixels.
class Canvas {
 public:
  Canvas(const OccupancyGrid& grid, const MapPictureLayers& layers, int title_px, int legend_px)
      : geometry_(grid.geometry), crop_(crop_to_what_matters(grid, layers)) {
    const int longer = std::max(crop_.width(), crop_.height());
    shrink_ = (longer + kLongestLongerSide - 1) / kLongestLongerSide;
    grow_ = shrink_ > 1 ? 1 : (kShortestLongerSide + longer - 1) / longer;
    const cv::Mat map = raster(grid, layers);
    map_ = cv::Rect(kBorder, kBorder + title_px, map.cols, map.rows);
    image = cv::Mat(map_.y + map_.height + kBorder + legend_px, map_.width + 2 * kBorder, CV_8UC3,
                    kWhite);
    map.copyTo(image(map_));
    cv::rectangle(image, map_ + cv::Size(1, 1) - cv::Point(1, 1), kSoftInk, 1);
  }

  double px_per_m() const { return static_cast<double>(grow_) / shrink_ / geometry_.resolution_m; }
  cv::Rect map_area() const { return map_; }

  cv::Point2d pixel(const TPoint2D& p) const {
    const double x = (p.x - geometry_.origin.x) / geometry_.resolution_m - crop_.left;
    const double y = (p.y - geometry_.origin.y) / geometry_.resolution_m - crop_.bottom;
    const double scale = static_cast<double>(grow_) / shrink_;
    return {map_.x + x * scale, map_.y + map_.height - y * scale};
  }

  cv::Mat image;

 private:
  cv::Mat raster(const OccupancyGrid& grid, const MapPictureLayers& layers) const;

  GridGeometry geometry_;
  Crop crop_;
  int grow_ = 1, shrink_ = 1;
  cv::Rect map_;
};

/// Large maps are shrunk so that no obstacle disappears: the darkest cell of a block wins.
cv::Mat Canvas::raster(const OccupancyGrid& grid, const MapPictureLayers& layers) const {
  enum Rank : std::uint8_t { kFreeRank, kUnknownRank, kLethalRank, kOccupiedRank };
  const bool band = layers.costmap && layers.costmap->geometry == grid.geometry &&
                    layers.costmap->cells.size() == grid.cells.size();
  const int columns = (crop_.width() + shrink_ - 1) / shrink_;
  const int rows = (crop_.height() + shrink_ - 1) / shrink_;
  std::vector<std::uint8_t> ranks(static_cast<std::size_t>(columns) * rows, kFreeRank);
  for (int y = crop_.bottom; y <= crop_.top; ++y) {
    for (int x = crop_.left; x <= crop_.right; ++x) {
      const Cell c{x, y};
      const std::int8_t value = grid.geometry.contains(c) ? grid.at(c) : OccupancyGrid::kUnknown;
      std::uint8_t rank = kFreeRank;
      if (OccupancyGrid::is_unknown(value)) rank = kUnknownRank;
      if (OccupancyGrid::is_free(value) && band && layers.costmap->at(c) == Costmap::kLethal) {
        rank = kLethalRank;
      }
      if (OccupancyGrid::is_occupied(value)) rank = kOccupiedRank;
      auto& block = ranks[static_cast<std::size_t>((y - crop_.bottom) / shrink_) * columns +
                          static_cast<std::size_t>((x - crop_.left) / shrink_)];
      block = std::max(block, rank);
    }
  }
  const cv::Scalar colors[] = {kFreeColor, kUnknownColor, kLethalColor, kOccupiedColor};
  cv::Mat small(rows, columns, CV_8UC3);
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      const cv::Scalar& c = colors[ranks[static_cast<std::size_t>(y) * columns + x]];
      small.at<cv::Vec3b>(rows - 1 - y, x) =
          cv::Vec3b(static_cast<uchar>(c[0]), static_cast<uchar>(c[1]), static_cast<uchar>(c[2]));
    }
  }
  if (grow_ == 1) return small;
  cv::Mat large;
  cv::resize(small, large, {}, grow_, grow_, cv::INTER_NEAREST);
  return large;
}

/// Fixed-point coordinates for OpenCV's anti-aliased drawing; points far outside are pulled in.
cv::Point sub_pixel(const cv::Point2d& p) {
  constexpr double kFar = 20000.0;
  constexpr double kUnit = 1 << kSubPixelBits;
  return {static_cast<int>(std::lround(std::clamp(p.x, -kFar, kFar) * kUnit)),
          static_cast<int>(std::lround(std::clamp(p.y, -kFar, kFar) * kUnit))};
}

void draw_line(cv::Mat& image, const std::vector<cv::Point2d>& points, const cv::Scalar& color,
               int thickness) {
  std::vector<cv::Point> fixed_points;
  fixed_points.reserve(points.size());
  for (const auto& p : points) fixed_points.push_back(sub_pixel(p));
  cv::polylines(image, fixed_points, false, color, thickness, cv::LINE_AA, kSubPixelBits);
}

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

void draw_disc(cv::Mat& image, const cv::Point2d& at, double radius, const cv::Scalar& color) {
  const double unit = 1 << kSubPixelBits;
  cv::circle(image, sub_pixel(at), static_cast<int>((radius + 2) * unit), kWhite, cv::FILLED,
             cv::LINE_AA, kSubPixelBits);
  cv::circle(image, sub_pixel(at), static_cast<int>(radius * unit), color, cv::FILLED, cv::LINE_AA,
             kSubPixelBits);
}

void draw_arrow(cv::Mat& image, const cv::Point2d& from, double yaw, double length,
                const cv::Scalar& color) {
  const cv::Point2d along(std::cos(yaw), -std::sin(yaw)), across(-along.y, along.x);
  const cv::Point2d tip = from + length * along, neck = from + (length - 9) * along;
  draw_line(image, {from, neck}, kWhite, 7);
  draw_line(image, {from, neck}, color, 3);
  const std::vector<cv::Point> head = {sub_pixel(tip), sub_pixel(neck + 6.0 * across),
                                       sub_pixel(neck - 6.0 * across)};
  cv::fillConvexPoly(image, head, color, cv::LINE_AA, kSubPixelBits);
}

void draw_diamond(cv::Mat& image, const cv::Point2d& at, double radius, const cv::Scalar& color) {
  const auto corners = [&](double r) {
    return std::vector<cv::Point>{sub_pixel({at.x + r, at.y}), sub_pixel({at.x, at.y + r}),
                                  sub_pixel({at.x - r, at.y}), sub_pixel({at.x, at.y - r})};
  };
  cv::fillConvexPoly(image, corners(radius + 2), kWhite, cv::LINE_AA, kSubPixelBits);
  cv::fillConvexPoly(image, corners(radius), color, cv::LINE_AA, kSubPixelBits);
}

/// The goal: a ring with a dot, unlike the start also without colour.
void draw_target(cv::Mat& image, const cv::Point2d& at, const cv::Scalar& color) {
  draw_disc(image, at, 10, color);
  draw_disc(image, at, 5, kWhite);
  draw_disc(image, at, 3, color);
}

void draw_text(cv::Mat& image, const std::string& text, const cv::Point& at, double scale,
               const cv::Scalar& color, int thickness = 1) {
  cv::putText(image, text, at, kFont, scale, color, thickness, cv::LINE_AA);
}

int text_width(const std::string& text, double scale, int thickness = 1) {
  int baseline = 0;
  return cv::getTextSize(text, kFont, scale, thickness, &baseline).width;
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
  draw_path(canvas, layers.planned_path, kPlannedColor, 6);
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
  add(!layers.planned_path.empty(), {"planned path", Mark::kLine, kPlannedColor, 6});
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
  require_drawable(grid);
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
