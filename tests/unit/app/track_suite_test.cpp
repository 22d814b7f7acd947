#include "app/track/suite.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/resources.h"
#include "maps/error.h"

namespace rovigo::app {
namespace {

using ::testing::HasSubstr;

constexpr const char* kTwoShapes = "trajectories: {line: {}, ring: {shape: circle}}\n";

/// The message that a bad suite is refused with.
std::string refusal_of(const std::string& yaml) {
  try {
    parse_suite(yaml, "s.yaml");
  } catch (const maps::InputError& e) {
    return e.what();
  }
  return "taken";
}

TEST(TrackSuite, AGroupIsEveryTrajectoryWithEveryControllerSpeedAndSeed) {
  const TrackSuite suite =
      parse_suite(std::string(kTwoShapes) +
                      "groups: [{name: g, controllers: [default, reference], speeds_m_s: [0.1, "
                      "0.4], seeds: [1, 2, 10]}]",
                  "s.yaml");
  const auto cases = cases_of(suite);
  ASSERT_EQ(cases.size(), 2U * 2U * 2U * 3U);
  EXPECT_EQ(cases[0].name, "g/line/default/0.100");
  EXPECT_EQ(cases[2].seed, 10U);  // by number, not by letter
  for (std::size_t i = 1; i < cases.size(); ++i) {
    EXPECT_TRUE(cases[i - 1].name < cases[i].name ||
                (cases[i - 1].name == cases[i].name && cases[i - 1].seed < cases[i].seed));
  }
}

TEST(TrackSuite, SeedsMayBeARange) {
  const auto seeds_of = [](const std::string& seeds) {
    return parse_suite(std::string(kTwoShapes) + "groups: [{name: g, seeds: " + seeds + "}]",
                       "s.yaml")
        .groups[0]
        .seeds;
  };
  EXPECT_EQ(seeds_of("{from: 3, to: 5}"), (std::vector<std::uint64_t>{3, 4, 5}));
  EXPECT_EQ(seeds_of("{from: 7, to: 7}"), (std::vector<std::uint64_t>{7}));
  const std::string shapes = kTwoShapes;
  EXPECT_THAT(refusal_of(shapes + "groups: [{name: a, seeds: {from: 5, to: 3}}]"),
              HasSubstr("1 to 100000 seeds"));
  EXPECT_THAT(refusal_of(shapes + "groups: [{name: a, seeds: {from: 5}}]"),
              HasSubstr("needs from and to"));
  EXPECT_THAT(
      refusal_of(shapes + "groups: [{name: a, seeds: {from: 0, to: 18446744073709551615}}]"),
      HasSubstr("1 to 100000 seeds"));
}

TEST(TrackSuite, WhatIsLeftOutKeepsItsDefault) {
  const TrackSuite suite = parse_suite(std::string(kTwoShapes) + "groups: [{name: g}]", "a/b.yaml");
  EXPECT_EQ(suite.name, "b");
  EXPECT_EQ(suite.groups[0].pose, "perturbed");
  EXPECT_EQ(suite.groups[0].trajectories.size(), 2U);
  EXPECT_EQ(suite.groups[0].limits.cross_track_rms_m, TrackLimits::kNone);
}

TEST(TrackSuite, EveryMistakeIsNamedWithItsLineAndTheWayOut) {
  const std::string shapes = kTwoShapes;
  EXPECT_THAT(refusal_of("groups: []"), HasSubstr("`trajectories:` must name"));
  EXPECT_THAT(refusal_of(shapes), HasSubstr("`groups:` must list"));
  EXPECT_THAT(refusal_of(shapes + "groups: [{}]"), HasSubstr("s.yaml:2: a group needs"));
  EXPECT_THAT(refusal_of(shapes + "groups: [{name: a/b}]"), HasSubstr("letters, digits"));
  EXPECT_THAT(refusal_of(shapes + "groups: [{name: a}, {name: a}]"), HasSubstr("appears twice"));
  EXPECT_THAT(refusal_of(shapes + "groups: [{name: a, trajectories: [rin]}]"),
              HasSubstr("nearest is \"ring\""));
  EXPECT_THAT(refusal_of(shapes + "groups: [{name: a, controllers: fuzzy}]"),
              HasSubstr("there is no controller \"fuzzy\""));
  EXPECT_THAT(refusal_of(shapes + "groups: [{name: a, speeds_m_s: 2}]"), HasSubstr("[0.05, 0.8]"));
  EXPECT_THAT(refusal_of(shapes + "groups: [{name: a, speeds_m_s: .nan}]"), HasSubstr("finite"));
  EXPECT_THAT(refusal_of(shapes + "groups: [{name: a, seeds: -1}]"), HasSubstr("whole numbers"));
  EXPECT_THAT(refusal_of(shapes + "groups: [{name: a, seeds: [1, 1]}]"), HasSubstr("twice"));
  EXPECT_THAT(refusal_of(shapes + "groups: [{name: a, limits: {goal: 1}}]"),
              HasSubstr("nearest valid key is \"goal_m\""));
  EXPECT_THAT(refusal_of("trajectories: {a: {length_m: 500}}\ngroups: [{name: a}]"),
              HasSubstr("s.yaml:1"));
  EXPECT_THAT(refusal_of("trajectories: {a: {shape: heart}}\ngroups: [{name: a}]"),
              HasSubstr("heart"));
  EXPECT_THAT(refusal_of("[1, 2"), HasSubstr("not YAML"));
}

TEST(TrackSuite, ASuiteOfMillionsOfRunsIsRefused) {
  std::string seeds;
  for (int i = 0; i < 1000; ++i) seeds += (i ? "," : "") + std::to_string(i);
  std::string speeds;
  for (int i = 0; i < 200; ++i) speeds += (i ? "," : "") + std::to_string(0.1 + 0.001 * i);
  EXPECT_THAT(refusal_of(std::string(kTwoShapes) + "groups: [{name: a, seeds: [" + seeds +
                         "], speeds_m_s: [" + speeds + "]}]"),
              HasSubstr("more than 100000 runs"));
}

TEST(TrackSuite, TheSuitesThatComeAlongAreWhole) {
  EXPECT_FALSE(cases_of(load_suite(find_suite("default"))).empty());
  EXPECT_THROW(find_suite("no-such-suite"), maps::InputError);
}

}  // namespace
}  // namespace rovigo::app
