#include "slam/recording/depth_registration.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

namespace rovigo::slam {
namespace {

/// Brown-Conrady projection in double, as OpenCV's: k1 k2 p1 p2 k3 k4 k5 k6.
class Projection {
 public:
  explicit Projection(const mrpt::img::TCamera& camera) : camera_(camera) {}

  Eigen::Vector2d operator()(const Eigen::Vector3d& p) const {
    const double x = p.x() / p.z();
    const double y = p.y() / p.z();
    const auto& k = camera_.dist;
    const double r2 = x * x + y * y;
    const double up = 1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
    const double down = 1.0 + r2 * (k[5] + r2 * (k[6] + r2 * k[7]));
    const double radial = up / down;
    const double xd = x * radial + 2.0 * k[2] * x * y + k[3] * (r2 + 2.0 * x * x);
    const double yd = y * radial + k[2] * (r2 + 2.0 * y * y) + 2.0 * k[3] * x * y;
    return {camera_.fx() * xd + camera_.cx(), camera_.fy() * yd + camera_.cy()};
  }

 private:
  const mrpt::img::TCamera& camera_;
};

/// Where the corners between the pixels look: rays at depth one, free of distortion.
std::vector<cv::Point2f> corner_rays(const mrpt::img::TCamera& camera) {
  std::vector<cv::Point2f> corners;
  corners.reserve((std::size_t{camera.ncols} + 1) * (std::size_t{camera.nrows} + 1));
  for (std::uint32_t row = 0; row <= camera.nrows; ++row) {
    for (std::uint32_t column = 0; column <= camera.ncols; ++column) {
      corners.emplace_back(static_cast<float>(column) - 0.5F, static_cast<float>(row) - 0.5F);
    }
  }
  const cv::Matx33d matrix(camera.fx(), 0, camera.cx(), 0, camera.fy(), camera.cy(), 0, 0, 1);
  const cv::Mat distortion(1, 8, CV_64F, const_cast<double*>(camera.dist.data()));
  std::vector<cv::Point2f> rays;
  cv::undistortPoints(corners, rays, matrix, distortion);
  return rays;
}

/// First and last pixel whose centre lies in [a, b), cut to the image; empty when first > last.
struct PixelRange {
  int first = 0;
  int last = -1;
};

PixelRange covered_pixels(double a, double b, int size) {
  constexpr double kWidest_px = 64.0;  // a square this wide comes from a wrong calibration
  PixelRange range;
  const double low = std::min(a, b);
  const double high = std::max(a, b);
  if (!(high - low < kWidest_px) || high < 0.0 || low > size) return range;
  range.first = std::max(static_cast<int>(std::ceil(low)), 0);
  range.last = std::min(static_cast<int>(std::ceil(high)) - 1, size - 1);
  return range;
}

}  // namespace

bool operator==(const RegistrationGeometry& a, const RegistrationGeometry& b) {
  return a.depth == b.depth && a.color == b.color && a.color_from_depth == b.color_from_depth;
}

DepthRegistration::DepthRegistration(const RegistrationGeometry& geometry)
    : geometry_(geometry), corner_rays_(corner_rays(geometry.depth)) {}

mrpt::math::CMatrix_u16 DepthRegistration::apply(const mrpt::math::CMatrix_u16& depth,
                                                 double units_m, bool is_range) const {
  const auto rows = static_cast<int>(geometry_.color.nrows);
  const auto columns = static_cast<int>(geometry_.color.ncols);
  constexpr double kNearest_m = 0.01;
  constexpr double kLargest = std::numeric_limits<std::uint16_t>::max();
  mrpt::math::CMatrix_u16 registered(rows, columns);
  registered.fill(0);
  const Projection project(geometry_.color);
  const Eigen::Matrix3d rotation = geometry_.color_from_depth.getRotationMatrix().asEigen();
  const Eigen::Vector3d translation(geometry_.color_from_depth.x(), geometry_.color_from_depth.y(),
                                    geometry_.color_from_depth.z());
  const std::size_t stride = geometry_.depth.ncols + 1;
  for (int v = 0; v < static_cast<int>(depth.rows()); ++v) {
    for (int u = 0; u < static_cast<int>(depth.cols()); ++u) {
      const std::uint16_t value = depth(v, u);
      if (value == 0) continue;
      const std::size_t at = static_cast<std::size_t>(v) * stride + static_cast<std::size_t>(u);
      const cv::Point2f& top_left = corner_rays_[at];
      const cv::Point2f& bottom_right = corner_rays_[at + stride + 1];
      double z_m = value * units_m;
      if (is_range) {
        const double x = 0.5 * (top_left.x + bottom_right.x);
        const double y = 0.5 * (top_left.y + bottom_right.y);
        z_m /= std::sqrt(1.0 + x * x + y * y);
      }
      const Eigen::Vector3d p =
          rotation * Eigen::Vector3d(top_left.x * z_m, top_left.y * z_m, z_m) + translation;
      const Eigen::Vector3d q =
          rotation * Eigen::Vector3d(bottom_right.x * z_m, bottom_right.y * z_m, z_m) + translation;
      if (p.z() < kNearest_m || q.z() < kNearest_m) continue;
      const double seen = std::round(0.5 * (p.z() + q.z()) / units_m);
      if (!(seen >= 1.0 && seen <= kLargest)) continue;
      const auto seen_value = static_cast<std::uint16_t>(seen);
      const Eigen::Vector2d a = project(p);
      const Eigen::Vector2d b = project(q);
      const PixelRange across = covered_pixels(a.x(), b.x(), columns);
      const PixelRange down = covered_pixels(a.y(), b.y(), rows);
      for (int row = down.first; row <= down.last; ++row) {
        for (int column = across.first; column <= across.last; ++column) {
          std::uint16_t& pixel = registered(row, column);
          if (pixel == 0 || seen_value < pixel) pixel = seen_value;
        }
      }
    }
  }
  return registered;
}

}  // namespace rovigo::slam
