// The routes and worlds that ship with the program fit together.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "maps/error.h"
#include "sim/route.h"
#include "sim/simulator.h"
#include "sim/world.h"
#include "sim/world_model.h"

namespace rovigo::sim {
namespace {

const std::string kSim = ROVIGO_SOURCE_DIR "/sim/";

/// From a point to the edge of the nearest occupied cell, metres.
double clearance(const maps::OccupancyGrid& grid, const TPoint2D& p) {
  const auto& g = grid.geometry;
  double nearest = std::numeric_limits<double>::infinity();
  const maps::Cell c = g.cell_at(p);
  const int reach = static_cast<int>(1.0 / g.resolution_m);
  for (int y = std::max(0, c.y - reach); y <= std::min(g.height - 1, c.y + reach); ++y) {
    for (int x = std::max(0, c.x - reach); x <= std::min(g.width - 1, c.x + reach); ++x) {
      if (!maps::OccupancyGrid::is_occupied(grid.at({x, y}))) continue;
      const TPoint2D q = g.center_of({x, y});
      const double half = g.resolution_m / 2;
      nearest = std::min(nearest, std::hypot(std::max(0.0, std::abs(p.x - q.x) - half),
                                             std::max(0.0, std::abs(p.y - q.y) - half)));
    }
  }
  return nearest;
}

class ShippedRoute : public testing::TestWithParam<std::string> {};

TEST_P(ShippedRoute, KeepsItsDistanceFromEveryObstacle) {
  const Route route = load_route(kSim + "routes/" + GetParam() + ".yaml");
  const World world = World::load(kSim + "worlds/" + route.world + ".sdf");
  const auto grid = true_grid(world, 0.02, 0.05, 0.50);
  EXPECT_LT(maps::distance(route.waypoints.front(), maps::position_of(world.start())), 0.05);
  double length = 0.0;
  for (std::size_t i = 1; i < route.waypoints.size(); ++i) {
    const TPoint2D a = route.waypoints[i - 1];
    const TPoint2D b = route.waypoints[i];
    length += maps::distance(a, b);
    const int steps = static_cast<int>(maps::distance(a, b) / 0.02) + 1;
    double nearest = 1e9;
    for (int k = 0; k <= steps; ++k) {
      const double t = static_cast<double>(k) / steps;
      nearest = std::min(nearest, clearance(grid, {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)}));
    }
    EXPECT_GE(nearest, 0.45) << "from (" << a.x << ", " << a.y << ") to (" << b.x << ", " << b.y
                             << ")";
  }
  RecordProperty("length_m", std::to_string(length));
}

INSTANTIATE_TEST_SUITE_P(All, ShippedRoute,
                         testing::Values("lab_tour", "lab_short", "office_loop", "lab_turns",
                                         "corridor_out_and_back"),
                         [](const auto& test) { return test.param; });

TEST(Route, MayTurnInPlaceAtWaypointsAndBeDrivenInLaps) {
  const Route route = parse_route(
      "waypoints: [[0, 0], {at: [1, 0], turn_deg: 360}, {at: [1, 2], turn_deg: -90}, [0, 0]]\n"
      "turn_rate_rad_s: 2.0\nlaps: 3\n",
      "r.yaml");
  ASSERT_EQ(route.waypoints.size(), 4U);
  ASSERT_EQ(route.turns.size(), 2U);
  EXPECT_EQ(route.turns[0].waypoint, 1U);
  EXPECT_NEAR(route.turns[0].turn_rad, 2.0 * maps::kPi, 1e-12);
  EXPECT_NEAR(route.turns[1].turn_rad, -0.5 * maps::kPi, 1e-12);
  EXPECT_EQ(route.turn_rate_rad_s, 2.0);
  EXPECT_EQ(route.laps, 3);
  EXPECT_NEAR(route.start_yaw_rad.value(), 0.0, 1e-12);
}

TEST(Route, TheOfficeLoopIsThirtyMetresLongAndComesHome) {
  const Route route = load_route(kSim + "routes/office_loop.yaml");
  double length = 0.0;
  for (std::size_t i = 1; i < route.waypoints.size(); ++i) {
    length += maps::distance(route.waypoints[i - 1], route.waypoints[i]);
  }
  EXPECT_NEAR(length, 30.0, 1.5);
  EXPECT_LT(maps::distance(route.waypoints.front(), route.waypoints.back()), 0.05);
}

TEST(CorridorWorld, HasNothingButPlainSurfacesForTwentyMetres) {
  const World world = World::load(kSim + "worlds/corridor.sdf");
  int walls = 0;
  for (const auto& solid : world.model().solids) {
    double low = 1e9;
    double high = -1e9;
    for (const auto& p : corners_of(solid)) {
      low = std::min(low, p.x());
      high = std::max(high, p.x());
    }
    // Between the two door frames; what spans it all is wall, floor or ceiling.
    if (high < 5.2 || low > 24.8) continue;
    EXPECT_EQ(solid.material.pattern, Pattern::kPlain) << solid.name;
    EXPECT_TRUE(low < 5.2 && high > 24.8) << solid.name << " breaks the corridor's monotony";
    walls += solid.name.find("corridor_wall") != std::string::npos;
  }
  EXPECT_EQ(walls, 2);
}

TEST(Route, AnUnknownKeyIsRefusedWithItsLineAndTheNearestValidKey) {
  try {
    parse_route("waypoints: [[0, 0], [1, 0]]\nspeed: 0.4\n", "r.yaml");
    FAIL() << "accepted";
  } catch (const maps::InputError& e) {
    EXPECT_NE(std::string(e.what()).find("r.yaml:2"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("\"speed_m_s\""), std::string::npos) << e.what();
  }
}

TEST(Route, BadWaypointsAreRefused) {
  for (const char* text :
       {"", "waypoints: 3", "waypoints: [[0, 0]]", "waypoints: [[0, 0], [1]]",
        "waypoints: [[0, 0], [1, nan]]", "waypoints: [[0, 0], [1, x]]",
        "waypoints: [[0, 0], [1e9, 0]]", "waypoints: [[0, 0], {turn_deg: 90}]",
        "waypoints: [[0, 0], {at: [1, 0], turn_deg: nan}]",
        "waypoints: [[0, 0], {at: [1, 0], turn_deg: 1e9}]",
        "waypoints: [[0, 0], {at: [1, 0], turns: 1}]", "waypoints: [[0, 0], [1, 0]]\nlaps: 0",
        "waypoints: [[0, 0], [1, 0]]\nturn_rate_rad_s: 2.5",
        "waypoints: [[0, 0], [1, 0]]\nspeed_m_s: 9", "[1, 2]", "waypoints: [[0, 0",
        "waypoints: [[0, 0], [1, 0]]\nwaypoints: [[0, 0], [1, 0]]"}) {
    EXPECT_THROW(parse_route(text, "r.yaml"), maps::InputError) << text;
  }
}

TEST(Route, AMissingFileIsNamed) {
  try {
    load_route("/nowhere/route.yaml");
    FAIL() << "accepted";
  } catch (const maps::InputError& e) {
    EXPECT_NE(std::string(e.what()).find("/nowhere/route.yaml"), std::string::npos);
  }
}

}  // namespace
}  // namespace rovigo::sim
