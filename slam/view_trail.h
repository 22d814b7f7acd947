#pragma once
// Visual odometry where the saved map does not know the view: the views of a moment ago do.

#include <optional>
#include <vector>

#include "slam/landmark_map.h"
#include "slam/local_map.h"
#include "slam/tracker.h"
#include "slam/view_check.h"

namespace rovigo::slam {

/// A small map of the last metres, in the saved map's frame as well as the rover knew its place. It
/// says how the rover has moved since, not where it is: wheels slip and have a scale that nobody
/// may know yet, views do not.
class ViewTrail {
 public:
  /// Of the same camera as `saved`, on the same rover.
  explicit ViewTrail(const LandmarkMap& saved)
      : config_(saved.config()), map_(config_, saved.camera(), saved.base_from_camera()) {}

  /// Where the views so far put this frame; nothing where it does not go on from any.
  std::optional<Se3> locate(const SeenView& view, const MotionPrediction& prediction);
  /// Keeps a frame that shows something new, made at `map_from_base`.
  void keep(const SeenView& view, const Se3& map_from_base);
  /// The rover turned out to be elsewhere: the views were made elsewhere, too.
  void shift(const Se3& new_map_from_old_map);
  void clear();

 private:
  SlamConfig config_;
  LandmarkMap map_;
  LocalMap local_;
  TrackResult seen_;  ///< of the newest frame
};

}  // namespace rovigo::slam
