#include "app/report/map_canvas.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "maps/error.h"

namespace rovigo::app::drawing {
namespace {

using maps::Cell;
using maps::Costmap;
using maps::GridGeometry;
using maps::OccupancyGrid;

constexpr int kShortestLongerSide = 800, kLongestLongerSide = 1600;
constexpr int kSubPixelBits = 4;
constexpr double kMarginM = 0.4;
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;

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
  require_drawable(grid);
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

/// Fixed-point coordinates for OpenCV's anti-aliased drawing; points far outside are pulled in.
cv::Point sub_pixel(const cv::Point2d& p) {
  constexpr double kFar = 20000.0;
  constexpr double kUnit = 1 << kSubPixelBits;
  return {static_cast<int>(std::lround(std::clamp(p.x, -kFar, kFar) * kUnit)),
          static_cast<int>(std::lround(std::clamp(p.y, -kFar, kFar) * kUnit))};
}

}  // namespace

Canvas::Canvas(const OccupancyGrid& grid, const MapPictureLayers& layers, int title_px,
               int legend_px)
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

void draw_line(cv::Mat& image, const std::vector<cv::Point2d>& points, const cv::Scalar& color,
               int thickness) {
  std::vector<cv::Point> fixed_points;
  fixed_points.reserve(points.size());
  for (const auto& p : points) fixed_points.push_back(sub_pixel(p));
  cv::polylines(image, fixed_points, false, color, thickness, cv::LINE_AA, kSubPixelBits);
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
               const cv::Scalar& color, int thickness) {
  cv::putText(image, text, at, kFont, scale, color, thickness, cv::LINE_AA);
}

int text_width(const std::string& text, double scale, int thickness) {
  int baseline = 0;
  return cv::getTextSize(text, kFont, scale, thickness, &baseline).width;
}

}  // namespace rovigo::app::drawing
