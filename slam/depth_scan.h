#pragma once
// A depth image as rays over the floor.

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "slam/camera_model.h"
#include "slam/se3.h"
#include "slam/slam_config.h"

namespace rovigo::slam {

/// One return. Ranges are over the floor, from the camera; heights grow linearly along them.
struct ScanRay {
  float along_x = 0, along_y = 0;  ///< unit vector over the floor
  float slope = 0;                 ///< metres of height per metre over the floor
  float range_m = 0;
  float sigma_m = 0;    ///< of the range
  bool moving = false;  ///< ends on what moves: it tells what is free before that, and no more
};

/// In the *level* frame: base_link turned upright, z = 0 on the floor.
struct DepthScan {
  Eigen::Vector3f camera = Eigen::Vector3f::Zero();
  int fine_from = 0;  ///< rays from here on lie between the others: needed only far away
  float columns_per_rad = 0.0f, rows_per_rad = 0.0f;  ///< of all rays
  std::vector<ScanRay> rays;
  /// Rays without a return, on their way to ground that is too grazing for one: nothing stood in
  /// their way as far as their range.
  std::vector<ScanRay> silent;
};

/// Samples depth images every few pixels, rows twice as densely as columns: tops are thin. One ray
/// in eight comes first, so that near the camera, where rays crowd, these alone may be followed.
class DepthScanner {
 public:
  DepthScanner(const CameraModel& camera, const DepthConfig& depth);

  /// `depth` is 16-bit, `unit_m` metres a step, 0 for no return; of the camera's size or a whole
  /// fraction of it. Only height and direction of `level_from_camera` (optical frame) matter.
  DepthScan scan(const cv::Mat& depth, double unit_m, const Se3& level_from_camera) {
    return scan(sample(depth), unit_m, level_from_camera);
  }

  /// The same in two steps: what a scan reads of an image is a small part of it.
  struct Samples {
    int cols = 0, rows = 0;  ///< of the image
    std::vector<std::uint16_t> depths;
  };
  Samples sample(const cv::Mat& depth);
  DepthScan scan(const Samples& samples, double unit_m, const Se3& level_from_camera);

 private:
  struct Sample {
    int u = 0, v = 0;
    Eigen::Vector3f ray = Eigen::Vector3f::Zero();  ///< camera frame, z = 1
  };
  void lay_samples(int cols, int rows);
  void add_silent(const Samples& samples, float unit_m, const Eigen::Matrix3f& rotation,
                  DepthScan& scan) const;

  CameraModel camera_;
  DepthConfig depth_;
  int cols_ = 0, rows_ = 0;
  std::size_t fine_from_ = 0;
  float columns_per_rad_ = 0.0f, rows_per_rad_ = 0.0f;
  std::vector<Sample> samples_;
};

}  // namespace rovigo::slam
