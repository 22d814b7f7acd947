#include "planning/planner_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "maps/error.h"
#include "planning/planner.h"
#include "tests/unit/planning/grids.h"

namespace rovigo::planning {
namespace {

using testing::HasSubstr;

TEST(PlannerConfig, BadSettingsAreNamed) {
  PlannerConfig config;
  config.astar.connectivity = 5;
  EXPECT_THROW(Planner(grid_of({".."}, 1.0), {}, {}, config), maps::InputError);
  config = {};
  config.planner = "dijkstra";
  config.spline.max_curvature_1_m = -1.0;
  try {
    validate(config);
    FAIL() << "accepted";
  } catch (const maps::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("dijkstra"));
    EXPECT_THAT(error.what(), HasSubstr("max_curvature_1_m"));
  }
}

TEST(PlannerConfig, KindsHaveNamesThatParseBack) {
  for (const auto kind : {PlannerKind::kAStar, PlannerKind::kThetaStar, PlannerKind::kRrtConnect,
                          PlannerKind::kRrtStar, PlannerKind::kBitStar, PlannerKind::kPrmStar}) {
    EXPECT_EQ(parse_planner_kind(to_string(kind)), kind);
  }
  EXPECT_FALSE(parse_planner_kind("theta").has_value());
}

}  // namespace
}  // namespace rovigo::planning
