// `rovigo track` as users call it: exact, and the same however it is spread.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/support/run_rovigo.h"

namespace rovigo {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// Short drives, two controllers, noise that depends on the seed.
constexpr const char* kSuite = R"(
trajectories:
  line: {length_m: 0.6}
  turn: {shape: turn, length_m: 0.4, angle_deg: 180}
  thesis: {shape: curve, length_m: 1.88, curvature_1_m: 0.8, first_heading_off_deg: 90}
groups:
  - {name: calm, scenario: ideal, pose: truth, trajectories: [line, turn],
     limits: {cross_track_rms_m: 0.005, cross_track_max_m: 0.015, goal_m: 0.01,
              goal_heading_rad: 0.02}}
  - {name: noisy, trajectories: [line, turn], seeds: [1, 2], limits: {cross_track_rms_m: 0.02}}
  - {name: thesis, scenario: ideal, pose: truth, trajectories: thesis, controllers: reference,
     speeds_m_s: 0.25, limits: {min_duration_s: 11.05, max_duration_s: 14.95}}
)";

class Track : public ::testing::Test {
 protected:
  Track() { test::write_text(suite_, kSuite); }
  std::string run(std::vector<std::string> more, int exit_code = 0) const {
    std::vector<std::string> arguments{"track", "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const test::ProcessResult result = test::run_rovigo(arguments);
    EXPECT_EQ(result.exit_code, exit_code) << result.out << result.err;
    return result.out;
  }
  test::TemporaryFolder folder_;
  std::string suite_ = folder_ / "suite.yaml";
};

TEST_F(Track, EveryRunPassesAndTheThesissExperimentTakesItsTime) {
  const json object = json::parse(run({suite_}));
  EXPECT_EQ(object["status"], "ok");
  EXPECT_EQ(object["passed"], 7);
  EXPECT_EQ(object["failed"], 0);
  const json& thesis = object["runs"].back();
  EXPECT_EQ(thesis["name"], "thesis/thesis/reference/0.250");
  EXPECT_NEAR(thesis["path_length_m"].get<double>(), 1.88, 0.02);
  EXPECT_NEAR(thesis["duration_s"].get<double>(), 13.0, 0.15 * 13.0);
}

TEST_F(Track, SameBytesForAnyNumberOfThreadsAndForMergedShards) {
  const std::string whole = run({suite_, "--threads", "1"});
  EXPECT_EQ(run({suite_, "--threads", "4"}), whole);
  std::vector<std::string> merge{"--merge"};
  for (const char* shard : {"2", "1", "3"}) {
    merge.push_back(folder_ / shard);
    test::write_text(merge.back(), run({suite_, "--shard", std::string(shard) + "/3"}));
  }
  EXPECT_EQ(run(merge), whole);
}

std::map<std::string, std::string> files_in(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    files[std::filesystem::relative(entry.path(), folder)] = test::read_text(entry.path());
  }
  return files;
}

TEST_F(Track, TheReportOfMergedShardsIsTheWholesByteForByte) {
  test::write_text(suite_,
                   "trajectories: {line: {length_m: 0.4}}\n"
                   "groups: [{name: g, seeds: [1, 2], controllers: [default, reference],\n"
                   "          limits: {must_reach: false}}]\n");
  run({suite_, "--report", folder_ / "whole"});
  run({suite_, "--shard", "1/2", "--report", folder_ / "one"});
  run({suite_, "--shard", "2/2", "--report", folder_ / "two"});
  run({"--merge", folder_ / "one/track.json", folder_ / "two/track.json", "--report",
       folder_ / "merged"});
  const auto whole = files_in(folder_ / "whole");
  EXPECT_EQ(whole.size(), 4U + 2U * 4U);
  EXPECT_EQ(files_in(folder_ / "merged"), whole);
  const std::string page = whole.at("index.html");
  EXPECT_THAT(page, HasSubstr("Two controllers side by side"));
  EXPECT_EQ(page.find("http"), page.find("http://www.w3.org"));  // nothing is fetched
  std::filesystem::remove(folder_ / "two/drives.json");
  EXPECT_THAT(run({"--merge", folder_ / "one/track.json", folder_ / "two/track.json", "--report",
                   folder_ / "again"},
                  2),
              HasSubstr("drives.json"));
}

