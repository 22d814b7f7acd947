#pragma once
// Where the controller's pose comes from: the estimator, or for tests the truth made worse.

#include <mrpt/obs/CObservation.h>

#include <cstdint>
#include <memory>
#include <string>

#include "app/config.h"
#include "control/tracker.h"
#include "maps/map_file.h"
#include "sim/simulator.h"
#include "slam/rig.h"

namespace rovigo::app {

class PoseSource {
 public:
  virtual ~PoseSource() = default;
  /// Sensor data as it arrives, in time order.
  virtual void observe(const mrpt::obs::CObservation& observation) = 0;
  /// The newest pose at `now_s`; it may be old, doubtful or lost.
  virtual control::PoseInput pose(double now_s) = 0;
};

/// slam: `Localizer` in the map's keyframes, told roughly where it starts.
std::unique_ptr<PoseSource> slam_poses(const slam::SlamConfig& config, const slam::Rig& rig,
                                       const maps::SavedMap& map, const TPose2D& start);
/// truth: straight from the simulator (`world_from_map` brings it into the map's frame).
std::unique_ptr<PoseSource> true_poses(const sim::Simulator& simulator,
                                       const TPose2D& world_from_map);

/// odometry: wheels and gyro, matched against the grid by what the depth camera sees.
std::unique_ptr<PoseSource> odometry_poses(const slam::SlamConfig& config, const slam::Rig& rig,
                                           const maps::OccupancyGrid& grid, const TPose2D& start);
/// perturbed: the truth with the scenario's noise, rate, latency and jitter.
std::unique_ptr<PoseSource> perturbed_poses(const sim::Simulator& simulator,
                                            const TPose2D& world_from_map,
                                            const sim::Scenario& scenario, std::uint64_t seed);

}  // namespace rovigo::app
