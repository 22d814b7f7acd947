#pragma once
// Pinhole camera with plumb-bob distortion: the one place that knows how points become pixels.

#include <mrpt/img/TCamera.h>

#include <Eigen/Core>
#include <array>

namespace rovigo::slam {

/// Pixels are *ideal* (distortion removed) everywhere in slam except where called raw.
class CameraModel {
 public:
  /// Throws InputError for a camera without focal length or with an unknown lens model.
  explicit CameraModel(const mrpt::img::TCamera& camera);

  int width() const { return width_; }
  int height() const { return height_; }
  double fx() const { return fx_; }
  double fy() const { return fy_; }

  /// Ideal pixel of a point in the camera frame with z > 0.
  Eigen::Vector2d project(const Eigen::Vector3d& p) const {
    return {fx_ * p.x() / p.z() + cx_, fy_ * p.y() / p.z() + cy_};
  }
  /// Point in the camera frame at an ideal pixel and a depth along z.
  Eigen::Vector3d unproject(const Eigen::Vector2d& pixel, double depth_m) const {
    return {(pixel.x() - cx_) / fx_ * depth_m, (pixel.y() - cy_) / fy_ * depth_m, depth_m};
  }
  bool in_image(const Eigen::Vector2d& pixel, double margin_px) const {
    return pixel.x() >= margin_px && pixel.y() >= margin_px && pixel.x() < width_ - margin_px &&
           pixel.y() < height_ - margin_px;
  }

  Eigen::Vector2d undistort(const Eigen::Vector2d& raw_pixel) const;
  Eigen::Vector2d distort(const Eigen::Vector2d& pixel) const;

 private:
  Eigen::Vector2d distort_normalized(const Eigen::Vector2d& p) const;

  int width_ = 0, height_ = 0;
  double fx_ = 0, fy_ = 0, cx_ = 0, cy_ = 0;
  bool distorted_ = false;
  std::array<double, 8> k_{};  ///< k1 k2 p1 p2 k3 k4 k5 k6, as OpenCV orders them
};

}  // namespace rovigo::slam
