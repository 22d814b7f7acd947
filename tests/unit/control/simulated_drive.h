#pragma once
// The tracker on the real simulator, on true poses or poses made worse, for tests.

#include <algorithm>
#include <deque>
#include <random>

#include "control/drive_log.h"
#include "sim/simulator.h"
#include "tests/unit/control/plant.h"

namespace rovigo::control::testing {

/// The truth as a poor estimator might deliver it.
struct PoseFaults {
  double rate_hz = 30.0;
  double latency_s = 0.0;
  double jitter_s = 0.0;
  double position_noise_m = 0.0;
  double heading_noise_rad = 0.0;
  double drift_m = 0.0;        ///< random walk, per pose; heading drifts by as many radians
  double loop_closures = 0.0;  ///< chance, per pose, that the drift is taken back at once
  double dropouts = 0.0;       ///< chance, per pose, that it never arrives
  double doubts = 0.0;         ///< chance, per pose, that it is called doubtful
  double losses = 0.0;         ///< chance, per pose, that tracking is lost for up to three seconds
};

/// Delivers poses late, in order of arrival.
class PoseStream {
 public:
  PoseStream(const PoseFaults& faults, std::uint64_t seed) : faults_(faults), random_(seed) {}

  PoseInput newest(double now, const TPose2D& truth) {
    if (now >= next_s_) {
      next_s_ = std::max(next_s_, now - 1.0 / faults_.rate_hz) + 1.0 / faults_.rate_hz;
      measure(now, truth);
    }
    while (!under_way_.empty() && under_way_.front().due_s <= now + 1e-9) {
      newest_ = under_way_.front().pose;
      under_way_.pop_front();
    }
    return newest_;
  }

 private:
  struct UnderWay {
    double due_s;
    PoseInput pose;
  };
  bool happens(double chance) { return std::uniform_real_distribution<double>()(random_) < chance; }
  double noise(double sigma) { return sigma * normal_(random_); }

  void measure(double now, const TPose2D& truth) {
    drift_.x += noise(faults_.drift_m);
    drift_.y += noise(faults_.drift_m);
    drift_.phi += noise(faults_.drift_m);
    if (happens(faults_.loop_closures)) drift_ = {};
    if (happens(faults_.losses)) {
      lost_until_s_ = now + std::uniform_real_distribution<double>(0.1, 3.0)(random_);
    }
    PoseInput p;
    p.time_s = now;
    p.quality = happens(faults_.doubts) ? PoseQuality::kDoubtful : PoseQuality::kGood;
    if (now < lost_until_s_) p.quality = PoseQuality::kLost;
    p.sigma_position_m = std::hypot(faults_.position_noise_m, 10 * faults_.drift_m);
    p.map_from_base = {truth.x + drift_.x + noise(faults_.position_noise_m),
                       truth.y + drift_.y + noise(faults_.position_noise_m),
                       truth.phi + drift_.phi + noise(faults_.heading_noise_rad)};
    const double late = faults_.jitter_s * std::uniform_real_distribution<double>()(random_);
    if (!happens(faults_.dropouts)) under_way_.push_back({now + faults_.latency_s + late, p});
  }

  PoseFaults faults_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  double next_s_ = 0.0;
  double lost_until_s_ = -1.0;
  TPose2D drift_;
  std::deque<UnderWay> under_way_;
  PoseInput newest_;
};

struct SimulatedDrive {
  maps::RobotModel robot;
  sim::Scenario scenario = sim::ideal_scenario();
  PoseFaults poses;
  std::uint64_t seed = 1;
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

/// Drives until the tracker is done, and half a second longer.
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
  PoseStream poses(setup.poses, setup.seed);
  DriveLog log;
  const double begin = simulator.time_s();
  double done_at = -1.0;
  while (simulator.time_s() - begin < setup.longest_s) {
    const double now = simulator.time_s();
    const TPose2D truth(simulator.truth().world_from_base.asTPose());
    const PoseInput pose = poses.newest(now, truth);
    const TrackerOutput out = tracker.step(now, pose);
    DriveStep s;
    s.time_s = now - begin;
    s.true_pose = truth;
    s.estimated_pose = pose.map_from_base;
    s.quality = pose.quality;
    s.sigma_position_m = pose.sigma_position_m;
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

struct Mission {
  SimulatedDrive setup;
  planning::Trajectory plan;
};

/// A random smooth drive with turns in place, at one of four speeds, with every fault at once.
inline Mission random_mission(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto between = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Mission mission;
  SimulatedDrive& setup = mission.setup;
  constexpr double kSpeeds[] = {0.1, 0.25, 0.4, 0.8};
  setup.seed = seed;
  setup.robot.max_speed_m_s = kSpeeds[seed % 4];
  setup.scenario = sim::Scenario();
  setup.scenario.wheels.slip_events_per_minute = 3.0;
  setup.scenario.commands.latency_s = between(0.0, 0.05);
  setup.poses = {.rate_hz = between(12, 30),
                 .latency_s = between(0.02, 0.1),
                 .jitter_s = 0.02,
                 .position_noise_m = between(0.0, 0.01),
                 .heading_noise_rad = between(0.0, 0.01),
                 .drift_m = 0.0005,
                 .loop_closures = 0.003,
                 .dropouts = 0.02,
                 .doubts = 0.03,
                 .losses = 0.002};
  TPose2D start(between(-1, 1), between(-1, 1), between(-3, 3));
  TrajectoryBuilder builder(setup.robot, start);
  const int pieces = 1 + static_cast<int>(between(0.0, 2.999));
  for (int i = 0; i < pieces; ++i) {
    const double bend = between(0.2, 1.0), wave = between(1.5, 4.0), phase = between(-3, 3);
    builder.drive(between(0.3, 2.5), [=](double s) { return bend * std::sin(wave * s + phase); });
    if (between(0, 1) < 0.7) builder.turn(between(-maps::kPi, maps::kPi));
  }
  mission.plan = builder.get();
  return mission;
}

}  // namespace rovigo::control::testing
