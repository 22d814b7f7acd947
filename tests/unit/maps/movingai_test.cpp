#include "maps/movingai.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "maps/error.h"
#include "tests/unit/maps/test_support.h"

namespace rovigo::maps {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string kMap = "type octile\nheight 2\nwidth 3\nmap\n.G@\nTSW\n";

std::string refusal(const std::string& text) {
  try {
    parse_movingai_map(text, "x.map");
  } catch (const InputError& e) {
    return e.what();
  }
  return "loaded";
}

TEST(MovingAiMap, FileRowZeroIsOnTopAndOnlyDotAndGAreFree) {
  const OccupancyGrid grid = parse_movingai_map(kMap, "x.map");
  EXPECT_TRUE(grid.geometry == (GridGeometry{1.0, {0.0, 0.0}, 3, 2}));
  EXPECT_THAT(grid.cells, ElementsAre(100, 100, 100, 0, 0, 100));
}

TEST(MovingAiMap, WindowsLineEndsAndMissingLastOneAreFine) {
  EXPECT_EQ(parse_movingai_map("type octile\r\nheight 1\r\nwidth 2\r\nmap\r\n..", "x").cells.size(),
            2u);
}

TEST(MovingAiMap, MalformedFilesAreNamedWithTheirLine) {
  EXPECT_THAT(refusal(""), HasSubstr("no MovingAI map"));
  EXPECT_THAT(refusal("hello\n"), HasSubstr("line 1"));
  EXPECT_THAT(refusal("type octile\nheight 2\nwidth 3\nmap\n...\n"), HasSubstr("ends after 1"));
  EXPECT_THAT(refusal("type octile\nheight 2\nwidth 3\nmap\n...\n..\n"), HasSubstr("2 cells"));
  EXPECT_THAT(refusal("height 2\nmap\n"), HasSubstr("before width and height"));
  EXPECT_THAT(refusal("height 30000\nwidth 30000\nmap\n..."), HasSubstr("claims"));
  EXPECT_THAT(refusal("height 3000\nwidth 3000\nmap\n..."), HasSubstr("cut off"));
  EXPECT_THAT(refusal("height -3\n"), HasSubstr("height"));
  EXPECT_THAT(refusal("height 99999999999999999999\n"), HasSubstr("height"));
}

TEST(MovingAiScenario, GivesPointsOfTheGrid) {
  const auto problems =
      parse_movingai_scenario("version 1\n0\ta map.map\t3\t2\t0\t0\t1\t1\t2.41421\n", "x.scen");
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].map, "a map.map");
  EXPECT_EQ(problems[0].start().x, 0.5);
  EXPECT_EQ(problems[0].start().y, 1.5);
  EXPECT_EQ(problems[0].goal().x, 1.5);
  EXPECT_EQ(problems[0].goal().y, 0.5);
  EXPECT_EQ(problems[0].optimal_length, 2.41421);
}

TEST(MovingAiScenario, MalformedFilesAreNamedWithTheirLine) {
  const auto problem = [](const std::string& text) -> std::string {
    try {
      parse_movingai_scenario(text, "x.scen");
    } catch (const InputError& e) {
      return e.what();
    }
    return "loaded";
  };
  EXPECT_THAT(problem(""), HasSubstr("version"));
  EXPECT_THAT(problem("version 1\n1 2 3\n"), HasSubstr("line 2"));
  EXPECT_THAT(problem("version 1\n0 m 3 2 0 0 1 x 2.4\n"), HasSubstr("column 8"));
  EXPECT_THAT(problem("version 1\n0 m 3 2 0 0 1 1 nan\n"), HasSubstr("column 9"));
}

TEST(MovingAi, ReadsTheBenchmarkFiles) {
  const auto folder = test::shared_data() / "maps/movingai";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not here";
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".map") continue;
    const OccupancyGrid grid = load_movingai_map(entry.path());
    const auto problems = load_movingai_scenario(entry.path().string() + ".scen");
    EXPECT_FALSE(problems.empty());
    for (const MovingAiProblem& p : problems) {
      ASSERT_EQ(p.map_width, grid.geometry.width);
      ASSERT_EQ(p.map_height, grid.geometry.height);
      ASSERT_TRUE(OccupancyGrid::is_free(grid.at(grid.geometry.cell_at(p.start()))));
      ASSERT_TRUE(OccupancyGrid::is_free(grid.at(grid.geometry.cell_at(p.goal()))));
    }
    ++files;
  }
  EXPECT_EQ(files, 5);
}

}  // namespace
}  // namespace rovigo::maps
