#include "slam/scan_search.h"

#include <gtest/gtest.h>

#include "slam/grid_match.h"
#include "slam/local_scan.h"
#include "tests/support/depth_room.h"

namespace rovigo::slam {
namespace {

/// What a rover sees that turns once around at `pose`, in base_link.
std::vector<TPoint2D> turned_scan(const test::DepthRoom& room, const TPose2D& pose,
                                  double turn_rad = 2.0 * maps::kPi) {
  SlamConfig config;
  LocalScan scan;
  TPose2D now = pose;
  for (double turned = 0.0; turned < turn_rad; turned += 0.2) {
    now = {pose.x, pose.y, maps::wrap_angle(pose.phi + turned)};
    scan.add(turned, now,
             obstacle_points(room.depth(now), 0.001, test::DepthRoom::camera(),
                             test::DepthRoom::base_from_camera(), config));
  }
  std::vector<TPoint2D> out;
  for (const ScanPoint& p : scan.points(pose)) out.push_back(p.base_point);
  return out;
}

bool is_at(const ScanPlace& place, const TPose2D& pose) {
  return maps::distance(maps::position_of(place.map_from_scan), maps::position_of(pose)) < 0.15 &&
         std::abs(maps::wrap_angle(place.map_from_scan.phi - pose.phi)) < 0.08;
}

TEST(ScanSearch, FindsWhereTheScanWasTakenAnywhereInTheRoom) {
  const test::DepthRoom room = test::odd_room();
  const ScanSearch search(room.grid());
  for (const TPose2D& pose : {TPose2D{1.0, 1.0, 0.3}, TPose2D{4.0, 2.0, -2.0},
                              TPose2D{5.2, 1.1, 3.0}, TPose2D{3.1, 3.3, 1.4}}) {
    const auto found = search.find(turned_scan(room, pose), 0.5, 0.2, 5);
    ASSERT_FALSE(found.places.empty());
    EXPECT_TRUE(found.complete);
    EXPECT_TRUE(is_at(found.places.front(), pose)) << pose.asString();
    EXPECT_GT(found.places.front().share, 0.9);
  }
}

TEST(ScanSearch, NamesEveryPlaceThatLooksAlike) {
  const test::DepthRoom room = test::square_room();
  const ScanSearch search(room.grid());
  const auto found = search.find(turned_scan(room, {1.0, 1.3, 0.4}), 0.5, 0.1, 8);
  const TPose2D corners[] = {{1.0, 1.3, 0.4},
                             {2.7, 1.0, 0.4 + maps::kPi / 2},
                             {3.0, 2.7, 0.4 + maps::kPi},
                             {1.3, 3.0, 0.4 - maps::kPi / 2}};
  for (const TPose2D& corner : corners) {
    EXPECT_TRUE(std::any_of(found.places.begin(), found.places.end(), [&](const ScanPlace& p) {
      return is_at(p, corner);
    })) << corner.asString();
  }
}

TEST(ScanSearch, ComesBackWithTheBestFirstAndNothingBelowTheLimit) {
  const test::DepthRoom room = test::odd_room();
  const ScanSearch search(room.grid());
  const auto found = search.find(turned_scan(room, {1.0, 1.0, 0.3}, 1.0), 0.6, 0.3, 20);
  ASSERT_GT(found.places.size(), 1u);
  for (std::size_t i = 0; i < found.places.size(); ++i) {
    EXPECT_GE(found.places[i].share, 0.6);
    EXPECT_LE(found.places[i].share, found.places[i > 0 ? i - 1 : 0].share);
  }
}

TEST(ScanSearch, AScanOfAnotherRoomFitsNowhereWell) {
  const ScanSearch search(test::square_room().grid());
  const auto found = search.find(turned_scan(test::odd_room(), {4.0, 2.0, 0.0}), 0.9, 0.2, 5);
  EXPECT_TRUE(found.places.empty());
}

TEST(ScanSearch, NothingToSearchForOrInGivesNothing) {
  EXPECT_TRUE(ScanSearch(test::odd_room().grid()).find({}, 0.5, 0.2, 5).places.empty());
  EXPECT_TRUE(ScanSearch(maps::OccupancyGrid{}).find({{1.0, 0.0}}, 0.5, 0.2, 5).places.empty());
}

}  // namespace
}  // namespace rovigo::slam
