// rovigo dock: the simulated rover comes to a stop before an ArUco marker that its camera sees.

#include <nlohmann/json.hpp>

#include "app/commands/options.h"
#include "app/console.h"
#include "app/dock_drive.h"
#include "app/drive_outcome.h"
#include "app/report/drive_report.h"
#include "app/resources.h"
#include "app/route_drive.h"
#include "app/text.h"
#include "maps/error.h"
#include "sim/marker_place.h"

namespace rovigo::app {

namespace {

constexpr double kDockedM = 0.02, kDockedRad = 0.035;  // 2 cm, 2 deg

/// The marker asked for, or the only one.
sim::MarkerPlace marker_in(const sim::World& world, const DockOptions& options) {
  const std::vector<sim::MarkerPlace> places = sim::markers_in(world);
  std::vector<std::string> ids;
  std::vector<sim::MarkerPlace> fit;
  for (const auto& place : places) {
    ids.push_back(std::to_string(place.id));
    if (!options.marker || *options.marker == place.id) fit.push_back(place);
  }
  if (fit.size() == 1) return fit.front();
  const std::string holds = "world \"" + options.world + "\" shows " +
                            (ids.empty() ? "no marker" : "marker " + join(ids, ", "));
  if (!options.marker) {
    throw maps::InputError(holds + (ids.empty() ? "; give its box the texture Rovigo/Marker7 "
                                                  "(sim/worlds/README.md), or use --world dock"
                                                : "; say which with --marker ID"));
  }
  throw maps::InputError("--marker " + std::to_string(*options.marker) + ": " + holds +
                         (fit.empty() ? "" : ", this one more than once"));
}

Outcome dock_outcome(const DockDrive& dock, const control::DriveMetrics& m, int id) {
  const std::string marker = "marker " + std::to_string(id);
  const bool untouched = dock.log.contact_events == 0;
  if (untouched && dock.log.status == control::TrackStatus::kReached) {
    return {"ok", 0,
            "docked at " + marker + ", " + with_unit(m.final_position_error_m, 3, "m") + " and " +
                with_unit(m.final_heading_error_rad, 3, "rad") + " off, after " +
                with_unit(m.duration_s, 1, "s")};
  }
  if (untouched && dock.sightings == 0) {
    return {"marker_not_seen", 104,
            marker +
                " was never seen; put the rover down facing it, within about 3 m (--start), "
                "and check docking.marker_side_m"};
  }
  if (untouched && dock.log.status == control::TrackStatus::kNoProgress) {
    return {"dock_missed", 105,
            "came in too far beside the dock's axis " + std::to_string(dock.attempts) +
                " times; begin nearer to the axis, or farther away"};
  }
  return outcome_of(dock.log, m);
}

/// From the dock's frame into the world's, where the picture is drawn.
control::DriveLog in_world(control::DriveLog log, const TPose2D& world_from_dock) {
  for (auto& step : log.steps) {
    for (TPose2D* pose : {&step.true_pose, &step.estimated_pose, &step.reference.pose}) {
      *pose = maps::compose(world_from_dock, *pose);
    }
  }
  return log;
}

/// The dock's axis from where the rover begins: no plan in time, only what it is measured against.
planning::Trajectory axis(double length_m) {
  planning::Trajectory out;
  out.points.resize(2);
  out.points.front().pose.x = -length_m;
  return out;
}

sim::SimulatorOptions simulation_of(const DockOptions& options, const RovigoConfig& config,
                                    const sim::World& world) {
  sim::SimulatorOptions simulation;
  simulation.robot = config.robot;
  simulation.scenario = open_scenario(options.scenario);
  simulation.world_from_base =
      options.start ? parse_pose("--start", *options.start).pose : world.start();
  simulation.seed = options.seed;
  simulation.camera_rate_hz = 1.0 / config.docking.sample_time_s;
  return simulation;
}

nlohmann::ordered_json dock_json(const Outcome& outcome, const DockDrive& dock,
                                 const control::DriveMetrics& metrics, int marker) {
  return {{"status", outcome.status},
          {"code", outcome.code},
          {"message", outcome.message},
          {"marker", marker},
          {"sightings", dock.sightings},
          {"attempts", dock.attempts},
          {"driven_length_m", metrics.driven_length_m},
          {"duration_s", metrics.duration_s},
          {"overshoot_m", metrics.overshoot_m},
          {"final_position_error_m", metrics.final_position_error_m},
          {"final_heading_error_rad", metrics.final_heading_error_rad},
          {"estimate_rms_m", metrics.estimate_rms_m},
          {"collisions", dock.log.contact_events},
          {"log_hash", log_hash(dock.log)}};
}

std::vector<Row> dock_rows(const DockDrive& dock, const control::DriveMetrics& metrics) {
  return {{"at the dock", with_unit(metrics.final_position_error_m, 4, "m") + ", " +
                              with_unit(metrics.final_heading_error_rad, 4, "rad")},
          {"overshoot", with_unit(metrics.overshoot_m, 4, "m")},
          {"driven", with_unit(metrics.driven_length_m, 2, "m") + ", " +
                         with_unit(metrics.duration_s, 1, "s") +
                         ", attempts: " + std::to_string(dock.attempts)},
          {"sightings", std::to_string(dock.sightings)},
          {"collisions", std::to_string(dock.log.contact_events)},
          {"log hash", log_hash(dock.log)}};
}

/// What the report says apart from where the world and its rover are.
DriveReportInput dock_report(const DockOptions& options, const Outcome& outcome,
                             const DockDrive& dock, const control::DriveMetrics& metrics,
                             int marker) {
  DriveReportInput report;
  report.title = "Docking at marker " + std::to_string(marker);
  report.summary = outcome.message;
  report.succeeded = outcome.code == 0;
  report.metrics = metrics;
  report.checks = {{"Distance from the dock", metrics.final_position_error_m, kDockedM, "m"},
                   {"Heading error", metrics.final_heading_error_rad, kDockedRad, "rad"},
                   {"Collisions", static_cast<double>(dock.log.contact_events), 0.0, ""}};
  report.facts = {{"World", options.world},
                  {"Marker", std::to_string(marker)},
                  {"Attempts", std::to_string(dock.attempts)},
                  {"Sightings", std::to_string(dock.sightings)},
                  {"Scenario", options.scenario},
                  {"Seed", std::to_string(options.seed)}};
  report.drive_json = dock_json(outcome, dock, metrics, marker).dump(2);
  return report;
}

}  // namespace

int run_dock(const DockOptions& options) {
  const Console console(options.json);
  const RovigoConfig config = load_config(options.config, options.set);
  const sim::World world = open_world(options.world);
  const sim::MarkerPlace marker = marker_in(world, options);
  const TPose2D world_from_dock =
      maps::compose(marker.world_from_face, {config.docking.standoff_m, 0.0, maps::kPi});

  const sim::SimulatorOptions simulation = simulation_of(options, config, world);
  sim::Simulator simulator(world, simulation);

  const TPose2D dock_from_start =
      maps::compose(maps::inverse(world_from_dock), simulation.world_from_base);
  console.say("docking at marker " + std::to_string(marker.id) + ", " +
              with_unit(std::hypot(dock_from_start.x, dock_from_start.y), 2, "m") + " away, " +
              with_unit(std::abs(dock_from_start.y), 2, "m") + " beside its axis");
  const DockDrive dock = dock_on_marker(simulator, world_from_dock, marker.id, config);

  planning::Trajectory plan = axis(std::max(-dock_from_start.x, 0.01));
  const control::CommandLimits limits{config.robot.max_speed_m_s, config.robot.max_yaw_rate_rad_s};
  const control::DriveMetrics metrics = control::measure(dock.log, plan, TPose2D(), true, limits);
  const Outcome outcome = dock_outcome(dock, metrics, marker.id);
  if (options.report) {
    DriveReportInput report = dock_report(options, outcome, dock, metrics, marker.id);
    report.grid = obstacle_grid(world, config);
    report.layers.start = simulation.world_from_base;
    report.layers.goal = world_from_dock;
    report.layers.goal_heading_given = true;
    for (auto& point : plan.points) point.pose = maps::compose(world_from_dock, point.pose);
    report.planned = plan;
    report.log = in_world(dock.log, world_from_dock);
    report.limits = limits;
    write_drive_report(*options.report, report);
    console.say("report: " + (*options.report / "index.html").string());
  }
  console.result(dock_json(outcome, dock, metrics, marker.id), outcome.message,
                 dock_rows(dock, metrics));
  return outcome.code == 0 ? kDone : kDidNotSucceed;
}

}  // namespace rovigo::app
