#include "recordings.h"

#include <mrpt/obs/CObservation3DRangeScan.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "app/route_drive.h"
#include "mapped_world.h"
#include "maps/error.h"
#include "maps/inflation.h"
#include "planning/free_space.h"
#include "sim/simulator.h"
#include "slam/recording/recording.h"
#include "slam/slam.h"
#include "slam/trajectory_file.h"

namespace rovigo::slam_localize {

namespace {

constexpr double kKidnapDistanceM = 4.0;
constexpr double kKidnapTurnDeg = 120.0;

slam::RecordingInfo recording_info(const sim::Simulator& simulator, const std::string& world,
                                   std::uint64_t seed) {
  slam::RecordingInfo info;
  info.rig.camera = simulator.rig().camera;
  info.rig.base_from_camera = simulator.rig().base_from_camera;
  info.rig.has_extrinsics = info.rig.has_wheels = info.rig.has_imu = true;
  info.simulation =
      maps::SimulationOrigin{world, seed, TPose2D(simulator.truth().world_from_base.asTPose())};
  return info;
}

/// Writes observations and truth as they come; both appear only when whole.
class Recorder {
 public:
  Recorder(const sim::Simulator& simulator, const std::string& world, std::uint64_t seed,
           std::filesystem::path file)
      : simulator_(simulator), file_(std::move(file)) {
    slam::RecordingInfo info = recording_info(simulator, world, seed);
    info.name = file_.stem().string();
    writer_ = slam::create_rawlog(file_, info);
  }
  void take(const mrpt::obs::CObservation& observation) {
    writer_->write(observation);
    const double time_s = mrpt::Clock::toDouble(observation.timestamp);
    if (!truth_.empty() && time_s <= truth_.back().time_s) return;
    truth_.push_back({time_s, simulator_.truth().world_from_base});
  }
  void finish() {
    slam::write_tum_trajectory(truth_of(file_), "world_from_base_link", truth_);
    writer_->finish();
  }

