#pragma once
// Localisation only, in a saved map.

#include <mrpt/obs/CObservation.h>

#include <memory>
#include <optional>

#include "maps/map_file.h"
#include "slam/localizer_evidence.h"
#include "slam/pose_estimate.h"
#include "slam/rig.h"
#include "slam/slam_config.h"

namespace rovigo::slam {

struct CameraFrame;
class FeatureSet;
class LandmarkMap;
class MotionModel;

/// Where somebody says the rover is (RViz's pose estimate); wide enough to be true.
struct PosePrior {
  TPose2D map_from_base;
  double sigma_position_m = 0.25;
  double sigma_heading_rad = 0.26;
};

/// Feed it every observation in time order. Without a prior it finds itself by appearance and by
/// the shape of what stands around; it says kLost until a place is more likely than not, kDegraded
/// while that is being confirmed, and kOk only while frames keep matching the map and nothing they
/// show contradicts it. After a jump of the view it is kLost within a second unless what it shows
/// vouches for the place.
class Localizer {
 public:
  Localizer(const SlamConfig& config, const Rig& rig, const maps::SavedMap& map,
            const std::optional<PosePrior>& prior);
  /// In a map that is being made: it must outlive this, and stay as it is meanwhile.
  /// `motion` knows how wheels and gyro are calibrated.
  Localizer(const SlamConfig& config, const Rig& rig, const LandmarkMap& map,
            const maps::OccupancyGrid& grid, const MotionModel& motion);
  ~Localizer();

  /// The pose after this observation: corrected by a camera frame, carried on by wheels and gyro.
  PoseEstimate process(const mrpt::obs::CObservation& observation);
  /// The same for a camera frame whose features are known already.
  PoseEstimate process(const CameraFrame& frame, FeatureSet features);

  /// What the last estimate's confidence was computed from; nothing while no place is believed.
  std::optional<LocalizerEvidence> evidence() const;

 private:
  struct Impl;
  std::unique_ptr<LandmarkMap> restored_;  ///< of a saved map
  std::unique_ptr<Impl> impl_;
};

}  // namespace rovigo::slam
