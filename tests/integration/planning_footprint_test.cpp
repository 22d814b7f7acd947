// `rovigo plan` with the rover's rectangle, and `rovigo drive`, which leaves such plans alone.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "maps/ros_map.h"
#include "tests/support/run_rovigo.h"
#include "tests/unit/planning/grids.h"

namespace rovigo::test {
namespace {

using testing::HasSubstr;

class FootprintOnTheCommandLine : public testing::Test {
 protected:
  FootprintOnTheCommandLine() {
    auto grid = planning::room(6, 4);
    planning::fill(grid, 2.85, 0.0, 3.15, 1.8);
    planning::fill(grid, 2.85, 2.3, 3.15, 4.0);  // half a metre is left
    maps::save_ros_map(grid, map_);
  }
  ProcessResult run(std::vector<std::string> arguments, bool rectangle) const {
    const std::vector<std::string> rest{"--goal", "5,3", "--planner", "rrtconnect", "--json"};
    arguments.insert(arguments.begin() + 1, map_);
    arguments.insert(arguments.end(), rest.begin(), rest.end());
    if (rectangle) {
      arguments.push_back("--set");
      arguments.push_back("planning.footprint=rectangle");
    }
    return run_rovigo(arguments);
  }

  TemporaryFolder folder_;
  std::string map_ = folder_ / "rooms.yaml";
};

TEST_F(FootprintOnTheCommandLine, PlansThroughTheGapAndDrawsTheRover) {
  EXPECT_EQ(run({"plan", "--start", "1,1"}, false).exit_code, 1);
  const std::string image = folder_ / "plan.png", path = folder_ / "plan.csv";
  const auto planned = run({"plan", "--start", "1,1", "--image", image, "--path", path}, true);
  ASSERT_EQ(planned.exit_code, 0) << planned.err;
  const auto json = nlohmann::json::parse(planned.out);
  EXPECT_EQ(json["status"], "ok");
  EXPECT_GT(json["min_clearance_m"], 0.0);
  EXPECT_LT(json["min_clearance_m"], 0.05);
  EXPECT_THAT(read_text(image), HasSubstr("PNG"));
  EXPECT_THAT(read_text(path), HasSubstr("t_s,x_m,y_m"));
}

TEST_F(FootprintOnTheCommandLine, IsNotDriven) {
  const auto driven = run({"drive", "--start", "1,1"}, true);
  EXPECT_EQ(driven.exit_code, 2);
  EXPECT_THAT(driven.err, HasSubstr("planning.footprint = circle"));
}

TEST_F(FootprintOnTheCommandLine, NeedsASamplingPlanner) {
  const auto planned = run_rovigo(
      {"plan", map_, "--start", "1,1", "--goal", "5,3", "--set", "planning.footprint=rectangle"});
  EXPECT_EQ(planned.exit_code, 2);
  EXPECT_THAT(planned.err, HasSubstr("rrtconnect"));
}

}  // namespace
}  // namespace rovigo::test
