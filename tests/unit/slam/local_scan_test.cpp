#include "slam/local_scan.h"

#include <gtest/gtest.h>

namespace rovigo::slam {
namespace {

std::vector<ScanPoint> wall_ahead() {
  std::vector<ScanPoint> out;
  for (int i = 0; i < 100; ++i) out.push_back({{2.0, -1.0 + 0.02 * i}, 0.01});
  return out;
}

TEST(LocalScan, KeepsOnePointForEveryTenCentimetres) {
  LocalScan scan;
  EXPECT_TRUE(scan.add(0.0, {0, 0, 0}, wall_ahead()));
  EXPECT_NEAR(static_cast<double>(scan.points({0, 0, 0}).size()), 20.0, 1.0);
}

TEST(LocalScan, ARoverThatStandsStillAddsNothing) {
  LocalScan scan;
  EXPECT_TRUE(scan.add(0.0, {0, 0, 0}, wall_ahead()));
  EXPECT_FALSE(scan.add(1.0, {0.05, 0, 0.02}, wall_ahead()));
  EXPECT_TRUE(scan.add(2.0, {0.05, 0, 0.5}, wall_ahead()));
}

TEST(LocalScan, PointsFollowTheRoverByOdometry) {
  LocalScan scan;
  scan.add(0.0, {0, 0, 0}, {{{2.0, 0.0}, 0.01}});
  const auto points = scan.points({1.0, 0.0, maps::kPi / 2});
  ASSERT_EQ(points.size(), 1u);
  EXPECT_NEAR(points[0].base_point.x, 0.0, 1e-9);
  EXPECT_NEAR(points[0].base_point.y, -1.0, 1e-9);
}

TEST(LocalScan, TheSurerOfTwoPointsStays) {
  LocalScan scan;
  scan.add(0.0, {0, 0, 0}, {{{2.01, 0.01}, 0.05}});
  scan.add(0.1, {0, 0, 0.3}, {{maps::transform({0, 0, -0.3}, {2.05, 0.05}), 0.01}});
  const auto points = scan.points({0, 0, 0});
  ASSERT_EQ(points.size(), 1u);
  EXPECT_DOUBLE_EQ(points[0].sigma_m, 0.01);
}

TEST(LocalScan, WhatWasSeenLongAgoIsForgotten) {
  LocalScan scan;
  scan.add(0.0, {0, 0, 0}, {{{2.0, 0.0}, 0.01}});
  scan.add(60.0, {0, 0, 1.0}, {{{3.0, 0.0}, 0.01}});
  EXPECT_EQ(scan.points({0, 0, 0}).size(), 1u);
}

TEST(LocalScan, AViewThatJumpsIsTakenThoughTheWheelsStood) {
  LocalScan scan;
  scan.add(0.0, {0, 0, 0}, {{{2.0, 0.0}, 0.01}});
  EXPECT_TRUE(scan.add(1.0, {0, 0, 0}, {{{3.0, 0.0}, 0.01}}, true));
  scan.forget_before(0.5);
  const auto points = scan.points({0, 0, 0});
  ASSERT_EQ(points.size(), 1u);
  EXPECT_DOUBLE_EQ(points[0].base_point.x, 3.0);
}

}  // namespace
}  // namespace rovigo::slam
