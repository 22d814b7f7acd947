#pragma once
// A depth image pressed flat: where, in each direction over the floor, something stands in the
// rover's way, and how far nothing does.

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "slam/camera_model.h"
#include "slam/se3.h"
#include "slam/slam_config.h"

namespace rovigo::slam {

struct ScanHit {
  int direction = 0;  ///< index into the scan's directions
  float range_m = 0;  ///< over the floor, from the camera
  float sigma_m = 0;
  int pixels = 0;  ///< that agree on it
};

/// Directions and ranges are over the floor, seen from the camera, in the *level* frame: base_link
/// turned upright, z = 0 on the floor.
struct DepthScan {
  Eigen::Vector2f origin = Eigen::Vector2f::Zero();  ///< of the camera
  float first_direction_rad = 0, direction_step_rad = 0;
  std::vector<float> clear_m;  ///< per direction: no obstacle height was met up to here
  std::vector<ScanHit> hits;
};

class DepthScanner {
 public:
  DepthScanner(const CameraModel& camera, const GridConfig& grid, const DepthConfig& depth);

  /// `level_from_camera`: from the optical frame; only height and direction matter.
  DepthScan scan(const cv::Mat& depth, double unit_m, const Se3& level_from_camera);

 private:
  struct Ray {
    int direction = -1;
    float across = 0;  ///< metres over the floor per metre of depth
    float up = 0;      ///< metres of height per metre of depth
  };
  void aim(const Se3& level_from_camera);
  void cluster(int direction, std::vector<float>& ranges, DepthScan& scan) const;

  CameraModel camera_;
  GridConfig grid_;
  DepthConfig depth_;
  Se3 aimed_at_;
  bool aimed_ = false;
  float first_direction_rad_ = 0, direction_step_rad_ = 0;
  int directions_ = 0;
  std::vector<Ray> rays_;
};

}  // namespace rovigo::slam
