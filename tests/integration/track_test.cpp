// `rovigo track` as users call it: exact, and the same however it is spread.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
