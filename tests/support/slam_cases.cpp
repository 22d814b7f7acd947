#include "tests/support/slam_cases.h"

#include <cmath>
#include <cstdio>

#include "maps/error.h"

namespace rovigo::test {

namespace {

using S = SlamScore;
using Sense = Check::Sense;

// One drive in the lab, two in offices that nobody drew: nothing can be tuned to one world.
std::vector<Drive> in_three_worlds(const std::string& lab_route, const std::string& random_route,
                                   const std::string& scenario, std::uint64_t seed) {
  std::vector<Drive> drives{{"lab", lab_route, scenario, seed}};
  for (std::uint64_t s = seed + 1; s <= seed + 2; ++s) {
    const std::string number = std::to_string(s);
    drives.push_back({"random:" + number, random_route + ":" + number, scenario, s});
  }
  return drives;
}

Check at_most(S::Value S::*figure, double median, std::optional<double> worst = std::nullopt) {
  return {figure, Sense::kAtMost, median, worst};
}

Check at_least(S::Value S::*figure, double median) { return {figure, Sense::kAtLeast, median}; }

/// Asked of every recording with wheels and IMU.
std::vector<Check> rover_checks(std::vector<Check> own) {
  constexpr double kAll = 0.999;  // "100%"
  own.push_back(at_least(&S::coverage, kAll));
  own.push_back(at_most(&S::wrong_frames, 0, 0));
  // Honest is 1. One drive has one drift, which may be two or three sigmas by chance.
  for (const auto nees : {&S::nees_position, &S::nees_heading}) {
    own.push_back(at_most(nees, 9.0));
    own.push_back({nees, Sense::kAtMost, 3.0, 9.0, false});
  }
  own.push_back({&S::cpu_ms, Sense::kAtMost, 24.0, std::nullopt, false});
  own.push_back({&S::peak_mb, Sense::kAtMost, 300.0, 300.0, false});
  own.push_back({&S::first_pose_ms, Sense::kAtMost, 50.0, std::nullopt, false});
  return own;
}

std::vector<Check> office_checks() {
  return rover_checks({at_most(&S::ate_m, 0.015, 0.025), at_least(&S::precision_1, 0.95),
                       at_least(&S::recall_1, 0.80), at_least(&S::recall_2, 0.90),
                       at_least(&S::free_iou_in_view, 0.95)});
}

const std::string kQuick = "tests/support/slam_quick/";

std::vector<SlamCase> make_cases() {
  std::vector<SlamCase> cases;
  cases.push_back({"office_loop",
                   {{"lab", "lab_short", "default", 3}},
                   {{"lab", "office_loop", "default", 1},
                    {"lab", "office_loop", "default", 2},
                    {"lab", "office_loop", "default", 3}},
                   office_checks()});
  cases.push_back({"random_offices",
                   {},
                   {{"random:41", "loop:30:41", "default", 41},
                    {"random:42", "loop:30:42", "default", 42},
                    {"random:43", "loop:30:43", "default", 43}},
                   office_checks()});
  cases.push_back({"plain_corridor",
                   {{"corridor", kQuick + "corridor.yaml", "default", 4}},
                   {{"corridor", "corridor_out_and_back", "default", 1},
                    {"corridor", "corridor_out_and_back", "default", 2},
                    {"corridor", "corridor_out_and_back", "default", 3}},
                   rover_checks({at_most(&S::ate_m, 0.04), at_most(&S::length_error, 0.005)})});
  cases.push_back({"light_steps",
                   {{"lab", "lab_short", kQuick + "light_steps.yaml", 3}},
                   in_three_worlds("office_loop", "loop:30", "light_steps", 1),
                   rover_checks({at_most(&S::ate_m, 0.020), at_most(&S::steady_ratio, 1.3)})});
  cases.push_back({"blackouts",
                   {{"lab", "lab_short", kQuick + "blackout_covered.yaml", 7},
                    {"lab", "lab_short", kQuick + "blackout_missing.yaml", 5}},
                   in_three_worlds("office_loop", "loop:30", "blackouts", 11),
                   rover_checks({at_most(&S::ate_m, 0.030), at_most(&S::not_ok_after_s, 0.5, 0.5),
                                 at_most(&S::ok_after_s, 2.0, 2.0)})});
  cases.push_back(
      {"kidnap",
       {{"lab", "lab_short", kQuick + "kidnap.yaml", 6}},
       in_three_worlds("office_loop", "loop:30", "kidnap", 21),
       rover_checks({at_most(&S::ate_ok_m, 0.030), at_most(&S::ate_m, 0.030, 0.030),
                     at_most(&S::lost_after_s, 1.0, 1.0), at_most(&S::right_after_s, 3.0, 3.0)})});
  cases.push_back({"turns_with_blur",
                   {{"random:8", "turns:6:8", "blur", 8}},
                   in_three_worlds("lab_turns", "turns:20", "blur", 31),
                   rover_checks({at_most(&S::ate_m, 0.015)})});
  cases.push_back({"people",
                   {{"lab", "lab_short", "people", 9}},
                   in_three_worlds("office_loop", "loop:30", "people", 51),
                   rover_checks({at_most(&S::ate_m, 0.020), at_most(&S::ghost_cells, 0, 0)})});
  // No figure of its own in the table: those of the office loop hold on any floor.
  cases.push_back(
      {"glossy_floor",
       {{"random:10", "loop:8:10", "glossy_floor", 10}},
       in_three_worlds("office_loop", "loop:30", "glossy_floor", 61),
       rover_checks({at_most(&S::ate_m, 0.015, 0.025), at_least(&S::precision_1, 0.95),
                     at_least(&S::free_iou_in_view, 0.95), at_most(&S::ghost_cells, 0, 0)})});
  cases.push_back(
      {"low_table",
       {},
       {{"random:71", "loop:20:71", "default", 71},
        {"random:72", "loop:20:72", "default", 72},
        {"random:73", "loop:20:73", "default", 73}},
       rover_checks({at_most(&S::ate_m, 0.015, 0.025), at_least(&S::low_table_share, 0.95),
                     at_most(&S::low_table_free, 0, 0)})});
  // An hour through the same rooms, two frames a second. "Flat": a tenth of the memory allowed.
  cases.push_back({"one_hour",
                   {},
                   {{"lab", "loop:60:1:20", "default", 81, 2.0}},
                   rover_checks({at_most(&S::ate_m, 0.025),
                                 {&S::memory_growth_mb, Sense::kAtMost, 30.0, std::nullopt, false},
                                 {&S::cpu_growth, Sense::kAtMost, 1.1, std::nullopt, false}})});
  cases.push_back({"tum_freiburg1_rpy_half",
                   {},
                   {},
                   {at_most(&S::ate_m, 0.020),
                    at_least(&S::coverage, 0.999),
                    {&S::cpu_ms, Sense::kAtMost, 24.0, std::nullopt, false}},
                   "recordings/tum_freiburg1_rpy_half"});
  return cases;
}

}  // namespace

const std::vector<SlamCase>& slam_cases() {
  static const std::vector<SlamCase> cases = make_cases();
  return cases;
}

const SlamCase& slam_case(const std::string& name) {
  std::string known;
  for (const SlamCase& c : slam_cases()) {
    if (c.name == name) return c;
    known += " " + c.name;
  }
  throw maps::InputError("no case \"" + name + "\"; cases are" + known);
}

bool holds(const Check& check, double value, double bound) {
  return check.sense == Sense::kAtMost ? value <= bound : value >= bound;
}

const Figure& figure_of(const Check& check) {
  for (const Figure& f : all_figures()) {
    if (f.value == check.figure) return f;
  }
  throw std::logic_error("a check of a figure that is in no list");
}

std::string figure_text(const Figure& figure, const SlamScore::Value& value) {
  if (!value) return "-";
  if (std::isinf(*value)) return "never";
  char text[40];
  std::snprintf(text, sizeof text, "%.*f", figure.digits, *value);
  return text;
}

}  // namespace rovigo::test
