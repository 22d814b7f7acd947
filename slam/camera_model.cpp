#include "slam/camera_model.h"

#include <cmath>
#include <string>

#include "maps/error.h"

namespace rovigo::slam {

CameraModel::CameraModel(const mrpt::img::TCamera& camera)
    : width_(static_cast<int>(camera.ncols)),
      height_(static_cast<int>(camera.nrows)),
      fx_(camera.fx()),
      fy_(camera.fy()),
      cx_(camera.cx()),
      cy_(camera.cy()),
      k_(camera.dist) {
  if (!(fx_ > 0) || !(fy_ > 0) || !std::isfinite(fx_ + fy_ + cx_ + cy_) || width_ < 32 ||
      height_ < 32) {
    throw maps::InputError("The camera's calibration is unusable: fx " + std::to_string(fx_) +
                           ", fy " + std::to_string(fy_) + ", image " + std::to_string(width_) +
                           "x" + std::to_string(height_) +
                           "; give the right one with --camera-info.");
  }
  using mrpt::img::DistortionModel;
  if (camera.distortion == DistortionModel::kannala_brandt) {
    throw maps::InputError(
        "Fish-eye cameras (kannala_brandt) are not supported; rectify the images first.");
  }
  distorted_ = camera.distortion == DistortionModel::plumb_bob;
  for (const double k : k_) {
    if (!std::isfinite(k)) throw maps::InputError("The camera's distortion is not finite.");
  }
}

Eigen::Vector2d CameraModel::distort_normalized(const Eigen::Vector2d& p) const {
  const double r2 = p.squaredNorm();
  const double radial = (1 + r2 * (k_[0] + r2 * (k_[1] + r2 * k_[4]))) /
                        (1 + r2 * (k_[5] + r2 * (k_[6] + r2 * k_[7])));
  const double xy = 2 * p.x() * p.y();
  return {p.x() * radial + k_[2] * xy + k_[3] * (r2 + 2 * p.x() * p.x()),
          p.y() * radial + k_[3] * xy + k_[2] * (r2 + 2 * p.y() * p.y())};
}

Eigen::Vector2d CameraModel::undistort(const Eigen::Vector2d& raw_pixel) const {
  if (!distorted_) return raw_pixel;
  const Eigen::Vector2d raw((raw_pixel.x() - cx_) / fx_, (raw_pixel.y() - cy_) / fy_);
  Eigen::Vector2d p = raw;
  for (int i = 0; i < 10; ++i) p += raw - distort_normalized(p);
  return {fx_ * p.x() + cx_, fy_ * p.y() + cy_};
}

Eigen::Vector2d CameraModel::distort(const Eigen::Vector2d& pixel) const {
  if (!distorted_) return pixel;
  const Eigen::Vector2d p = distort_normalized({(pixel.x() - cx_) / fx_, (pixel.y() - cy_) / fy_});
  return {fx_ * p.x() + cx_, fy_ * p.y() + cy_};
}

}  // namespace rovigo::slam