TEST_F(Track, MissionsInWorldsOfTheirOwnTouchNothingAndArrive) {
  test::write_text(suite_, R"(
trajectories:
  office: {shape: mission, world: random}
  lab: {shape: mission, world: lab}
groups:
  - {name: missions, scenario: late_poses, trajectories: [office, lab], seeds: {from: 3, to: 6},
     limits: {goal_m: 0.05, goal_heading_rad: 0.1, goal_reversals: 6}}
)");
  const std::string whole = run({suite_, "--threads", "1"});
  EXPECT_EQ(run({suite_, "--threads", "3"}), whole);
  const json object = json::parse(whole);
  EXPECT_EQ(object["passed"], 8);
  EXPECT_NE(object["runs"][0]["path_length_m"], object["runs"][1]["path_length_m"]);
  for (const json& drive : object["runs"]) EXPECT_EQ(drive["collisions"], 0) << drive["name"];
}

TEST_F(Track, ADriveRecordedEarlierIsDrivenAgain) {
  std::string poses = "# t x y z qx qy qz qw\n";  // a quarter circle of 1 m, begun elsewhere
  for (int i = 0; i <= 90; ++i) {
    const double a = i * M_PI / 180.0;
    poses += std::to_string(0.1 * i) + " " + std::to_string(5.0 + std::sin(a)) + " " +
             std::to_string(3.0 - std::cos(a)) + " 0 0 0 " + std::to_string(std::sin(a / 2)) + " " +
             std::to_string(std::cos(a / 2)) + "\n";
  }
  test::write_text(folder_ / "earlier.txt", poses);
  test::write_text(suite_,
                   "trajectories: {again: {shape: recorded, file: earlier.txt}}\n"
                   "groups: [{name: g, scenario: ideal, pose: truth, limits: {cross_track_rms_m: "
                   "0.005, goal_m: 0.01}}]\n");
  const json object = json::parse(run({suite_}));
  EXPECT_EQ(object["passed"], 1);
  EXPECT_NEAR(object["runs"][0]["path_length_m"].get<double>(), M_PI / 2, 0.12);
}

/// True poses tell the least motion at once, so that nothing but the last bit of a turn is left.
TEST_F(Track, WheelsThatStickEndNoDriveOnTruePoses) {
  test::write_text(suite_, R"(
trajectories:
  round: {shape: circle, radius_m: 0.55}
  eight: {shape: eight, radius_m: 0.9}
  slalom: {shape: slalom, length_m: 5, wave_m: 1.6, curvature_1_m: 1.8}
groups:
  - {name: sticky, scenario: sticky_wheels, pose: truth,
     limits: {cross_track_rms_m: 0.01, goal_m: 0.03, goal_heading_rad: 0.05}}
)");
  EXPECT_EQ(json::parse(run({suite_}))["passed"], 3);
}

TEST_F(Track, AgainstAnEarlierResultItTellsWhatIsTheSame) {
  test::write_text(suite_, "trajectories: {line: {length_m: 0.4}}\ngroups: [{name: g}]\n");
  test::write_text(folder_ / "before.json", run({suite_}));
  const json same = json::parse(run({suite_, "--against", folder_ / "before.json"}))["against"];
  ASSERT_EQ(same.size(), 1U);
  EXPECT_EQ(same[0]["what"], "g, default");
  EXPECT_EQ(same[0]["same_to_the_bit"], 1);
  const json other = json::parse(run({suite_, "--set", "control.heading_kp_1_s=1.5", "--against",
                                      folder_ / "before.json"}))["against"];
  EXPECT_EQ(other[0]["drives"], 1);
  EXPECT_EQ(other[0]["same_to_the_bit"], 0);
}

TEST_F(Track, ARunBeyondItsLimitsFailsTheSuiteAndSaysByHowMuch) {
  test::write_text(suite_,
                   "trajectories: {line: {length_m: 0.5}}\n"
                   "groups: [{name: g, limits: {cross_track_max_m: 0.00001}}]\n");
  const json object = json::parse(run({suite_}, 1));
  EXPECT_EQ(object["failed"], 1);
  EXPECT_EQ(object["runs"][0]["status"], "ok");
  EXPECT_THAT(object["runs"][0]["failures"][0].get<std::string>(), HasSubstr("cross_track_max_m"));
}

TEST_F(Track, BadInputEndsWithOneSentence) {
  test::write_text(suite_, "trajectories: {a: {shape: goal, goal_x_m: 900}}\ngroups: [{name: g}]");
  EXPECT_THAT(run({suite_}, 2), HasSubstr("cannot be driven"));
  EXPECT_THAT(run({"--shard", "1/2", "--merge", "x"}, 2), HasSubstr("give one of them"));
  EXPECT_THAT(run({folder_ / "none.yaml"}, 2), HasSubstr("no suite"));
}

}  // namespace
}  // namespace rovigo
