// Random worlds: every plan is sound, however cluttered the world; refusals match a flood.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "planning/check.h"
#include "planning/planner.h"
#include "planning/smoother.h"

namespace rovigo::planning {
namespace {

using maps::OccupancyGrid;

struct Style {
  const char* name;
  double resolution_m;
  double radius_m;
  int boxes;
  int poles;
  double unknown;  ///< share of cells
  const char* planner = "astar";
};

OccupancyGrid random_world(std::mt19937_64& random, const Style& style) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  maps::GridGeometry g;
  g.resolution_m = style.resolution_m;
  g.width = static_cast<int>(8.0 / style.resolution_m);
  g.height = static_cast<int>(6.0 / style.resolution_m);
  g.origin = {-3.0, 2.0};
  OccupancyGrid grid(g, OccupancyGrid::kFree);
  for (auto& cell : grid.cells) {
    if (unit(random) < style.unknown) cell = OccupancyGrid::kUnknown;
  }
  const auto box = [&](double width, double height) {
    const int w = std::max(1, static_cast<int>(width / g.resolution_m));
    const int h = std::max(1, static_cast<int>(height / g.resolution_m));
    const int x0 = static_cast<int>(unit(random) * g.width);
    const int y0 = static_cast<int>(unit(random) * g.height);
    for (int y = y0; y < std::min(y0 + h, g.height); ++y) {
      for (int x = x0; x < std::min(x0 + w, g.width); ++x) {
        grid.at({x, y}) = OccupancyGrid::kOccupied;
      }
    }
  };
  for (int i = 0; i < style.boxes; ++i) box(0.2 + 1.2 * unit(random), 0.2 + 0.6 * unit(random));
  for (int i = 0; i < style.poles; ++i) box(0.0, 0.0);
  return grid;
}

class RandomWorlds : public testing::TestWithParam<Style> {};

TEST_P(RandomWorlds, EveryPlanPassesTheChecker) {
  const Style& style = GetParam();
  constexpr std::uint64_t kSeed = 99;
  std::mt19937_64 random(kSeed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  maps::RobotModel robot;
  robot.robot_radius_m = style.radius_m;
  maps::InflationConfig inflation;
  inflation.robot_radius_m = style.radius_m;
  PlannerConfig config;
  config.planner = style.planner;
  config.ompl.rrtstar_iterations = 500;
  config.ompl.bitstar_iterations = 2000;
  config.ompl.prmstar_iterations = 300;
  int planned = 0;
  for (int i = 0; i < 25; ++i) {
    const OccupancyGrid grid = random_world(random, style);
    const Planner planner(grid, robot, inflation, config);
    for (int k = 0; k < 8; ++k) {
      const auto& g = grid.geometry;
      const auto somewhere = [&] {
        return TPose2D{g.origin.x + unit(random) * g.width * g.resolution_m,
                       g.origin.y + unit(random) * g.height * g.resolution_m,
                       maps::kPi * (2.0 * unit(random) - 1.0)};
      };
      PlanRequest request;
      request.start = somewhere();
      request.goal = somewhere();
      request.start_heading_given = k % 2 == 0;
      request.goal_heading_given = k % 4 < 2;
      if (k == 7) request.via.push_back(maps::position_of(somewhere()));
      const PlanResult result = planner.plan(request);
      if (result.status != PlanStatus::kOk) continue;
      ++planned;
      CheckOptions options;
      options.robot_radius_m = style.radius_m;
      options.limits = limits_of(robot, config.timing);
      options.escape_allowed = result.escape;
      const auto report = check(result.trajectory, grid, options);
      ASSERT_THAT(report.problems, testing::IsEmpty())
          << "world " << i << " query " << k << " seed " << kSeed;
    }
  }
  EXPECT_GT(planned, 30) << "the worlds no longer exercise the planner";
}

INSTANTIATE_TEST_SUITE_P(Styles, RandomWorlds,
                         testing::Values(Style{"Rooms", 0.05, 0.30, 12, 0, 0.0},
                                         Style{"Poles", 0.05, 0.30, 0, 25, 0.0},
                                         Style{"Speckled", 0.05, 0.15, 6, 10, 0.02},
                                         Style{"Coarse", 0.10, 0.25, 12, 5, 0.0},
                                         Style{"RadiusOnTheGrid", 0.10, 0.15, 12, 10, 0.0},
                                         Style{"PointRobot", 0.10, 0.0, 25, 40, 0.05},
                                         Style{"ThetaStar", 0.05, 0.30, 8, 8, 0.0, "thetastar"},
                                         Style{"RrtConnect", 0.05, 0.30, 8, 8, 0.0, "rrtconnect"},
                                         Style{"RrtStar", 0.05, 0.30, 8, 8, 0.0, "rrtstar"},
                                         Style{"BitStar", 0.05, 0.30, 8, 8, 0.0, "bitstar"},
                                         Style{"PrmStar", 0.05, 0.30, 8, 8, 0.0, "prmstar"}),
                         [](const auto& param) { return std::string(param.param.name); });

TEST(SplinePieces, AreTwiceContinuouslyDifferentiableInRandomWorlds) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  maps::GridGeometry g;
  g.width = g.height = 120;
  int bends = 0;
  for (int i = 0; i < 30; ++i) {
    OccupancyGrid grid(g, OccupancyGrid::kFree);
    maps::Costmap costmap(g);
    const FreeSpace space(grid, costmap, 0.3);
    SmoothingProblem problem;
    for (int k = 0; k < 6; ++k) {
      problem.polyline.points.push_back({0.5 + 5.0 * unit(random), 0.5 + 5.0 * unit(random)});
    }
    for (const PathPiece& piece : smooth(space, problem, {})) {
      const auto& knots = piece.curve.knots();
      for (std::size_t k = 4; k + 4 < knots.size(); ++k) {
        const CurvePoint before = piece.curve.at(knots[k] - 1e-10);
        const CurvePoint after = piece.curve.at(knots[k] + 1e-10);
        ASSERT_NEAR(maps::distance(before.position, after.position), 0.0, 1e-8);
        ASSERT_NEAR(maps::distance(before.first, after.first), 0.0, 1e-8);
        ASSERT_NEAR(maps::distance(before.second, after.second), 0.0, 1e-8);
        ASSERT_NEAR(before.curvature(), after.curvature(), 1e-5);
        bends += std::abs(after.curvature()) > 0.1 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(bends, 100);
}

}  // namespace
}  // namespace rovigo::planning
