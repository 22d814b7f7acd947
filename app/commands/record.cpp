// rovigo record: the simulated rover drives a route; what its sensors say becomes a recording.

#include <mrpt/obs/CObservation3DRangeScan.h>

#include <nlohmann/json.hpp>

#include "app/commands/options.h"
#include "app/config.h"
#include "app/console.h"
#include "app/resources.h"
#include "app/simulated_drive.h"
#include "app/truth_recorder.h"
#include "maps/error.h"
#include "planning/planner.h"
#include "slam/recording/recording.h"

namespace rovigo::app {

namespace {

/// The route as one smooth trajectory, clear of the world's true obstacles (true poses are allowed
/// in `record`, and only there).
planning::PlanResult plan_route(const sim::World& world, const sim::Route& route,
                                const RovigoConfig& config) {
  RovigoConfig limited = config;
  limited.robot.max_speed_m_s = std::min(config.robot.max_speed_m_s, route.speed_m_s);
  const planning::Planner planner(sim::true_grid(world, config.slam.grid.grid_resolution_m, 0.02,
                                                 config.robot.body_height_m + 0.1),
                                  limited.robot, limited.inflation, limited.planning);
  planning::PlanRequest request;
  const auto& points = route.waypoints;
  request.start = {points[0].x, points[0].y,
                   std::atan2(points[1].y - points[0].y, points[1].x - points[0].x)};
  request.start_heading_given = true;
  request.via.assign(points.begin() + 1, points.end() - 1);
  request.goal = {points.back().x, points.back().y, 0.0};
  planning::PlanResult plan = planner.plan(request);
  if (plan.status != planning::PlanStatus::kOk) {
    throw maps::InputError("route \"" + route.name + "\" cannot be driven in world \"" +
                           world.name() + "\": " + plan.message);
  }
  return plan;
}

slam::RecordingInfo recording_info(const RecordOptions& options, const sim::Simulator& simulator) {
  slam::RecordingInfo info;
  info.name = options.output.stem().string();
  info.rig.camera = simulator.rig().camera;
  info.rig.base_from_camera = simulator.rig().base_from_camera;
  info.rig.has_extrinsics = info.rig.has_wheels = info.rig.has_imu = true;
  info.simulation = maps::SimulationOrigin{options.world, options.seed,
                                           TPose2D(simulator.truth().world_from_base.asTPose())};
  return info;
}

}  // namespace

int run_record(const RecordOptions& options) {
  const Console console(options.json);
  const RovigoConfig config = load_config(options.config, options.set);
  require_writable(options.output);
  const sim::World world = open_world(options.world);
  const sim::Route route = open_route(options.route);
  const planning::PlanResult plan = plan_route(world, route, config);

  sim::SimulatorOptions simulation;
  simulation.robot = config.robot;
  simulation.scenario = open_scenario(options.scenario);
  simulation.world_from_base = plan.trajectory.points.front().pose;
  simulation.seed = options.seed;
  simulation.camera_rate_hz = options.fps;
  sim::Simulator simulator(world, simulation);

  const slam::RecordingInfo info = recording_info(options, simulator);
  std::vector<std::unique_ptr<slam::RecordingWriter>> writers;
  writers.push_back(slam::create_rawlog(options.output, info));
  if (options.tum) writers.push_back(slam::create_tum_directory(*options.tum, info));
  std::optional<TruthRecorder> truth;
  if (options.truth) truth.emplace(world, simulator, config.slam.grid);

  int frames = 0;
  Progress progress("recording");
  DriveHooks hooks;
  hooks.progress = [&](double share) { progress.update(share); };
  hooks.observation = [&](const mrpt::obs::CObservation& observation) {
    for (auto& writer : writers) writer->write(observation);
    if (!IS_CLASS(observation, mrpt::obs::CObservation3DRangeScan)) return;
    ++frames;
    if (truth) truth->frame(mrpt::Clock::toDouble(observation.timestamp));
  };
  const TPose2D world_frame;
  const auto poses = true_poses(simulator, world_frame);
  control::TrajectoryTracker tracker(config.control, config.robot, plan.trajectory);
  const control::DriveLog log = drive_in_simulator(simulator, world_frame, *poses, tracker,
                                                   plan.trajectory.duration_s(), hooks);
  for (auto& writer : writers) writer->finish();
  if (truth) truth->write(*options.truth);

  const bool ok = log.status == control::TrackStatus::kReached && log.contact_events == 0;
  const double duration = simulator.time_s() - 1.0;
  const std::string message =
      ok ? "recorded " + std::to_string(frames) + " frames to " + options.output.string()
         : std::string("the drive ended early: ") + to_string(log.status) + ", " +
               std::to_string(log.contact_events) +
               " collisions; the recording holds what was seen";
  console.result(
      {{"status", ok ? "ok" : "drive_failed"},
       {"code", ok ? 0 : 106},
       {"message", message},
       {"frames", frames},
       {"duration_s", duration},
       {"route_length_m", plan.path_length_m},
       {"collisions", log.contact_events},
       {"log_hash", log_hash(log)}},
      message,
      {{"route", with_unit(plan.path_length_m, 1, "m") + " in " + with_unit(duration, 1, "s")},
       {"size", with_unit(static_cast<double>(std::filesystem::file_size(options.output)) / 1e6, 0,
                          "MB")}});
  return ok ? kDone : kDidNotSucceed;
}

}  // namespace rovigo::app