 private:
  const sim::Simulator& simulator_;
  std::filesystem::path file_;
  std::unique_ptr<slam::RecordingWriter> writer_;
  std::vector<slam::StampedPose> truth_;
};

sim::SimulatorOptions simulator_options(const TPose2D& world_from_base,
                                        const sim::Scenario& scenario, std::uint64_t seed,
                                        const app::RovigoConfig& config) {
  sim::SimulatorOptions options;
  options.robot = config.robot;
  options.scenario = scenario;
  options.world_from_base = world_from_base;
  options.seed = seed;
  options.camera_rate_hz = kCameraRateHz;
  return options;
}

/// Where rovers may stand, and what they see from there of the driven way.
struct Standing {
  maps::Costmap costmap;
  planning::FreeSpace line_of_sight;
  Standing(const MappedWorld& world, const app::RovigoConfig& config)
      : costmap(maps::inflate_safe(world.true_grid, with_radius(config))),
        line_of_sight(world.true_grid, costmap, 0.0) {}
  static maps::InflationConfig with_radius(const app::RovigoConfig& config) {
    maps::InflationConfig out = config.inflation;
    out.robot_radius_m = config.robot.robot_radius_m + 0.05;
    return out;
  }
  bool fits(const TPoint2D& p) const { return costmap.is_passable(costmap.geometry.cell_at(p)); }
  bool is_mapped(const TPoint2D& p, const std::vector<TPose2D>& driven, double reach_m) const {
    return std::any_of(driven.begin(), driven.end(), [&](const TPose2D& d) {
      const TPoint2D q = maps::position_of(d);
      return maps::distance(p, q) < reach_m && line_of_sight.is_free(p, q);
    });
  }
};

}  // namespace

std::filesystem::path truth_of(const std::filesystem::path& recording) {
  return std::filesystem::path(recording).replace_extension(".truth.txt");
}

bool is_made(const std::filesystem::path& recording) {
  return std::filesystem::exists(recording) && std::filesystem::exists(truth_of(recording));
}

namespace {

/// Drives a route on true poses; a collision spoils what is measured.
template <class Take>
void drive(sim::Simulator& simulator, const sim::Route& route, const TPose2D& start,
           const planning::Planner& planner, const app::RovigoConfig& config, const Take& take) {
  const app::RouteDriveResult result =
      app::drive_route(simulator, route, start, planner, config,
                       {.progress = {}, .observation = [&](const auto& o) { take(o); }});
  if (!result.completed || result.log.contact_events > 0) {
    throw maps::InputError("route " + route.name + " was not driven: " + result.message + ", " +
                           std::to_string(result.log.contact_events) + " contacts");
  }
}

}  // namespace

void record_drive(const sim::World& world, const std::string& world_name, const sim::Route& route,
                  const sim::Scenario& scenario, std::uint64_t seed,
                  const app::RovigoConfig& config, const std::filesystem::path& recording) {
  const planning::Planner planner = app::route_planner(world, config, route.speed_m_s);
  const TPose2D start = app::route_start(route, world, planner);
  sim::Simulator simulator(world, simulator_options(start, scenario, seed, config));
  Recorder recorder(simulator, world_name, seed, recording);
  drive(simulator, route, start, planner, config, [&](const auto& o) { recorder.take(o); });
  recorder.finish();
}

maps::SavedMap map_recording(const std::filesystem::path& recording,
                             const app::RovigoConfig& config) {
  const auto reader = slam::open_recording(recording);
  slam::Slam slam(config.slam, reader->info().rig);
  while (const auto observation = reader->next()) slam.process(*observation);
  maps::SavedMap map = slam.finish();
  map.metadata.simulation = reader->info().simulation;
  return map;
}

void record_turn(const sim::World& world, const std::string& world_name,
                 const TPose2D& world_from_base, double turn_rate_rad_s, double duration_s,
                 const sim::Scenario& scenario, std::uint64_t seed, const app::RovigoConfig& config,
                 const std::filesystem::path& recording) {
  sim::Simulator simulator(world, simulator_options(world_from_base, scenario, seed, config));
  Recorder recorder(simulator, world_name, seed, recording);
  const double end_s = simulator.time_s() + duration_s;
  // Wheels scrub on the spot, so that the command alone would turn it too slowly.
  double command = turn_rate_rad_s;
  while (simulator.time_s() < end_s) {
    simulator.step({0.0, 0.0, command});
    const double lacking = turn_rate_rad_s - simulator.truth().twist.omega;
    command = std::clamp(command + 0.005 * lacking, -1.5, 1.5);
    for (const auto& o : simulator.take_observations()) recorder.take(*o);
  }
  recorder.finish();
}

TPose2D random_start(const MappedWorld& world, const app::RovigoConfig& config, double reach_m,
                     std::uint64_t seed) {
  const Standing standing(world, config);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int attempt = 0; attempt < 10000; ++attempt) {
    const TPose2D& near = world.driven[random() % world.driven.size()];
    const TPose2D pose{near.x + reach_m * unit(random), near.y + reach_m * unit(random),
                       maps::kPi * unit(random)};
    const TPoint2D p = maps::position_of(pose);
    if (standing.fits(p) && standing.is_mapped(p, {near}, reach_m)) return pose;
  }
  throw maps::InputError("world " + world.name + " has no free mapped place");
}

std::optional<sim::Kidnap> random_kidnap(const MappedWorld& world, const app::RovigoConfig& config,
                                         const TPose2D& from, double time_s, std::uint64_t seed) {
  constexpr double kMappedWithinM = 0.7;
  const Standing standing(world, config);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int attempt = 0; attempt < 400; ++attempt) {
    const double bearing = maps::kPi * unit(random);
    const double turn = unit(random) < 0 ? -kKidnapTurnDeg : kKidnapTurnDeg;
    const TPoint2D step{kKidnapDistanceM * std::cos(bearing), kKidnapDistanceM * std::sin(bearing)};
    const TPoint2D to = maps::transform(from, step);
    if (!standing.fits(to) || !standing.is_mapped(to, world.driven, kMappedWithinM)) continue;
    return sim::Kidnap{.time_s = time_s, .forward_m = step.x, .left_m = step.y, .turn_deg = turn};
  }
  return std::nullopt;
}

}  // namespace rovigo::slam_localize
