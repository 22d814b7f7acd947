#pragma once
// The results of a case as Markdown: the asked figure beside the measured one.

#include <string>
#include <vector>

#include "tests/support/slam_cases.h"

namespace rovigo::slam_table {

struct CaseResult {
  const test::SlamCase* of = nullptr;
  std::vector<test::SlamScore> scores;  ///< of the drives that could be recorded and mapped
  std::vector<std::string> failures;
};

struct Summary {
  double median = 0.0;
  double worst = 0.0;
};
/// Of a figure over the drives; `at_least`: small is bad. None when no drive has it.
std::optional<Summary> summary_of(const std::vector<test::SlamScore>& scores,
                                  test::SlamScore::Value test::SlamScore::*figure, bool at_least);

/// One line a case: median (worst) of every figure that all cases have.
std::string overview(const std::vector<CaseResult>& results);
/// One line a bound: asked, median, worst, pass or miss.
std::string verdicts(const std::vector<CaseResult>& results);

}  // namespace rovigo::slam_table
