#include "app/track/track_run.h"

#include <memory>

#include "app/console.h"
#include "app/drive_outcome.h"
#include "app/resources.h"
#include "app/simulated_drive.h"
#include "control/reference_drive.h"
#include "control/tracker.h"

namespace rovigo::app {

namespace {

std::unique_ptr<control::DriveController> make_controller(const TrackCase& what,
                                                          const RovigoConfig& config,
                                                          const planning::Trajectory& planned) {
  if (what.controller != "reference") {
    return std::make_unique<control::TrajectoryTracker>(config.control, config.robot, planned);
  }
  control::ReferenceConfig reference;  // its gains and turn rate as published
  reference.max_speed_m_s = what.speed_m_s;
  const double time_limit_s =
      config.control.timeout_factor * planned.duration_s() + config.control.timeout_extra_s;
  return std::make_unique<control::ReferenceDrive>(reference, planned, time_limit_s);
}

}  // namespace

TrackBench::TrackBench(TrackSuite suite, const RovigoConfig& config,
                       const std::optional<std::string>& pose)
    : suite_(std::move(suite)), config_(config) {
  for (TrackGroup& group : suite_.groups) {
    if (pose) group.pose = *pose;
    scenarios_.try_emplace(group.scenario, open_scenario(group.scenario));
    for (const auto& name : group.trajectories) {
      for (const double speed : group.speeds_m_s) {
        if (planned_.contains({name, speed})) continue;
        planned_.emplace(std::pair(name, speed),
                         plan_track(name, suite_.trajectories.at(name), config_at(speed)));
      }
    }
  }
}

TrackBench TrackBench::with_control(const control::ControlConfig& control) const {
  TrackBench bench = *this;
  bench.config_.control = control;
  return bench;
}

RovigoConfig TrackBench::config_at(double speed_m_s) const {
  RovigoConfig config = config_;
  config.robot.max_speed_m_s = speed_m_s;
  return config;
}

const PlannedTrack& TrackBench::planned(const TrackCase& what) const {
  return planned_.at({what.trajectory, what.speed_m_s});
}

control::DriveLog TrackBench::drive(const TrackCase& what) const {
  const TrackGroup& group = suite_.groups[what.group];
  const PlannedTrack& track = planned(what);
  const RovigoConfig config = config_at(what.speed_m_s);
  sim::SimulatorOptions simulation;
  simulation.robot = config.robot;
  simulation.scenario = scenarios_.at(group.scenario);
  simulation.world_from_base = track.start;
  simulation.seed = what.seed;
  simulation.camera_enabled = false;
  sim::Simulator simulator(track.world, simulation);
  const TPose2D world_from_map;
  const auto poses =
      group.pose == "truth"
          ? true_poses(simulator, world_from_map)
          : perturbed_poses(simulator, world_from_map, scenarios_.at(group.scenario), what.seed);
  const auto controller = make_controller(what, config, track.trajectory);
  return drive_in_simulator(simulator, world_from_map, *poses, *controller,
                            track.trajectory.duration_s(), config, {});
}

TrackRun TrackBench::run(const TrackCase& what) const {
  const planning::Trajectory& planned_trajectory = planned(what).trajectory;
  const maps::RobotModel robot = config_at(what.speed_m_s).robot;
  TrackRun run;
  run.what = what;
  run.log = drive(what);
  run.metrics = control::measure(run.log, planned_trajectory, planned_trajectory.points.back().pose,
                                 true, {robot.max_speed_m_s, robot.max_yaw_rate_rad_s});
  run.failures = failures_of(suite_.groups[what.group].limits, run.log, run.metrics);
  return run;
}

std::vector<std::string> failures_of(const TrackLimits& limits, const control::DriveLog& log,
                                     const control::DriveMetrics& m) {
  std::vector<std::string> failures;
  const Outcome outcome = outcome_of(log, m);
  if (limits.must_reach && outcome.code != 0) failures.push_back(outcome.status);
  const auto at_most = [&](const char* name, double value, double limit) {
    if (value <= limit) return;  // what is no number fails
    failures.push_back(std::string(name) + " " + with_unit(value, 4, "") + " above " +
                       with_unit(limit, 4, ""));
  };
  at_most("cross_track_rms_m", m.cross_track_rms_m, limits.cross_track_rms_m);
  at_most("cross_track_max_m", m.cross_track_max_m, limits.cross_track_max_m);
  at_most("final_position_error_m", m.final_position_error_m, limits.goal_m);
  at_most("final_heading_error_rad", m.final_heading_error_rad, limits.goal_heading_rad);
  at_most("duration_s", m.duration_s, limits.max_duration_s);
  if (!(m.duration_s >= limits.min_duration_s)) {
    failures.push_back("duration_s " + with_unit(m.duration_s, 4, "") + " below " +
                       with_unit(limits.min_duration_s, 4, ""));
  }
  return failures;
}

nlohmann::ordered_json run_json(const TrackRun& run) {
  const control::DriveMetrics& m = run.metrics;
  nlohmann::ordered_json object{{"name", run.what.name},
                                {"seed", run.what.seed},
                                {"passed", run.failures.empty()},
                                {"failures", run.failures}};
  object.update(drive_json(outcome_of(run.log, m), run.log, m));
  object.update(nlohmann::ordered_json{{"along_track_rms_m", m.along_track_rms_m},
                                       {"along_track_max_m", m.along_track_max_m},
                                       {"heading_rms_rad", m.heading_rms_rad},
                                       {"overshoot_m", m.overshoot_m},
                                       {"settling_s", m.settling_s},
                                       {"jerk_rms_m_s3", m.jerk_rms_m_s3},
                                       {"saturation_share", m.saturation_share},
                                       {"planned_duration_s", m.planned_duration_s},
                                       {"time_ratio", m.time_ratio},
                                       {"spl", m.spl}});
  return object;
}

}  // namespace rovigo::app
