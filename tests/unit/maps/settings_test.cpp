#include "maps/settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "maps/error.h"
#include "maps/nearest_word.h"
#include "maps/robot_model.h"

namespace rovigo::maps {
namespace {

using testing::HasSubstr;

TEST(Settings, DefaultsAreValid) { EXPECT_NO_THROW(validate(RobotModel{})); }

TEST(Settings, EveryBadFieldIsNamedWithItsValueAndItsLimits) {
  RobotModel robot;
  robot.max_speed_m_s = 9.0;
  robot.wheel_radius_m = std::nan("");
  try {
    validate(robot);
    FAIL() << "accepted nonsense";
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("max_speed_m_s = 9 is outside [0.05, 0.8]"));
    EXPECT_THAT(e.what(), HasSubstr("wheel_radius_m = nan"));
  }
}

TEST(Settings, ATextOutsideItsChoicesIsRefusedWithTheChoices) {
  const SettingInfo info{.name = "planner", .help = "", .choices = {"astar", "rrtstar"}};
  EXPECT_EQ(choice_problem(info, "astar"), "");
  EXPECT_THAT(choice_problem(info, "dijkstra"), HasSubstr("astar, rrtstar"));
}

TEST(NearestWord, HasTheFewestEdits) {
  EXPECT_EQ(nearest_word("max_sped", {"min_speed", "max_speed", "gain"}), "max_speed");
  EXPECT_EQ(nearest_word("x", {}), "");
  EXPECT_EQ(nearest_word(std::string(1000000, 'a'), {"b", "aaaa"}), "aaaa");
}

}  // namespace
}  // namespace rovigo::maps
