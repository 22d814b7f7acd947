// Point queries on the MovingAI benchmark: the published optimal lengths, all of them.

#include "tests/support/public_maps.h"

namespace rovigo::planning {
namespace {

class FullMovingAi : public testing::TestWithParam<const char*> {};

TEST_P(FullMovingAi, EveryProblemHasThePublishedLength) {
  test::expect_published_lengths(GetParam(), 1);
}

INSTANTIATE_TEST_SUITE_P(Data, FullMovingAi, test::movingai_maps(), test::map_test_name);

}  // namespace
}  // namespace rovigo::planning
