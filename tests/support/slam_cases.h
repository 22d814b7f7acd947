#pragma once
// The hard cases of SLAM: one list, read by the acceptance tests and by the table of `./run bench`.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/slam_score.h"

namespace rovigo::test {

/// What `rovigo record` is asked for. Names with a slash are paths from the source folder.
struct Drive {
  std::string world;
  std::string route;
  std::string scenario = "default";
  std::uint64_t seed = 1;
  double fps = 15.0;
};

/// A figure and what is asked of it. `median` holds for the median over the drives and for a drive
/// alone; `worst` for every one.
struct Check {
  enum class Sense { kAtMost, kAtLeast };
  SlamScore::Value SlamScore::*figure;
  Sense sense;
  double median;
  std::optional<double> worst = std::nullopt;
  bool tests_too = true;  ///< false: time and memory, for the bench only
};

struct SlamCase {
  std::string name;
  std::vector<Drive> quick;  ///< short, for the tests of every day; may be none
  std::vector<Drive> full;   ///< as issue 3 asks; the table's
  std::vector<Check> checks;
  /// Of a recording that nobody here made, below test_data(): used instead of drives.
  std::optional<std::filesystem::path> recording = std::nullopt;
};

const std::vector<SlamCase>& slam_cases();
/// Throws InputError naming the cases there are.
const SlamCase& slam_case(const std::string& name);

bool holds(const Check& check, double value, double bound);
/// "ate_m", "0.0150" and the like.
const Figure& figure_of(const Check& check);
std::string figure_text(const Figure& figure, const SlamScore::Value& value);

}  // namespace rovigo::test
