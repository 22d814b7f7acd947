#include "app/route_maker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "app/route_drive.h"
#include "maps/distance_field.h"
#include "maps/error.h"

namespace rovigo::app {
namespace {

double planned_length(const sim::Route& route, const sim::World& world,
                      const RovigoConfig& config) {
  const auto planner = route_planner(world, config, route.speed_m_s);
  planning::PlanRequest request;
  request.start = route_start(route, world, planner);
  request.start_heading_given = true;
  request.via.assign(route.waypoints.begin() + 1, route.waypoints.end() - 1);
  request.goal = {route.waypoints.back().x, route.waypoints.back().y, 0.0};
  const auto plan = planner.plan(request);
  EXPECT_EQ(plan.status, planning::PlanStatus::kOk) << plan.message;
  return plan.path_length_m;
}

TEST(MadeTour, IsClosedDrivableAndAboutAsLongAsAskedInWorldsNobodyTunedFor) {
  const RovigoConfig config;
  for (const std::uint64_t seed : {21U, 22U, 23U, 24U}) {
    const auto world = sim::World::random_office(seed);
    for (const double length_m : {20.0, 40.0}) {
      SCOPED_TRACE(world.name());
      const auto route = make_tour({.length_m = length_m, .seed = seed}, world, config);
      EXPECT_EQ(route.waypoints.front(), route.waypoints.back());
      EXPECT_LT(maps::distance(route.waypoints.front(), maps::position_of(world.start())), 0.01);
      EXPECT_NEAR(planned_length(route, world, config), length_m, 0.15 * length_m);
    }
  }
}

TEST(MadeTour, ComesByPlacesSeenBeforeInItsSecondHalf) {
  const auto world = sim::World::random_office(5);
  const auto route = make_tour({.length_m = 60.0, .seed = 3}, world, {});
  const std::size_t half = route.waypoints.size() / 2;
  int again = 0;
  for (std::size_t i = half; i + 1 < route.waypoints.size(); ++i) {
    for (std::size_t j = 0; j < half; ++j) again += route.waypoints[i] == route.waypoints[j];
  }
  EXPECT_GE(again, 3);
}

TEST(MadeTour, OneSeedGivesOneTourAndAnotherSeedAnother) {
  const auto world = sim::World::random_office(5);
  const auto points = [&](std::uint64_t seed) {
    return make_tour({.length_m = 30.0, .seed = seed}, world, {}).waypoints;
  };
  EXPECT_EQ(points(1), points(1));
  EXPECT_NE(points(1), points(2));
}

TEST(MadeTour, WithTurnsTurnsByHalfToOneRevolutionAtEveryPlace) {
  const auto world = sim::World::random_office(6);
  const auto route = route_in_world("turns:20:4", world, {});
  EXPECT_EQ(route.turns.size(), route.waypoints.size() - 2);
  EXPECT_EQ(route.turn_rate_rad_s, 1.5);
  for (const auto& turn : route.turns) {
    EXPECT_GE(std::abs(turn.turn_rad), maps::kPi);
    EXPECT_LE(std::abs(turn.turn_rad), 2.0 * maps::kPi);
  }
}

TEST(RouteText, SpinAndLoopSayWhatTheyMean) {
  const auto world = sim::World::random_office(6);
  const auto spin = route_in_world("spin:2.5,4.0,-1.5:-0.7:10", world, {});
  ASSERT_EQ(spin.waypoints.size(), 1U);
  EXPECT_EQ(spin.waypoints[0].y, 4.0);
  EXPECT_EQ(spin.start_yaw_rad, -1.5);
  EXPECT_NEAR(spin.turn_rate_rad_s, 0.7, 1e-12);
  EXPECT_NEAR(spin.turns.at(0).turn_rad, -7.0, 1e-12);
  EXPECT_NEAR(route_in_world("spin:2,4,0", world, {}).turns.at(0).turn_rad, 2.0 * maps::kPi, 1e-9);
  EXPECT_EQ(route_in_world("loop:20:3:40", world, {}).laps, 40);
}

TEST(RouteText, IsRefusedWithTheFormItShouldHave) {
  const auto world = sim::World::random_office(6);
  for (const std::string text :
       {"loop:", "loop:x", "loop:1", "loop:1e9", "loop:nan", "loop:30:1.5", "loop:30:-1",
        "loop:30:1:2:3", "loop:30:1:99999", "turns:20:1:2", "turns:", "spin:1,2", "spin:1,2,3,4",
        "spin:1,2,inf", "spin:1,2,3:0", "spin:1,2,3:9", "spin:1,2,3:0.5:-1", "spin:"}) {
    try {
      route_in_world(text, world, {});
      FAIL() << "accepted " << text;
    } catch (const maps::InputError& e) {
      EXPECT_NE(std::string(e.what()).find("write " + text.substr(0, text.find(':'))),
                std::string::npos)
          << e.what();
    }
  }
  EXPECT_THROW(route_in_world("loop", world, {}), maps::InputError) << "no such file";
}

/// Drives a route blindly and gives what came of it.
RouteDriveResult driven(const sim::Route& route, const sim::World& world,
                        const sim::Scenario& scenario,
                        const std::function<void(const sim::Simulator&)>& look = {}) {
  const RovigoConfig config;
  const auto planner = route_planner(world, config, route.speed_m_s);
  sim::SimulatorOptions options;
  options.scenario = scenario;
  options.camera_enabled = false;
  options.world_from_base = route_start(route, world, planner);
  sim::Simulator simulator(world, options);
  DriveHooks hooks;
  hooks.progress = [&](double share) {
    EXPECT_GE(share, 0.0);
    EXPECT_LE(share, 1.0);
    if (look) look(simulator);
  };
  hooks.observation = [&](const mrpt::obs::CObservation&) {
    if (look) look(simulator);
  };
  auto result = drive_route(simulator, route, options.world_from_base, planner, config, hooks);
  const auto& p = simulator.truth().world_from_base;
  EXPECT_LT(std::hypot(p.x() - route.waypoints.back().x, p.y() - route.waypoints.back().y), 0.1);
  return result;
}

TEST(RouteDrive, TurnsInPlaceAtTheRateOfTheRoute) {
  const auto world = sim::World::random_office(6);
  sim::Route route;
  route.waypoints = {maps::position_of(world.start())};
  route.start_yaw_rad = 0.0;
  for (const double rate : {0.5, 1.5, 2.0}) {
    route.turn_rate_rad_s = rate;
    route.turns = {{0, 3.0 * maps::kPi}};
    double fast_s = 0.0;
    double yaw = 0.0;
    double before = 0.0;
    double last_s = 0.0;
    const auto result =
        driven(route, world, sim::ideal_scenario(), [&](const sim::Simulator& simulator) {
          const double now = simulator.truth().world_from_base.yaw();
          yaw += maps::wrap_angle(now - before);
          before = now;
          const double omega = simulator.truth().twist.omega;
          EXPECT_LT(omega, 1.15 * rate);
          if (omega > 0.95 * rate) fast_s += simulator.time_s() - last_s;
          last_s = simulator.time_s();
        });
    EXPECT_TRUE(result.completed) << result.message;
    EXPECT_NEAR(yaw, 3.0 * maps::kPi, 0.15);
    EXPECT_GT(fast_s, 0.6 * 3.0 * maps::kPi / rate) << "at " << rate << " rad/s";
  }
}

TEST(RouteDrive, GoesOnThroughWhatIsLeftAfterAKidnapInAnyWorld) {
  for (const std::uint64_t seed : {31U, 32U, 33U}) {
    const auto world = sim::World::random_office(seed);
    SCOPED_TRACE(world.name());
    const auto route = route_in_world("loop:15:" + std::to_string(seed), world, {});
    sim::Scenario scenario = sim::ideal_scenario();
    scenario.kidnaps.push_back({.time_s = 8.0, .carry_s = 2.0, .where = "driven"});
    scenario.kidnaps.push_back({.time_s = 20.0, .forward_m = 3.0, .carry_s = 0.0});
    const auto result = driven(route, world, scenario);
    EXPECT_TRUE(result.completed) << result.message;
    EXPECT_EQ(result.kidnaps, 2);
    EXPECT_EQ(result.log.contact_events, 0);
  }
}

TEST(RouteDrive, AKidnapInTheMiddleOfATurnDoesNotCountAsTurning) {
  const auto world = sim::World::random_office(31);
  sim::Route route;
  route.waypoints = {maps::position_of(world.start())};
  route.start_yaw_rad = 0.0;
  route.turn_rate_rad_s = 0.5;
  route.turns = {{0, 2.0 * maps::kPi}};
  sim::Scenario scenario = sim::ideal_scenario();
  scenario.kidnaps.push_back({.time_s = 4.0, .forward_m = 0.0, .turn_deg = 120.0});
  double yaw = 0.0;
  double before = 0.0;
  const auto result = driven(route, world, scenario, [&](const sim::Simulator& simulator) {
    const double now = simulator.truth().world_from_base.yaw();
    yaw += maps::wrap_angle(now - before);
    before = now;
  });
  EXPECT_TRUE(result.completed) << result.message;
  EXPECT_NEAR(yaw, 2.0 * maps::kPi + 120.0 * maps::kPi / 180.0, 0.15);
}

TEST(RouteDrive, LapsAreDrivenOneAfterTheOther) {
  const auto world = sim::World::random_office(6);
  auto route = route_in_world("loop:8:3", world, {});
  const double once = driven(route, world, sim::ideal_scenario()).planned_length_m;
  route.laps = 3;
  const auto result = driven(route, world, sim::ideal_scenario());
  EXPECT_TRUE(result.completed) << result.message;
  EXPECT_NEAR(result.planned_length_m, 3.0 * once, 0.1 * once);
}

TEST(RouteDrive, ARouteThatCannotBeDrivenIsRefusedBeforeAnythingIsRecorded) {
  const auto world = sim::World::random_office(6);
  sim::Route route;
  route.name = "into_the_wall";
  const TPoint2D start = maps::position_of(world.start());
  route.waypoints = {start, {start.x + 500.0, start.y}};
  const RovigoConfig config;
  const auto planner = route_planner(world, config, 0.4);
  EXPECT_THROW(route_start(route, world, planner), maps::InputError);
}

}  // namespace
}  // namespace rovigo::app
