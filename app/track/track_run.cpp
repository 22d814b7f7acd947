#include "app/track/track_run.h"

#include <memory>

#include "app/console.h"
#include "app/drive_outcome.h"
#include "app/drive_recovery.h"
#include "app/ground.h"
#include "app/resources.h"
#include "app/simulated_drive.h"
#include "app/track/missions.h"
#include "app/track/recorded_path.h"
#include "control/reference_drive.h"
#include "control/tracker.h"
#include "maps/error.h"

namespace rovigo::app {

namespace {

constexpr const char* kRandomWorld = "random";

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

/// From where a drive that lost its way finds itself, to the end.
planning::PlanRequest way_left(const PlannedTrack& track) {
  planning::PlanRequest request;
  request.goal = track.trajectory.points.back().pose;
  request.goal_heading_given = true;
  return request;
}

}  // namespace

TrackBench::TrackBench(TrackSuite suite, const RovigoConfig& config,
                       const std::optional<std::string>& pose)
    : suite_(std::move(suite)), config_(config) {
  for (TrackGroup& group : suite_.groups) {
    if (pose) group.pose = *pose;
    scenarios_.try_emplace(group.scenario, open_scenario(group.scenario));
    for (const auto& name : group.trajectories) {
      const TrackShape& shape = suite_.trajectories.at(name);
      open_ground(group, name);
      if (shape.shape == "mission") continue;
      for (const double speed : group.speeds_m_s) {
        if (planned_.contains({name, speed})) continue;
        planned_[{name, speed}] =
            std::make_shared<const PlannedTrack>(plan_ahead(name, config_at(speed)));
      }
    }
  }
}

PlannedTrack TrackBench::plan_ahead(const std::string& trajectory,
                                    const RovigoConfig& config) const {
  const TrackShape& shape = suite_.trajectories.at(trajectory);
  const auto map = maps_.find(trajectory);
  if (shape.shape == "goal") return plan_goal(trajectory, shape, map->second, config);
  if (shape.shape != "recorded") return plan_shape(shape, config);
  return plan_recorded(trajectory, shape, suite_.folder, map == maps_.end() ? nullptr : map->second,
                       config);
}

void TrackBench::open_ground(const TrackGroup& group, const std::string& trajectory) {
  const TrackShape& shape = suite_.trajectories.at(trajectory);
  const bool on_ground = shape.shape == "goal" || shape.shape == "mission";
  const bool has_ground = on_ground || (shape.shape == "recorded" && !shape.map.empty());
  if (needs_camera(group.pose) && (!has_ground || shape.map.empty())) {
    throw maps::InputError("group \"" + group.name + "\": pose " + group.pose +
                           " needs a map to localise in, and trajectory \"" + trajectory +
                           "\" has none; give it `map: FILE` or take pose perturbed or truth");
  }
  const bool drawn = shape.shape == "mission" && shape.map.empty() && shape.world == kRandomWorld;
  if (!has_ground || drawn || maps_.contains(trajectory)) return;
  maps_[trajectory] = open_track_map(shape, suite_.folder, config_);
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

std::shared_ptr<const PlannedTrack> TrackBench::plan(const TrackCase& what) const {
  const TrackShape& shape = suite_.trajectories.at(what.trajectory);
  if (shape.shape != "mission") return planned_.at({what.trajectory, what.speed_m_s});
  const auto map = maps_.find(what.trajectory);
  return std::make_shared<const PlannedTrack>(
      draw_mission(what.trajectory, shape, map == maps_.end() ? nullptr : map->second,
                   config_at(what.speed_m_s), what.seed));
}

control::DriveLog TrackBench::drive(const TrackCase& what, PlannedTrack& track) const {
  const TrackGroup& group = suite_.groups[what.group];
  const RovigoConfig config = config_at(what.speed_m_s);
  sim::SimulatorOptions simulation;
  simulation.robot = config.robot;
  simulation.scenario = scenarios_.at(group.scenario);
  simulation.world_from_base = maps::compose(track.world_from_map, track.start);
  simulation.seed = what.seed;
  simulation.camera_rate_hz = kDriveCameraHz;
  simulation.camera_enabled = needs_camera(group.pose);
  sim::Simulator simulator(track.world, simulation);
  const maps::SavedMap none;
  const auto poses = open_poses(
      {.kind = group.pose, .map_name = what.trajectory, .start = track.start, .seed = what.seed},
      config, track.map ? *track.map : none, track.world_from_map, simulator, simulation.scenario);
  const auto follower_of = [&](const planning::Trajectory& trajectory) {
    return make_controller(what, config, trajectory);
  };
  const auto controller = follower_of(track.trajectory);
  Replanner replanner(track.map ? *track.map : none, config, way_left(track), track.trajectory,
                      follower_of);
  DriveHooks hooks;
  if (finds_itself(group.pose)) hooks.recovery = replanner.recovery(track.start.phi);
  control::DriveLog log = drive_in_simulator(simulator, track.world_from_map, *poses, *controller,
                                             track.trajectory.duration_s(), config, hooks);
  track.trajectory = replanner.planned();
  return log;
}

TrackRun TrackBench::run(const TrackCase& what) const {
  const maps::RobotModel robot = config_at(what.speed_m_s).robot;
  TrackRun run;
  run.what = what;
  PlannedTrack track = *plan(what);
  run.log = drive(what, track);
  run.track = std::make_shared<const PlannedTrack>(std::move(track));
  const planning::Trajectory& planned = run.track->trajectory;
  run.metrics = control::measure(run.log, planned, planned.points.back().pose, true,
                                 {robot.max_speed_m_s, robot.max_yaw_rate_rad_s});
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
  at_most("goal_reversals", m.goal_reversals, limits.goal_reversals);
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
                                       {"goal_reversals", m.goal_reversals},
                                       {"jerk_rms_m_s3", m.jerk_rms_m_s3},
                                       {"saturation_share", m.saturation_share},
                                       {"planned_duration_s", m.planned_duration_s},
                                       {"time_ratio", m.time_ratio},
                                       {"spl", m.spl}});
  return object;
}

}  // namespace rovigo::app
