// `rovigo dock` as users call it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/run_rovigo.h"

namespace {

using rovigo::test::read_text;
using rovigo::test::run_rovigo;
using rovigo::test::TemporaryFolder;
using ::testing::HasSubstr;
using Json = nlohmann::json;

TEST(Dock, DocksReportsAndSaysTheSameTwice) {
  const TemporaryFolder folder;
  const std::vector<std::string> words{"dock",    "--world",       "dock",
                                       "--start", "3.2,2.1,-0.05", "--json"};
  auto with_report = words;
  with_report.insert(with_report.end(), {"--report", folder / "report"});
  const auto one = run_rovigo(with_report), two = run_rovigo(words);
  ASSERT_EQ(one.exit_code, 0) << one.out << one.err;
  EXPECT_EQ(one.out, two.out);
  const Json result = Json::parse(one.out);
  EXPECT_EQ(result["status"], "ok");
  EXPECT_EQ(result["marker"], 7);
  EXPECT_LE(result["final_position_error_m"], 0.02);
  EXPECT_LE(result["final_heading_error_rad"], 0.035);
  EXPECT_EQ(result["collisions"], 0);
  EXPECT_THAT(read_text(folder / "report/index.html"), HasSubstr("Docking at marker 7"));
  EXPECT_GT(std::filesystem::file_size(folder / "report/map.png"), 1000U);
}

TEST(Dock, SaysWhenTheMarkerIsNotInView) {
  const auto run = run_rovigo({"dock", "--world", "dock", "--start", "3,2,3.1", "--set",
                               "control.pose_patience_s=1", "--json"});
  EXPECT_EQ(run.exit_code, 1) << run.err;
  const Json result = Json::parse(run.out);
  EXPECT_EQ(result["status"], "marker_not_seen");
  EXPECT_EQ(result["code"], 104);
}

TEST(Dock, RefusesAWorldWithoutMarkersAndAMarkerThatIsNotThere) {
  const auto lab = run_rovigo({"dock", "--world", "lab"});
  EXPECT_EQ(lab.exit_code, 2);
  EXPECT_THAT(lab.err, HasSubstr("shows no marker"));
  const auto other = run_rovigo({"dock", "--world", "dock", "--marker", "8"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, HasSubstr("shows marker 7"));
  const auto range = run_rovigo({"dock", "--world", "dock", "--set", "docking.marker_side_m=0"});
  EXPECT_EQ(range.exit_code, 2);
  EXPECT_THAT(range.err, HasSubstr("docking.marker_side_m"));
}

}  // namespace
