#include "app/text.h"

#include <gtest/gtest.h>

#include "maps/error.h"

namespace rovigo::app {
namespace {

TEST(Text, OnlyWholeFiniteNumbersAreNumbers) {
  EXPECT_EQ(parse_number("-1.5e2"), -150.0);
  EXPECT_EQ(parse_number("+2"), 2.0);
  for (const char* text : {"", "1x", "nan", "inf", "1,2", " 1", "--1", "1e999"}) {
    EXPECT_FALSE(parse_number(text)) << text;
  }
}

TEST(Text, APoseIsTwoOrThreeNumbers) {
  EXPECT_FALSE(parse_pose("--goal", "1,2").has_heading);
  const PoseArgument with_yaw = parse_pose("--goal", "-1,2,7");
  EXPECT_TRUE(with_yaw.has_heading);
  EXPECT_NEAR(with_yaw.pose.phi, 7.0 - 2.0 * maps::kPi, 1e-12);
  for (const char* text : {"", "1", "1,", "1,2,3,4", "a,b", "1;2"}) {
    EXPECT_THROW(parse_pose("--goal", text), maps::InputError) << text;
  }
  EXPECT_THROW(parse_point("--via", "1,2,3"), maps::InputError);
}

}  // namespace
}  // namespace rovigo::app
