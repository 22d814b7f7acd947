#pragma once
// What to do when the prediction leads nowhere: recognise the place, and mend what was believed.

#include <cstdint>
#include <optional>
#include <vector>

#include "slam/local_map.h"
#include "slam/localizer.h"
#include "slam/motion_model.h"
#include "slam/relocalizer.h"
#include "slam/surroundings.h"
#include "slam/tracking_health.h"
#include "slam/trajectory_history.h"

namespace rovigo::slam {

class Recovery {
 public:
  /// All but `config` and `rig` must outlive this.
  Recovery(const SlamConfig& config, const Rig& rig, const LandmarkMap& map,
           const Surroundings& surroundings, const Relocalizer& relocalizer, MotionModel& motion,
           TrackingHealth& health)
      : config_(config),
        rig_(rig),
        map_(map),
        surroundings_(surroundings),
        relocalizer_(relocalizer),
        motion_(motion),
        health_(health) {}

  /// A frame was tracked from its prediction.
  void not_needed() { misses_ = 0; }

  /// Wheels and IMU tie together what is seen while the rover looks for its place.
  void add(const mrpt::obs::CObservation& reading);

  /// The rover was carried off: nothing may be tracked from the prediction, which is known to be
  /// wrong, however well a look-alike there may fit.
  bool must_search() const { return motion_.planar() && health_.state() == TrackingState::kLost; }

  /// What a search under way believes; nothing unless `must_search()`.
  std::optional<PoseEstimate> guess() const { return must_search() ? guess_ : std::nullopt; }

  /// Without a usable prediction. A rover on its floor that is LOST finds itself in the map so far
  /// as in a saved one, with all the care that takes. Otherwise the last known surroundings are
  /// asked by appearance, then the whole map. A place far from the pose believed moves the rover
  /// there, on probation; `local` becomes its landmarks.
  void recover(const CameraFrame& frame, const FeatureSet& features, std::uint64_t seed,
               LocalMap& local, TrackResult& result);

  /// The first look at a place recognised is rough; those that confirm it sharpen the jumps.
  void sharpen(const Se3& seen_from_predicted);

  /// Jumps that the frames since have confirmed mend the poses before them.
  void mend(TrajectoryHistory& history);

 private:
  void search(const CameraFrame& frame, const FeatureSet& features, LocalMap& local,
              TrackResult& result);
  void recognise(double time_s, const FeatureSet& features, std::uint64_t seed,
                 const LocalMap& local, TrackResult& result);
  Relocalization recognise_anywhere(const LocalMap& local, const FeatureSet& features,
                                    std::uint64_t seed) const;
  void move_to(double time_s, const Se3& seen, const Se3& believed, int keyframe);

  /// A jump to a place recognised, until the next frames have confirmed it.
  struct Jump {
    double since_s = 0.0, until_s = 0.0;  ///< of the poses that were believed in vain
    Se3 new_map_from_old_map;             ///< with all jumps since
  };

  SlamConfig config_;
  Rig rig_;
  const LandmarkMap& map_;
  const Surroundings& surroundings_;
  const Relocalizer& relocalizer_;
  MotionModel& motion_;
  TrackingHealth& health_;
  int misses_ = 0;  ///< frames in a row that matched nothing
  std::optional<PoseEstimate> guess_;
  std::optional<Localizer> search_;  ///< in the map as it was when the rover was lost
  std::vector<Jump> jumps_;  ///< one after the other: a place found may have to be given up again
  int place_ = -1;           ///< the keyframe of the last one
};

}  // namespace rovigo::slam
