#pragma once
// Localisation in a bare occupancy grid, from a known start: wheels and gyro, with what the depth
// camera sees at obstacle height matched against the grid. For maps that came without keyframes.

#include <mrpt/obs/CObservation.h>

#include <memory>

#include "maps/occupancy_grid.h"
#include "slam/localizer.h"
#include "slam/pose_estimate.h"
#include "slam/rig.h"
#include "slam/slam_config.h"

namespace rovigo::slam {

/// Feed it every observation in time order.
class GridLocalizer {
 public:
  GridLocalizer(const SlamConfig& config, const Rig& rig, const maps::OccupancyGrid& grid,
                const PosePrior& prior);
  ~GridLocalizer();

  /// The pose after this observation.
  PoseEstimate process(const mrpt::obs::CObservation& observation);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rovigo::slam
