#pragma once
// One RGB-D view, taken out of MRPT's observation into plain images.

#include <mrpt/obs/CObservation3DRangeScan.h>

#include <opencv2/core.hpp>

#include "slam/camera_model.h"
#include "slam/slam_config.h"

namespace rovigo::slam {

struct CameraFrame {
  double time_s = 0.0;
  cv::Mat color;  ///< 8UC3 (BGR) or 8UC1, as it came
  cv::Mat gray;   ///< 8UC1
  cv::Mat depth;  ///< 16UC1 along the optical axis, 0: no return; may be empty
  double depth_unit_m = 0.001;

  /// Depth in metres at a raw pixel; 0 where there is none, outside the configured range, or on
  /// the edge of an object, where a depth camera mixes near and far.
  double depth_at(const Eigen::Vector2d& raw_pixel, const DepthConfig& config) const;

  /// Whether a nearer surface ends within `radius_px` of a raw pixel. What looks like a corner
  /// there may be its outline across something behind it, which slides as the camera moves.
  bool is_beside_nearer(const Eigen::Vector2d& raw_pixel, double radius_px,
                        const DepthConfig& config) const;
};

/// Seconds of an observation's clock.
double time_of(const mrpt::obs::CObservation& observation);

/// The images share memory with nothing. An observation without an intensity image gives an empty
/// `gray`. Throws InputError when the image's size is not the camera's.
CameraFrame camera_frame_from(const mrpt::obs::CObservation3DRangeScan& scan,
                              const CameraModel& camera);

}  // namespace rovigo::slam
