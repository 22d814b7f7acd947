// `rovigo tune` and `rovigo identify` as users call them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/support/run_rovigo.h"

namespace {

using rovigo::test::read_text;
using rovigo::test::run_rovigo;
using rovigo::test::TemporaryFolder;
using rovigo::test::write_text;
using ::testing::HasSubstr;
using Json = nlohmann::json;

const char* const kSuite =
    "trajectories: {slalom: {shape: slalom, length_m: 2, wave_m: 2, curvature_1_m: 1}}\n"
    "groups: [{name: g}]\n";

TEST(Tune, MakesPoorGainsBetterAndGivesTheSameBytesForAnyThreads) {
  const TemporaryFolder folder;
  write_text(folder / "suite.yaml", kSuite);
  const auto tune = [&](const std::string& threads, const std::string& out) {
    return run_rovigo({"tune", folder / "suite.yaml", "--evaluations", "12", "--set",
                       "control.heading_kp_1_s=1", "--set", "control.speed_kp_1_s=0.5", "--threads",
                       threads, "--out", folder / out, "--json"});
  };
  const auto one = tune("1", "one.yaml"), two = tune("2", "two.yaml");
  ASSERT_EQ(one.exit_code, 0) << one.err;
  EXPECT_EQ(one.out, two.out);
  EXPECT_EQ(read_text(folder / "one.yaml"), read_text(folder / "two.yaml"));
  const Json result = Json::parse(one.out);
  EXPECT_LT(result["after"]["cost_mm"], 0.95 * result["before"]["cost_mm"].get<double>());

  const auto check = run_rovigo({"config", "--check", folder / "one.yaml"});
  EXPECT_EQ(check.exit_code, 0) << check.err;
  // The file says what was measured: taken as the start, it costs what it was said to cost.
  const auto again = run_rovigo({"tune", folder / "suite.yaml", "--evaluations", "1", "--config",
                                 folder / "one.yaml", "--json"});
  EXPECT_EQ(Json::parse(again.out)["before"]["cost_mm"], result["after"]["cost_mm"]);
  EXPECT_EQ(Json::parse(again.out)["after"]["cost_mm"], result["after"]["cost_mm"]);
}

TEST(Tune, ByRelayFillsInTheThesissTable) {
  const TemporaryFolder folder;
  write_text(folder / "suite.yaml", kSuite);
  const auto run = run_rovigo(
      {"tune", folder / "suite.yaml", "--method", "relay", "--scenario", "late_poses", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json heading = Json::parse(run.out)["relay"]["heading"];
  const double gain = heading["ultimate_gain_1_s"], period = heading["ultimate_period_s"];
  EXPECT_NEAR(heading["pi"]["kp"].get<double>(), gain / 2.2, 1e-9);
  EXPECT_NEAR(heading["pi"]["ki"].get<double>(), gain / 2.2 / (period / 1.2), 1e-9);
  EXPECT_NEAR(Json::parse(run.out)["settings"]["control.heading_kp_1_s"].get<double>(), gain / 2.2,
              1e-3);
}

TEST(Tune, RefusesASuiteThatOnlyDrivesTheThesissController) {
  const TemporaryFolder folder;
  write_text(folder / "suite.yaml",
             "trajectories: {a: {}}\ngroups: [{name: g, controllers: reference}]\n");
  const auto run = run_rovigo({"tune", folder / "suite.yaml"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("no group uses the controller `default`"));
}

TEST(Identify, ReadsALogAndWritesAPage) {
  const TemporaryFolder folder;
  std::string log = "time_s,setpoint,response\n";
  double y = 0.0;
  for (int i = 0; i < 400; ++i) {
    const double u = (i / 50) % 2;
    log += std::to_string(i * 0.02) + "," + std::to_string(u) + "," + std::to_string(y) + "\n";
    y += (0.8 * u - y) * (1.0 - std::exp(-0.02 / 0.25));  // gain 0.8, time constant 0.25 s
  }
  write_text(folder / "log.csv", log);
  const auto run =
      run_rovigo({"identify", folder / "log.csv", "--report", folder / "fit.html", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json model = Json::parse(run.out)["models"][0];
  EXPECT_NEAR(model["gain"].get<double>(), 0.8, 1e-3);
  EXPECT_NEAR(model["time_constant_s"].get<double>(), 0.25, 1e-3);
  EXPECT_LT(model["dead_time_s"].get<double>(), 1e-3);
  EXPECT_THAT(read_text(folder / "fit.html"), HasSubstr("<svg"));
}

TEST(Identify, SaysWhatIsMissingInALogThatSaysNothing) {
  const TemporaryFolder folder;
  std::string log = "time_s,setpoint,response\n";
  for (int i = 0; i < 100; ++i) log += std::to_string(i) + ",1,1\n";
  write_text(folder / "log.csv", log);
  const auto run = run_rovigo({"identify", folder / "log.csv"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.out, HasSubstr("never changes"));
}

}  // namespace
