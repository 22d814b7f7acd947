// Docking: the simulated rover, its camera, and a marker that the camera must find.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "app/dock_drive.h"
#include "sim/marker_texture.h"
#include "sim/world_model.h"
#include "tests/unit/sim/test_worlds.h"

namespace rovigo::app {
namespace {

constexpr int kId = 7;
constexpr double kPrintM = 0.24, kStandoffM = 0.6;

/// A wall with a print of the marker on it; the print's middle at `x`, `y`, facing back along
/// `yaw`.
sim::World world_with_marker(const TPose2D& marker) {
  sim::WorldModel model = sim::bare_floor();
  for (const double thickness : {0.02, 0.2}) {
    const bool is_print = thickness < 0.1;
    sim::Solid board = sim::box_at(0.0, 0.0, 0.0, {thickness, kPrintM, kPrintM});
    if (!is_print) board.size = {thickness, 2.0, 1.0};
    // The board's +x face looks at the rover.
    const double back = is_print ? thickness / 2 : thickness / 2 + 0.02;
    board.world_from_solid = Eigen::Isometry3d::Identity();
    board.world_from_solid.translation() << marker.x + back * std::cos(marker.phi),
        marker.y + back * std::sin(marker.phi), is_print ? 0.28 : 0.5;
    board.world_from_solid.rotate(
        Eigen::AngleAxisd(marker.phi + maps::kPi, Eigen::Vector3d::UnitZ()));
    if (is_print) {
      board.material.pattern = sim::Pattern::kMarker;
      board.material.seed = kId;
      board.material.color = {0.9F, 0.9F, 0.9F};
    }
    model.solids.push_back(board);
  }
  return sim::World(model);
}

RovigoConfig dock_config() {
  RovigoConfig config;
  config.docking.marker_side_m = kPrintM * sim::kMarkerShare;
  config.docking.standoff_m = kStandoffM;
  return config;
}

TEST(Docking, FromRandomStartsTheRoverStopsWithin2CmAnd2DegBeforeTheMarkerItSees) {
  std::mt19937_64 random(20266);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int run = 0; run < 3; ++run) {
    SCOPED_TRACE(run);
    const TPose2D marker(1.0 + unit(random), unit(random), maps::kPi * unit(random));
    const TPose2D world_from_dock(marker.x - kStandoffM * std::cos(marker.phi),
                                  marker.y - kStandoffM * std::sin(marker.phi), marker.phi);
    const TPose2D start(-1.6 + 0.4 * unit(random), 0.35 * unit(random), 0.2 * unit(random));
    sim::SimulatorOptions options;  // noise, slips and all, as by default
    options.world_from_base = maps::compose(world_from_dock, start);
    options.camera_rate_hz = 20.0;
    options.seed = 100 + static_cast<std::uint64_t>(run);
    sim::Simulator simulator(world_with_marker(marker), options);
    const DockDrive dock = dock_on_marker(simulator, world_from_dock, kId, dock_config());
    EXPECT_EQ(dock.log.status, control::TrackStatus::kReached);
    EXPECT_EQ(dock.log.contact_events, 0);
    const TPose2D end = maps::compose(maps::inverse(world_from_dock), sim::true_pose(simulator));
    EXPECT_LE(std::hypot(end.x, end.y), 0.02) << end.x << " " << end.y;
    EXPECT_LE(std::abs(end.phi), 2.0 * maps::kPi / 180.0);
  }
}

TEST(Docking, StandsWhereTheMarkerIsNotTheOneAskedFor) {
  sim::SimulatorOptions options;
  options.camera_rate_hz = 20.0;
  options.world_from_base = {-1.0, 0.0, 0.0};
  sim::Simulator simulator(world_with_marker({1.0, 0.0, 0.0}), options);
  RovigoConfig config = dock_config();
  config.control.pose_patience_s = 3.0;
  const DockDrive dock = dock_on_marker(simulator, TPose2D(), kId + 1, config);
  EXPECT_EQ(dock.sightings, 0);
  EXPECT_EQ(dock.log.status, control::TrackStatus::kPoseLost);
  EXPECT_NEAR(simulator.truth().world_from_base.x(), -1.0, 0.01);
}

TEST(Docking, FromAfarAMarkerThatMayFaceTwoWaysIsNotMistakenForTheWrongOne) {
  // At 3 m the two poses of a square this small are 40 deg apart and fit about as well.
  const TPose2D marker(1.5, 0.0, 0.0), world_from_dock(1.5 - kStandoffM, 0.0, 0.0);
  sim::SimulatorOptions options;
  options.camera_rate_hz = 20.0;
  options.world_from_base = {world_from_dock.x - 3.0, 0.3, -0.1};
  options.seed = 3;
  sim::Simulator simulator(world_with_marker(marker), options);
  const DockDrive dock = dock_on_marker(simulator, world_from_dock, kId, dock_config());
  EXPECT_EQ(dock.log.status, control::TrackStatus::kReached);
  const TPose2D end = maps::compose(maps::inverse(world_from_dock), sim::true_pose(simulator));
  EXPECT_LE(std::hypot(end.x, end.y), 0.02) << end.x << " " << end.y;
}

TEST(Docking, StandsWithin02sAndStaysThereWhenAHandIsLaidOnTheRoverOnItsWay) {
  sim::SimulatorOptions options;
  options.camera_rate_hz = 20.0;
  options.world_from_base = {-1.2, 0.0, 0.0};
  options.scenario.faults.push_back({.kind = "manual_takeover", .start_s = 3.0});
  sim::Simulator simulator(world_with_marker({1.0, 0.0, 0.0}), options);
  RovigoConfig config = dock_config();
  config.control.takeover_patience_s = 2.0;
  const TPose2D world_from_dock(1.0 - kStandoffM, 0.0, 0.0);
  const DockDrive dock = dock_on_marker(simulator, world_from_dock, kId, config);
  EXPECT_EQ(dock.log.status, control::TrackStatus::kStopped);
  EXPECT_EQ(dock.log.held, control::StopCause::kManual);
  int held = 0;
  for (const auto& step : dock.log.steps) {
    if (step.held != control::StopCause::kManual) continue;
    ++held;
    EXPECT_EQ(step.command.vx, 0.0);
    EXPECT_EQ(step.command.omega, 0.0);
  }
  EXPECT_GT(held, 100);
}

}  // namespace
}  // namespace rovigo::app
