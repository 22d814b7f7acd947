#include <gtest/gtest.h>

#include "slam/keyframe_scans.h"

namespace rovigo::slam {
namespace {

TEST(EstimateFloorHeight, TheLowestGatheringOfPointsIsTheFloor) {
  std::vector<float> heights;
  for (int i = 0; i < 300; ++i) heights.push_back(-0.62f);  // floor
  for (int i = 0; i < 500; ++i) heights.push_back(0.10f);   // a desk top
  for (int i = 0; i < 400; ++i) heights.push_back(-0.5f + 0.004f * static_cast<float>(i));
  heights.push_back(-2.0f);  // a stray return below the floor
  EXPECT_NEAR(estimate_floor_height(heights), -0.62, 0.03);
}

TEST(EstimateFloorHeight, WithoutPointsTheFloorIsTheMapsZero) {
  EXPECT_EQ(estimate_floor_height({}), 0.0);
}

}  // namespace
}  // namespace rovigo::slam
