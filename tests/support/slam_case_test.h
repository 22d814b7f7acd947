#pragma once
// The two forms of a case as a test: one short drive, and all of them with their median.

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/run_rovigo.h"
#include "tests/support/slam_case_runner.h"

namespace rovigo::test {

inline std::string sentence(const Check& check, double value, double bound) {
  const Figure& figure = figure_of(check);
  return std::string(figure.name) + " is " + figure_text(figure, value) + ", asked for " +
         (check.sense == Check::Sense::kAtMost ? "at most " : "at least ") +
         figure_text(figure, bound);
}

/// Records and judges; with the ratio to steady light where the case asks for it.
inline SlamScore record_and_score(const SlamCase& c, const Drive& drive) {
  const TemporaryFolder folder;
  SlamScore score = score_drive(record_drive(drive, folder.path(), "drive"));
  if (compares_with_steady_light(c)) {
    const SlamScore other = score_drive(record_drive(steady(drive), folder.path(), "steady"));
    score.steady_ratio = *score.ate_m / *other.ate_m;
  }
  for (const Figure& f : all_figures()) {
    if (score.*f.value) std::printf("%s %s  ", f.name, figure_text(f, score.*f.value).c_str());
  }
  std::printf("\n");
  return score;
}

/// Median and worst of the drives hold the bounds; a figure that no drive gives is a failure.
inline void expect_checks_hold(const SlamCase& c, const std::vector<SlamScore>& scores) {
  for (const Check& check : c.checks) {
    if (!check.tests_too) continue;
    std::vector<double> values;
    for (const SlamScore& s : scores) {
      if (s.*check.figure) values.push_back(*(s.*check.figure));
    }
    if (values.empty()) {
      ADD_FAILURE() << c.name << ": no drive gives " << figure_of(check).name;
      continue;
    }
    std::sort(values.begin(), values.end());
    if (check.sense == Check::Sense::kAtLeast) std::reverse(values.begin(), values.end());
    const double median = values[values.size() / 2];
    EXPECT_TRUE(holds(check, median, check.median))
        << c.name << ": " << sentence(check, median, check.median);
    if (!check.worst) continue;
    EXPECT_TRUE(holds(check, values.back(), *check.worst))
        << c.name << ", worst: " << sentence(check, values.back(), *check.worst);
  }
}

}  // namespace rovigo::test
