// Scenario files: strict, and the shipped ones say what they should.

#include "sim/scenario.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "maps/error.h"

namespace rovigo::sim {
namespace {

std::string refusal_of(const std::string& yaml) {
  try {
    parse_scenario(yaml, "s.yaml");
  } catch (const maps::InputError& e) {
    return e.what();
  }
  return "accepted";
}

/// Every value of a config, in declaration order, as text.
class Collect final : public maps::SettingsVisitor {
 public:
  void real(const maps::SettingInfo& i, double& v) override { add(i, std::to_string(v)); }
  void integer(const maps::SettingInfo& i, int& v) override { add(i, std::to_string(v)); }
  void flag(const maps::SettingInfo& i, bool& v) override { add(i, v ? "true" : "false"); }
  void text(const maps::SettingInfo& i, std::string& v) override { add(i, v); }
  std::vector<std::string> all;

 private:
  void add(const maps::SettingInfo& i, const std::string& v) { all.push_back(i.name + "=" + v); }
};

std::vector<std::string> values_of(Scenario s) {
  Collect c;
  s.camera.describe(c);
  s.imu.describe(c);
  s.wheels.describe(c);
  s.motor.describe(c);
  s.commands.describe(c);
  s.payload.describe(c);
  s.slope.describe(c);
  s.grip.describe(c);
  s.pose.describe(c);
  return c.all;
}

const std::string kFolder = ROVIGO_SOURCE_DIR "/sim/scenarios/";

TEST(Scenario, TheDefaultFileSaysWhatTheDefaultsAre) {
  const Scenario file = load_scenario(kFolder + "default.yaml");
  EXPECT_EQ(file.name, "default");
  EXPECT_EQ(values_of(file), values_of(Scenario{}));
  EXPECT_TRUE(file.light_steps.empty() && file.blackouts.empty() && file.kidnaps.empty());
  EXPECT_TRUE(file.faults.empty());
}

TEST(Scenario, TheDefaultFileNamesEveryKey) {
  const std::string text = [] {
    std::ifstream in(kFolder + "default.yaml");
    return std::string(std::istreambuf_iterator<char>(in), {});
  }();
  for (const auto& value : values_of(Scenario{})) {
    EXPECT_THAT(text, testing::HasSubstr(value.substr(0, value.find('=')) + ":"));
  }
  Fault fault;
  Collect keys;
  fault.describe(keys);
  for (const auto& key : keys.all) {
    EXPECT_THAT(text, testing::HasSubstr(key.substr(0, key.find('='))));
  }
}

TEST(Scenario, TheIdealFileIsTheIdealScenario) {
  EXPECT_EQ(values_of(load_scenario(kFolder + "ideal.yaml")), values_of(ideal_scenario()));
}

TEST(Scenario, EveryShippedFileLoadsAndIsNamedAsItsFile) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kFolder)) {
    EXPECT_EQ(load_scenario(entry.path()).name, entry.path().stem().string());
    ++count;
  }
  EXPECT_GE(count, 6);
}

TEST(Scenario, TheDefaultsLieInsideTheirOwnRanges) {
  const Scenario s;
  EXPECT_NO_THROW(maps::validate(s.camera));
  EXPECT_NO_THROW(maps::validate(s.imu));
  EXPECT_NO_THROW(maps::validate(s.wheels));
  EXPECT_NO_THROW(maps::validate(s.motor));
  EXPECT_NO_THROW(maps::validate(s.commands));
  EXPECT_NO_THROW(maps::validate(s.payload));
  EXPECT_NO_THROW(maps::validate(s.slope));
  EXPECT_NO_THROW(maps::validate(s.grip));
  EXPECT_NO_THROW(maps::validate(s.pose));
}

TEST(Scenario, AnEmptyFileIsTheDefault) {
  EXPECT_EQ(values_of(parse_scenario("", "quiet.yaml")), values_of(Scenario{}));
  EXPECT_EQ(parse_scenario("", "quiet.yaml").name, "quiet");
}

