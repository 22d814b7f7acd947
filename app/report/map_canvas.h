#pragma once
// The map as pixels, the way from metres to them, and the few shapes drawn on top.

#include <algorithm>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "app/report/map_picture.h"

namespace rovigo::app::drawing {

// Colours after Okabe and Ito, told apart by the colour-blind; OpenCV's order is blue, green, red.
inline const cv::Scalar kFreeColor(252, 252, 252), kUnknownColor(222, 217, 213),
    kOccupiedColor(48, 42, 38);
inline const cv::Scalar kLethalColor(205, 225, 250), kInk(40, 35, 31), kSoftInk(110, 99, 89);
inline const cv::Scalar kPlannedColor(178, 114, 0), kDrivenColor(0, 94, 213),
    kEstimatedColor(115, 158, 0);
inline const cv::Scalar kStartColor(115, 158, 0), kGoalColor(167, 60, 190), kWhite(255, 255, 255);
inline const cv::Scalar kKeyframeColor(160, 150, 140);

inline constexpr int kBorder = 24;  ///< around the map, px

/// The cells shown; may reach beyond the grid.
struct Crop {
  int left = 0, bottom = 0, right = -1, top = -1;  // inclusive
  int width() const { return right - left + 1; }
  int height() const { return top - bottom + 1; }
  void include(maps::Cell c) {
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

/// A canvas with the map in it, and the way from metres to pixels.
class Canvas {
 public:
  Canvas(const maps::OccupancyGrid& grid, const MapPictureLayers& layers, int title_px,
         int legend_px);

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
  cv::Mat raster(const maps::OccupancyGrid& grid, const MapPictureLayers& layers) const;

  maps::GridGeometry geometry_;
  Crop crop_;
  int grow_ = 1, shrink_ = 1;
  cv::Rect map_;
};

// Anti-aliased shapes; places in pixels of the image, fractions count.
void draw_line(cv::Mat& image, const std::vector<cv::Point2d>& points, const cv::Scalar& color,
               int thickness);
void draw_disc(cv::Mat& image, const cv::Point2d& at, double radius, const cv::Scalar& color);
void draw_arrow(cv::Mat& image, const cv::Point2d& from, double yaw, double length,
                const cv::Scalar& color);
void draw_diamond(cv::Mat& image, const cv::Point2d& at, double radius, const cv::Scalar& color);
/// The goal: a ring with a dot, unlike the start also without colour.
void draw_target(cv::Mat& image, const cv::Point2d& at, const cv::Scalar& color);
void draw_text(cv::Mat& image, const std::string& text, const cv::Point& at, double scale,
               const cv::Scalar& color, int thickness = 1);
int text_width(const std::string& text, double scale, int thickness = 1);

}  // namespace rovigo::app::drawing
