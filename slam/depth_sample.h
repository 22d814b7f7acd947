#pragma once
// Depth images on a coarse raster: cheap enough to compare two views point by point.

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "slam/camera_model.h"
#include "slam/localizer_depth_check.h"
#include "slam/se3.h"

namespace rovigo::slam {

/// A depth image sampled on a coarse raster, in metres, 0 for no return.
struct DepthSample {
  static constexpr int kCols = 64, kRows = 48;
  std::vector<float> meters;  ///< row-major, kCols x kRows; empty without a depth image
};
DepthSample sample_depth(const cv::Mat& depth, double unit_m);

/// Every fourth point of a sample, in the camera's optical frame.
std::vector<Eigen::Vector3f> lift(const DepthSample& sample, const CameraModel& camera);

/// Surfaces that one view saw (`points_there`, in its camera's frame) against another view's depth.
/// What lies outside that view, or has no return there, is not judged.
DepthAgreement compare(const std::vector<Eigen::Vector3f>& points_there, const Se3& here_from_there,
                       const DepthSample& here, const CameraModel& camera);

}  // namespace rovigo::slam
