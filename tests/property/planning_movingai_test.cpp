// Point queries on the MovingAI benchmark: the published optimal lengths.

#include "tests/support/public_maps.h"

namespace rovigo::planning {
namespace {

class MovingAi : public testing::TestWithParam<const char*> {};

TEST_P(MovingAi, EveryTwentiethProblemHasThePublishedLength) {
  test::expect_published_lengths(GetParam(), 20);
}

INSTANTIATE_TEST_SUITE_P(Data, MovingAi, test::movingai_maps(), test::map_test_name);

}  // namespace
}  // namespace rovigo::planning
