#include "app/config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "maps/error.h"

namespace rovigo::app {
namespace {

using testing::HasSubstr;

TEST(Config, DefaultsAreInsideTheirOwnRanges) {
  std::vector<std::string> as_written;
  for (const auto& row : list_settings(RovigoConfig{}))
    as_written.push_back(row.key + "=" + row.value);
  EXPECT_NO_THROW(load_config(std::nullopt, as_written));
}

TEST(Config, EverySettingHasAnExplanationAndAUniqueName) {
  std::set<std::string> keys;
  for (const auto& row : list_settings(RovigoConfig{})) {
    EXPECT_TRUE(keys.insert(row.key).second) << row.key;
    EXPECT_GT(row.help.size(), 10u) << row.key;
    EXPECT_TRUE(row.type == "text" || row.type == "true/false" || !row.range.empty())
        << row.key << " has no range";
  }
}

TEST(Config, FewerThanTwentySettingsFaceAUser) {
  int plain = 0;
  for (const auto& row : list_settings(RovigoConfig{})) plain += !row.advanced;
  EXPECT_LT(plain, 20);
  EXPECT_GT(plain, 3);
}

TEST(Config, TheLastAssignmentWins) {
  const auto config =
      load_config(std::nullopt, {"robot.max_speed_m_s=0.2", "robot.max_speed_m_s=0.3"});
  EXPECT_DOUBLE_EQ(config.robot.max_speed_m_s, 0.3);
}

TEST(Config, TheRobotsRadiusIsTheInflationsRadius) {
  EXPECT_DOUBLE_EQ(
      load_config(std::nullopt, {"robot.robot_radius_m=0.25"}).inflation.robot_radius_m, 0.25);
}

TEST(Config, EveryProblemIsListedAtOnceWithTheNearestKey) {
  try {
    load_config(std::nullopt, {"robot.max_sped_m_s=0.2", "robot.robot_radius_m=50"});
    FAIL() << "accepted nonsense";
  } catch (const maps::InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("robot.max_speed_m_s"));
    EXPECT_THAT(e.what(), HasSubstr("robot_radius_m = 50"));
  }
}

TEST(Config, TheDocumentedSettingsAreFresh) {
  std::ifstream in(ROVIGO_SOURCE_DIR "/app/SETTINGS.md");
  std::ostringstream text;
  text << in.rdbuf();
  EXPECT_EQ(text.str(), settings_markdown())
      << "run: build/release/rovigo config --markdown > app/SETTINGS.md";
}

}  // namespace
}  // namespace rovigo::app
