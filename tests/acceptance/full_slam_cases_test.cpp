// SLAM on each hard case at full length: three drives, their median and their worst.

#include <gtest/gtest.h>

#include "tests/support/slam_case_test.h"

namespace {

using namespace rovigo::test;

class SlamCaseAtFullLength : public testing::TestWithParam<std::string> {};

TEST_P(SlamCaseAtFullLength, HoldsItsBounds) {
  const SlamCase& c = slam_case(GetParam());
  std::vector<SlamScore> scores;
  if (c.recording) {
    const auto recording = test_data() / *c.recording;
    if (!std::filesystem::exists(recording)) GTEST_SKIP() << recording << " is not here";
    scores.push_back(score_tum(recording));
  }
  for (const Drive& drive : c.full) scores.push_back(record_and_score(c, drive));
  expect_checks_hold(c, scores);
}

std::vector<std::string> names() {
  std::vector<std::string> out;
  for (const SlamCase& c : slam_cases()) out.push_back(c.name);
  return out;
}

INSTANTIATE_TEST_SUITE_P(Slam, SlamCaseAtFullLength, testing::ValuesIn(names()),
                         [](const auto& named) { return named.param; });

}  // namespace