TEST(Scenario, EventsAreReadInOrder) {
  const Scenario s = parse_scenario(
      "light_steps: [{time_s: 3, factor: 0.35}, {time_s: 6, factor: 1.8}]\n"
      "blackouts:\n  - {start_s: 2, duration_s: 3, kind: covered}\n"
      "kidnaps:\n  - {time_s: 9, forward_m: 4, turn_deg: 120}\n"
      "faults:\n  - {kind: poses_late, start_s: 4, duration_s: 2, delay_s: 1.5}\n"
      "  - {kind: manual_takeover, start_s: 8, within_s: 2}\n",
      "s.yaml");
  ASSERT_EQ(s.faults.size(), 2U);
  EXPECT_EQ(s.faults[0].delay_s, 1.5);
  EXPECT_EQ(s.faults[1].within_s, 2.0);
  EXPECT_EQ(s.faults[1].duration_s, Fault::kForGood) << "left out: for good";
  ASSERT_EQ(s.light_steps.size(), 2U);
  EXPECT_EQ(s.light_steps[1].factor, 1.8);
  ASSERT_EQ(s.blackouts.size(), 1U);
  EXPECT_EQ(s.blackouts[0].kind, "covered");
  ASSERT_EQ(s.kidnaps.size(), 1U);
  EXPECT_EQ(s.kidnaps[0].turn_deg, 120.0);
}

TEST(Scenario, BadFilesAreRefusedWithLineValueAndLimit) {
  using testing::HasSubstr;
  EXPECT_THAT(refusal_of("camera:\n  depth_sigma: 0.1\n"),
              HasSubstr("s.yaml:2: unknown key \"depth_sigma\"; the nearest valid key is "
                        "\"depth_sigma_per_m\""));
  EXPECT_THAT(refusal_of("camra: {}\n"), HasSubstr("nearest valid key is \"camera\""));
  EXPECT_THAT(refusal_of("imu:\n  rate_hz: 1e6\n"),
              HasSubstr("s.yaml:2: rate_hz = 1e+06 is outside [1, 240]"));
  EXPECT_THAT(refusal_of("imu:\n  rate_hz: fast\n"), HasSubstr("\"fast\" is not a finite number"));
  EXPECT_THAT(refusal_of("imu:\n  rate_hz: .nan\n"), HasSubstr("is not a finite number"));
  EXPECT_THAT(refusal_of("wheels: {ticks_per_turn: 1.5}"), HasSubstr("is not a whole number"));
  EXPECT_THAT(refusal_of("camera: {auto_exposure: 3}"), HasSubstr("neither true nor false"));
  EXPECT_THAT(refusal_of("blackouts: [{kind: foggy}]"),
              HasSubstr("\"foggy\" is not one of missing, covered"));
  EXPECT_THAT(refusal_of("blackouts: 3"), HasSubstr("must be a list"));
  EXPECT_THAT(refusal_of("faults: [{kind: gremlins}]"),
              HasSubstr("\"gremlins\" is not one of poses_stall, poses_late"));
  EXPECT_THAT(refusal_of("faults:\n  - {kind: battery_low, voltage_share: 2}"),
              HasSubstr("s.yaml:2: voltage_share = 2 is outside [0, 1]"));
  EXPECT_THAT(refusal_of("slope:\n  angle_deg: 45\n"),
              HasSubstr("s.yaml:2: angle_deg = 45 is outside [0, 10]"));
  EXPECT_THAT(refusal_of("commands: {drop_share: 1}"), HasSubstr("outside [0, 0.95]"));
  EXPECT_THAT(refusal_of("payload: {mass: 3}"), HasSubstr("nearest valid key is \"mass_kg\""));
  EXPECT_THAT(refusal_of("imu: 3"), HasSubstr("s.yaml:1"));
  EXPECT_THAT(refusal_of("imu: {rate_hz: 3, rate_hz: 4}"), HasSubstr("appears twice"));
  EXPECT_THAT(refusal_of("camera: {min_range_m: 4, max_range_m: 3}"),
              HasSubstr("min_range_m must not exceed max_range_m"));
  EXPECT_THAT(refusal_of("camera: {"), HasSubstr("not YAML"));
  EXPECT_THAT(refusal_of("- 1\n- 2\n"), HasSubstr("s.yaml:1"));
  EXPECT_THROW(load_scenario("/nowhere.yaml"), maps::InputError);
}

}  // namespace
}  // namespace rovigo::sim
