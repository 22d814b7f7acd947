#pragma once
// The tracker on the real simulator, on true poses or poses made worse, for tests.

#include <deque>
#include <random>

#include "control/drive_log.h"
#include "sim/simulator.h"

namespace rovigo::control::testing {

struct SimulatedDrive {
  maps::RobotModel robot;
  sim::Scenario scenario = sim::ideal_scenario();
  std::uint64_t seed = 1;
  double pose_period_s = 1.0 / 30;
  double pose_latency_s = 0.0;
  double position_noise_m = 0.0;
  double heading_noise_rad = 0.0;
  double longest_s = 600.0;
};

/// An empty hall with walls far away.
inline sim::World empty_hall() {
  maps::OccupancyGrid grid({0.25, {-15, -15}, 120, 120}, maps::OccupancyGrid::kFree);
  for (int i = 0; i < 120; ++i) {
    grid.at({i, 0}) = grid.at({i, 119}) = maps::OccupancyGrid::kOccupied;
    grid.at({0, i}) = grid.at({119, i}) = maps::OccupancyGrid::kOccupied;
  }
  return sim::World::from_grid(grid, 0.5);
}

inline DriveLog drive_in_hall(const planning::Trajectory& plan, const SimulatedDrive& setup,
                              const ControlConfig& config = {}) {
  static const sim::World world = empty_hall();
  sim::SimulatorOptions options;
  options.robot = setup.robot;
  options.scenario = setup.scenario;
  options.world_from_base = plan.points.front().pose;
  options.seed = setup.seed;
  options.camera_enabled = false;
  sim::Simulator simulator(world, options);
  for (int i = 0; i < 120; ++i) simulator.step({});  // settles on its wheels
  simulator.take_observations();

  TrajectoryTracker tracker(config, setup.robot, plan);
  std::mt19937_64 random(setup.seed);
  std::normal_distribution<double> normal;
  std::deque<PoseInput> under_way;
  PoseInput newest;
  DriveLog log;
  const double begin = simulator.time_s();
  double next_pose = begin, done_at = -1.0;
  while (simulator.time_s() - begin < setup.longest_s) {
    const double now = simulator.time_s();
    const TPose2D truth(simulator.truth().world_from_base.asTPose());
    if (now >= next_pose - 1e-9) {
      next_pose += setup.pose_period_s;
      PoseInput p;
      p.time_s = now;
      p.quality = PoseQuality::kGood;
      p.sigma_position_m = setup.position_noise_m;
      p.map_from_base = {truth.x + setup.position_noise_m * normal(random),
                         truth.y + setup.position_noise_m * normal(random),
                         truth.phi + setup.heading_noise_rad * normal(random)};
      under_way.push_back(p);
    }
    while (!under_way.empty() && under_way.front().time_s + setup.pose_latency_s <= now + 1e-9) {
      newest = under_way.front();
      under_way.pop_front();
    }
    const TrackerOutput out = tracker.step(now, newest);
    DriveStep s;
    s.time_s = now - begin;
    s.true_pose = truth;
    s.estimated_pose = newest.map_from_base;
    s.quality = newest.quality;
    s.sigma_position_m = newest.sigma_position_m;
    s.command = out.command;
    s.true_twist = simulator.truth().twist;
    s.reference = out.reference;
    s.heading_error_rad = out.heading_error_rad;
    s.cross_track_error_m = out.cross_track_error_m;
    log.steps.push_back(s);
    log.status = out.status;
    if (out.status != TrackStatus::kRunning && done_at < 0) done_at = now;
    if (done_at >= 0 && now > done_at + 0.5) break;
    simulator.step(out.command);
    simulator.step(out.command);
    simulator.take_observations();
  }
  log.contact_events = simulator.truth().contact_events;
  return log;
}

}  // namespace rovigo::control::testing
