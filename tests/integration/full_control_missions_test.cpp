// The long run: a thousand random missions on poor poses, each of which must arrive.
#include <gtest/gtest.h>

#include "tests/unit/control/mission_check.h"

namespace rovigo::control::testing {
namespace {

class Missions : public ::testing::TestWithParam<int> {};

TEST_P(Missions, AllArrive) {
  constexpr int kBatch = 100;
  for (int i = 0; i < kBatch; ++i) {
    expect_mission_done(static_cast<std::uint64_t>(1000 + GetParam() * kBatch + i));
  }
}

INSTANTIATE_TEST_SUITE_P(Batch, Missions, ::testing::Range(0, 10));

}  // namespace
}  // namespace rovigo::control::testing
