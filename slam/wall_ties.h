#pragma once
// Where corners are few, walls hold the rover against its last keyframes, and those together.

#include <optional>
#include <vector>

#include "slam/landmark_map.h"
#include "slam/motion_link.h"
#include "slam/motion_model.h"
#include "slam/wall_match.h"

namespace rovigo::slam {

/// What walls alone say of two keyframes: the match of one's walls against the other's was held by
/// a prior where they are silent.
MotionLink wall_link(const WallMatch& match, const Keyframe& from, const Keyframe& to);

class WallTies {
 public:
  /// For a camera whose place on the rover is known.
  explicit WallTies(const SlamConfig& config) : config_(config) {}

  /// What was seen of walls belongs to the frame before.
  void next_frame() { scan_.clear(); }

  /// What the walls around keyframe `anchor` say of the pose now; nothing where they are silent or
  /// ask for a step that wheels and gyro do not believe.
  std::optional<PlanarInformation> look(const CameraFrame& frame, const LandmarkMap& map,
                                        int anchor, const Se3& pose, const MotionModel& motion);

  /// True when `look` was asked in this frame and saw walls.
  bool seen() const { return !scan_.empty(); }

  /// The walls in view, for the keyframe that the frame becomes.
  WallScan scan(const CameraFrame& frame, const LandmarkMap& map) const;

  /// Ties a new keyframe to those up to `anchor` by the walls they see in common.
  void tie(const LandmarkMap& map, int keyframe, int anchor, const MotionModel& motion);

  const std::vector<MotionLink>& links() const { return links_; }
  std::vector<MotionLink>& links() { return links_; }

 private:
  SlamConfig config_;
  WallScan scan_;  ///< of the frame at hand
  std::vector<MotionLink> links_;
};

}  // namespace rovigo::slam
