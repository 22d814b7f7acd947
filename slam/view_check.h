#pragma once
// One view against the map at one pose: are its landmarks where they should be, does its depth
// scan lie on the grid's walls, does what is there match?

#include <vector>

#include "slam/camera_frame.h"
#include "slam/grid_match.h"
#include "slam/landmark_map.h"
#include "slam/tracker.h"

namespace rovigo::slam {

/// All that a camera frame has to say.
struct SeenView {
  CameraFrame frame;
  FeatureSet features;
  std::vector<ScanPoint> scan;  ///< in base_link; empty where the camera's height is not known

  /// Enough to expect matches; with less the camera may be covered, or it is dark.
  bool shows_plenty() const { return features.size() >= kPlenty; }
  static constexpr std::size_t kPlenty = 150;
};

struct ViewCheck {
  double depth_share = 1.0;    ///< DepthAgreement::share(), with enough to judge
  double scan_share = 1.0;     ///< of the depth scan, how much lies on the grid's walls
  double matched_share = 0.0;  ///< of the landmarks at their depth, how many matched
  bool contradicts = false;
};

class ViewChecker {
 public:
  /// `walls` null where there is no grid; `repeated`: by landmark, those that show no particular
  /// place. `map` and `walls` must outlive this.
  ViewChecker(const LandmarkMap& map, const SignedDistanceField* walls, std::vector<bool> repeated,
              bool on_floor)
      : map_(map), walls_(walls), repeated_(std::move(repeated)), on_floor_(on_floor) {}

  /// `landmarks`: those around; `inliers`: how many of them the view's features matched.
  ViewCheck check(const SeenView& view, const std::vector<int>& landmarks, const Se3& map_from_base,
                  int inliers) const;

  /// Matches that tell one place from another: upright things that look like no other.
  int telling(const std::vector<FeatureMatch>& matches) const;

  /// Whether somebody looked this way from here when the map was made.
  bool map_knows_view(const Se3& map_from_base) const;

 private:
  const LandmarkMap& map_;
  const SignedDistanceField* walls_;
  std::vector<bool> repeated_;
  bool on_floor_;
};

}  // namespace rovigo::slam
