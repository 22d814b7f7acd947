#pragma once
// Who walks before the camera leaves no obstacle: what the depth images of the moments before and
// after see through is moving.

#include <cstdint>
#include <deque>
#include <opencv2/core.hpp>
#include <vector>

#include "slam/camera_model.h"
#include "slam/depth_scan.h"
#include "slam/landmark_map.h"

namespace rovigo::slam {

/// Where a camera was, held against a keyframe so that loop closures move it along.
struct AnchoredView {
  double time_s = 0.0;
  int keyframe = -1;
  Se3 keyframe_from_level;  ///< level: as in DepthScan
  Se3 level_from_camera;    ///< optical frame
};

/// Keeps the depth images of the last seconds, reduced, and finds in a scan what moves (seen
/// through from another moment: the visibility test of Pomerleau et al. 2014 and Kim & Kim 2020,
/// Removert, between neighbouring images). One part of a body may rest while another moves: what
/// stands within a body's radius of what moves is taken along.
class MotionWatch {
 public:
  /// A scan can be judged best when so much more has been seen; and what is older is forgotten.
  static constexpr double kHorizonS = 1.1;

  MotionWatch(const CameraModel& camera, const DepthConfig& depth);

  /// Takes an image in when the last one kept is a while ago. Times must not decrease.
  void remember(const cv::Mat& depth, double unit_m, const AnchoredView& view);

  /// Marks the rays of `scan` (seen from `view`) that end on something moving.
  void mark_moving(const AnchoredView& view, const LandmarkMap& map, DepthScan& scan) const;

  std::size_t memory_bytes() const;

 private:
  /// The least distance (mm) within each block of pixels and those around it: whatever lies nearer
  /// was not there. 0: too few returns to tell; the largest number: none at all.
  struct Remembered {
    AnchoredView view;
    cv::Mat nearest_mm;
  };
  /// A camera to look from, in floats.
  struct Eye {
    Eigen::Matrix3f rotation;  ///< camera from level
    Eigen::Vector3f translation;
    const cv::Mat* nearest_mm = nullptr;
  };

  std::vector<Eye> eyes_for(const AnchoredView& view, const LandmarkMap& map) const;
  /// What another image says of a point.
  enum class Verdict { kSilent, kThere, kSeenThrough, kNothingThere };
  Verdict look_at(const Eye& eye, const Eigen::Vector3f& point) const;
  bool moves(const std::vector<Eye>& eyes, const Eigen::Vector3f& point) const;

  CameraModel camera_;
  DepthConfig depth_;
  std::deque<Remembered> remembered_;
};

}  // namespace rovigo::slam
