// rovigo record: the simulated rover drives a route; what its sensors say becomes a recording.

#include <mrpt/obs/CObservation3DRangeScan.h>

#include <nlohmann/json.hpp>

#include "app/commands/options.h"
#include "app/config.h"
#include "app/console.h"
#include "app/resources.h"
#include "app/route_drive.h"
#include "app/route_maker.h"
#include "app/truth_recorder.h"
#include "slam/recording/recording.h"

namespace rovigo::app {

namespace {

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

std::string early_end(const RouteDriveResult& drive) {
  std::string message =
      drive.completed ? "the route was driven" : "the drive ended early: " + drive.message;
  return message + ", " + std::to_string(drive.log.contact_events) +
         " collisions; the recording holds what was seen";
}

}  // namespace

int run_record(const RecordOptions& options) {
  const Console console(options.json);
  const RovigoConfig config = load_config(options.config, options.set);
  require_writable(options.output);
  const sim::World world = open_world(options.world);
  const sim::Route route = route_in_world(options.route, world, config);
  const planning::Planner planner = route_planner(world, config, route.speed_m_s);
  const TPose2D start = route_start(route, world, planner);

  sim::SimulatorOptions simulation;
  simulation.robot = config.robot;
  simulation.scenario = open_scenario(options.scenario);
  simulation.world_from_base = start;
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
  const RouteDriveResult drive = drive_route(simulator, route, start, planner, config, hooks);
  for (auto& writer : writers) writer->finish();
  if (truth) truth->write(*options.truth);

  const bool ok = drive.completed && drive.log.contact_events == 0;
  const double duration = simulator.time_s() - 1.0;
  const std::string message =
      ok ? "recorded " + std::to_string(frames) + " frames to " + options.output.string()
         : early_end(drive);
  console.result(
      {{"status", ok ? "ok" : "drive_failed"},
       {"code", ok ? 0 : 106},
       {"message", message},
       {"frames", frames},
       {"duration_s", duration},
       {"route_length_m", drive.planned_length_m},
       {"collisions", drive.log.contact_events},
       {"kidnaps", drive.kidnaps},
       {"log_hash", log_hash(drive.log)}},
      message,
      {{"route", with_unit(drive.planned_length_m, 1, "m") + " in " + with_unit(duration, 1, "s")},
       {"size", with_unit(static_cast<double>(std::filesystem::file_size(options.output)) / 1e6, 0,
                          "MB")}});
  return ok ? kDone : kDidNotSucceed;
}

}  // namespace rovigo::app
