#pragma once
// What to do when the prediction leads nowhere: recognise the place, and mend what was believed.

#include <cstdint>
#include <optional>

#include "slam/local_map.h"
#include "slam/motion_model.h"
#include "slam/relocalizer.h"
#include "slam/tracking_health.h"
#include "slam/trajectory_history.h"

namespace rovigo::slam {

class Recovery {
 public:
  /// All but `config` must outlive this.
  Recovery(const SlamConfig& config, const LandmarkMap& map, const Relocalizer& relocalizer,
           MotionModel& motion, TrackingHealth& health)
      : config_(config), map_(map), relocalizer_(relocalizer), motion_(motion), health_(health) {}

  /// A frame was tracked from its prediction.
  void not_needed() { misses_ = 0; }

  /// Without a usable prediction: the last known surroundings by appearance, then the whole map.
  /// A place recognised far from the pose believed moves the rover there, on probation.
  void recover(double time_s, const LocalMap& local, const FeatureSet& features, std::uint64_t seed,
               TrackResult& result);

  /// The first look at a place recognised is rough; those that confirm it sharpen the jump.
  void sharpen(const Se3& seen_from_predicted);

  /// A jump that the frames since have confirmed mends the poses before it.
  void mend(TrajectoryHistory& history);

 private:
  Relocalization recognise(const LocalMap& local, const FeatureSet& features,
                           std::uint64_t seed) const;
  void move_to(double time_s, const Se3& seen, const Se3& believed, int keyframe);

  /// A jump to a place recognised, until the next frames have confirmed it.
  struct Jump {
    double since_s = 0.0, until_s = 0.0;  ///< of the poses that were believed in vain
    int keyframe = -1;
    Se3 new_map_from_old_map;
  };

  SlamConfig config_;
  const LandmarkMap& map_;
  const Relocalizer& relocalizer_;
  MotionModel& motion_;
  TrackingHealth& health_;
  int misses_ = 0;  ///< frames in a row that matched nothing
  std::optional<Jump> jump_;
};

}  // namespace rovigo::slam
