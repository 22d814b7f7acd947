#include "slam/grid_mapper.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "slam/depth_scan.h"
#include "slam/ray_voter.h"
#include "tests/support/pinhole.h"

namespace rovigo::slam {
namespace {

constexpr double kCameraHeightM = 0.25;

Se3 level_camera() { return test::looking_ahead(kCameraHeightM); }

/// Something across the whole view, from x0 to x1 ahead and between two heights.
struct Slab {
  double x0 = 0, x1 = 0, low = 0, high = 0;

  /// Where a ray from the camera enters it, along x; infinite when it does not.
  double entered_at(double rise) const {
    const double none = std::numeric_limits<double>::infinity();
    if (rise == 0.0) return low <= kCameraHeightM && kCameraHeightM <= high ? x0 : none;
    const double a = (low - kCameraHeightM) / rise, b = (high - kCameraHeightM) / rise;
    const double begin = std::max(x0, std::min(a, b)), end = std::min(x1, std::max(a, b));
    return begin <= end && begin > 0 ? begin : none;
  }
};

/// Depth as a level camera at the origin sees slabs over a floor.
/// `nod_rad`: how far up it truly looks.
cv::Mat view(const CameraModel& camera, const std::vector<Slab>& slabs, double nod_rad = 0.0) {
  cv::Mat depth(480, 640, CV_16UC1, cv::Scalar(0));
  for (int v = 0; v < 480; ++v) {
    const double rise = nod_rad - camera.unproject({0, v}, 1.0).y();
    double z = rise < 0 ? -kCameraHeightM / rise : 1e9;
    for (const Slab& s : slabs) z = std::min(z, s.entered_at(rise));
    if (z > 6.0) continue;
    depth.row(v).setTo(static_cast<std::uint16_t>(std::lround(1000 * z)));
  }
  return depth;
}

/// A slab of limited width, its middle at the origin.
struct Block {
  Slab slab;
  double half_width = 0;
};

constexpr double kAroundM = 1.7;  // from the middle of a table that is looked at from all around
TPose2D around(double heading) {
  return {-kAroundM * std::cos(heading), -kAroundM * std::sin(heading), heading};
}

/// Depth as a level camera at `around(heading)` sees a block and, far behind it, a wall.
cv::Mat table_view(const CameraModel& camera, const Block& block, double heading) {
  constexpr double kWallM = 4.0;
  const TPose2D eye = around(heading);
  const double c = std::cos(heading), s = std::sin(heading);
  cv::Mat depth(480, 640, CV_16UC1, cv::Scalar(0));
  for (int v = 0; v < 480; ++v) {
    for (int u = 0; u < 640; ++u) {
      const Eigen::Vector3d ray = camera.unproject({u, v}, 1.0);
      const double dx = c + s * ray.x(), dy = s - c * ray.x(), rise = -ray.y();
      double z = rise < 0 ? std::min(kWallM, -kCameraHeightM / rise) : kWallM;
      double begin = 0.0, end = z;  // slabs of the three axes, one after the other
      const auto cut = [&](double from, double step, double low, double high) {
        if (std::abs(step) < 1e-9) {
          if (from < low || from > high) end = -1.0;
          return;
        }
        begin = std::max(begin, std::min((low - from) / step, (high - from) / step));
        end = std::min(end, std::max((low - from) / step, (high - from) / step));
      };
      cut(eye.x, dx, block.slab.x0, block.slab.x1);
      cut(eye.y, dy, -block.half_width, block.half_width);
      cut(kCameraHeightM, rise, block.slab.low, block.slab.high);
      if (begin <= end) z = begin;
      depth.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(std::lround(1000 * z));
    }
  }
  return depth;
}

Slab wall(double at_m) { return {at_m, at_m + 0.1, 0.0, 2.5}; }

class Mapping : public ::testing::Test {
 protected:
  void look(const cv::Mat& depth, int times, const TPose2D& from = {0, 0, 0}) {
    for (int i = 0; i < times; ++i) {
      voter_.vote(scanner_.scan(depth, 0.001, level_camera()), from, patch_);
    }
  }
  /// Farther than 1.4 m floor is too grazing for a return: no ray clears what is just above it.
  cv::Mat without_far_floor(const std::vector<Slab>& slabs) const {
    cv::Mat depth = view(camera_, slabs);
    const cv::Mat floor_alone = view(camera_, {});
    depth.setTo(0, (depth == floor_alone) & (depth > 1400));
    return depth;
  }
  void look_at(const std::vector<Slab>& slabs, int times, const TPose2D& from = {0, 0, 0}) {
    look(view(camera_, slabs), times, from);
  }
  maps::OccupancyGrid grid() const { return render_grid({{{0, 0, 0}, &patch_}}, config_); }
  static std::int8_t value(const maps::OccupancyGrid& g, double x, double y) {
    const maps::Cell c = g.geometry.cell_at({x, y});
    return g.geometry.contains(c) ? g.at(c) : maps::OccupancyGrid::kUnknown;
  }
  static bool occupied(const maps::OccupancyGrid& g, double x, double y) {
    return maps::OccupancyGrid::is_occupied(value(g, x, y));
  }
  static bool free(const maps::OccupancyGrid& g, double x, double y) {
    return maps::OccupancyGrid::is_free(value(g, x, y));
  }
  static bool unknown(const maps::OccupancyGrid& g, double x, double y) {
    return maps::OccupancyGrid::is_unknown(value(g, x, y));
  }

  CameraModel camera_{test::pinhole()};
  GridConfig config_;
  DepthScanner scanner_{camera_, DepthConfig{}};
  RayVoter voter_{config_, DepthConfig{}};
  EvidencePatch patch_;
};

TEST_F(Mapping, AWallIsAnObstacleAndTheGroundBeforeItIsFree) {
  look_at({wall(2.02)}, 3);
  EXPECT_TRUE(occupied(grid(), 2.02, 0.0));
  EXPECT_TRUE(free(grid(), 1.0, 0.0));
  EXPECT_TRUE(unknown(grid(), 2.5, 0.0)) << "behind the wall";
}

TEST_F(Mapping, TheFloorAloneIsNoObstacle) {
  for (int i = 0; i < 8; ++i) look_at({wall(5.9)}, 1, {-0.013 * i, 0.0, 0.0});
  for (double x = 0.6; x < 5.0; x += 0.05) EXPECT_TRUE(free(grid(), x, 0.0)) << x;
}

TEST_F(Mapping, ADoorSillBelowTheObstacleHeightIsFloor) {
  look_at({{1.5, 1.6, 0.0, 0.03}, wall(4.02)}, 5);
  EXPECT_TRUE(free(grid(), 1.5, 0.0));
}

TEST_F(Mapping, ATopThatCanBeDrivenUnderIsIgnoredAndFreeBelow) {
  look_at({{2.0, 2.7, 0.70, 0.75}, wall(4.02)}, 5);  // a desk top and a wall behind it
  EXPECT_TRUE(free(grid(), 2.02, 0.0));
  EXPECT_TRUE(occupied(grid(), 4.02, 0.0));
}

TEST_F(Mapping, ALowBoxStaysThoughRaysPassOverIt) {
  look_at({{1.52, 1.7, 0.0, 0.15}, wall(4.02)}, 40);
  EXPECT_TRUE(occupied(grid(), 1.52, 0.0));
  EXPECT_TRUE(occupied(grid(), 4.02, 0.0));
}

TEST_F(Mapping, ALowTablesEdgeStaysThoughRaysPassBelowIt) {
  look_at({{1.52, 2.07, 0.38, 0.42}, wall(4.02)}, 40);
  EXPECT_TRUE(occupied(grid(), 1.52, 0.0));
}

TEST_F(Mapping, ATableSeenEdgeOnFromBothEndsIsAnObstacleInBetween) {
  look_at({{1.52, 2.12, 0.38, 0.42}, wall(4.02)}, 5);
  look_at({{1.52, 2.12, 0.38, 0.42}, wall(4.02)}, 5, {3.64, 0.0, maps::kPi});  // its other edge
  for (double x = 1.55; x < 2.04; x += 0.05) EXPECT_TRUE(occupied(grid(), x, 0.0)) << x;
}

TEST_F(Mapping, WhatIsHiddenBehindATablesEdgeIsNotFree) {
  look_at({{1.52, 2.07, 0.38, 0.42}, wall(4.02)}, 20);
  EXPECT_FALSE(free(grid(), 1.70, 0.0));
}

TEST_F(Mapping, ATableSeenFromThreeSidesIsAnObstacleAtItsWholeTop) {
  const Block table{{-0.3, 0.3, 0.38, 0.42}, 0.45};
  for (const double heading : {-maps::kPi / 2, 0.0, maps::kPi / 2}) {
    look(table_view(camera_, table, heading), 5, around(heading));
  }
  for (double x = -0.27; x < 0.28; x += 0.05) {
    for (double y = -0.42; y < 0.43; y += 0.05)
      EXPECT_TRUE(occupied(grid(), x, y)) << x << " " << y;
  }
}

TEST_F(Mapping, TheShadowOfATableUpToACupboardOnFeetIsNoTop) {
  look_at({{1.52, 2.07, 0.32, 0.36}, {2.62, 3.0, 0.10, 1.5}, wall(3.1)}, 20);
  for (double x = 2.15; x < 2.55; x += 0.05) EXPECT_FALSE(occupied(grid(), x, 0.0)) << x;
}

TEST_F(Mapping, ATableFarAwayIsNotFreeAtItsTopThoughHeightsErrThere) {
  // The rover's nods lift and lower what it sees by a centimetre or two at this distance.
  for (int i = 0; i < 24; ++i) {
    const double nod_rad = 0.004 * std::sin(2.1 * i);
    look(view(camera_, {{4.7, 5.25, 0.34, 0.38}, wall(5.9)}, nod_rad), 1, {-0.013 * i, 0.0, 0.0});
  }
  int free_cells = 0;
  for (double x = 4.75; x < 5.22; x += 0.05) free_cells += free(grid(), x, 0.0);
  EXPECT_LE(free_cells, 2) << "of ten; the front edge is where heights err most";
}

TEST_F(Mapping, SomethingThatLeftIsCleared) {
  look_at({{1.5, 1.8, 0.0, 1.8}, wall(4.0)}, 3);
  EXPECT_TRUE(occupied(grid(), 1.5, 0.0));
  look_at({wall(4.0)}, 8);
  EXPECT_TRUE(free(grid(), 1.5, 0.0));
}

TEST_F(Mapping, WhoStoodWhereTheFloorGivesNoReturnLeavesNoFeetBehind) {
  look(without_far_floor({{1.5, 1.8, 0.0, 1.8}, wall(4.0)}), 8);
  EXPECT_TRUE(occupied(grid(), 1.5, 0.0));
  look(without_far_floor({wall(4.0)}), 12);
  EXPECT_TRUE(free(grid(), 1.5, 0.0));
}

TEST_F(Mapping, AShoeThatGaveReturnsAndGivesNoneAnyMoreHasLeft) {
  look(without_far_floor({{1.5, 1.75, 0.0, 0.09}, wall(4.0)}), 8);
  EXPECT_TRUE(occupied(grid(), 1.5, 0.0));
  look(without_far_floor({wall(4.0)}), 40);
  EXPECT_TRUE(free(grid(), 1.5, 0.0));
}

TEST_F(Mapping, ALowStepOnFarFloorThatGivesNoReturnStays) {
  look(without_far_floor({{2.1, 2.4, 0.0, 0.09}, wall(4.0)}), 60);
  EXPECT_TRUE(occupied(grid(), 2.1, 0.0));
}

TEST_F(Mapping, ACoveredCameraClearsNothing) {
  look(without_far_floor({{1.5, 1.75, 0.0, 0.09}, wall(4.0)}), 8);
  look(cv::Mat::zeros(480, 640, CV_16UC1), 60);
  EXPECT_TRUE(occupied(grid(), 1.5, 0.0));
}

TEST_F(Mapping, RaysOverSomethingLowDoNotClearIt) {
  look_at({{1.5, 1.8, 0.0, 0.15}, wall(4.0)}, 3);
  cv::Mat upper_part = view(camera_, {wall(4.0)});
  for (int v = 0; v < 480; ++v) {  // nothing returns from where the low thing was
    if (camera_.unproject({0, v}, 1.5).y() > kCameraHeightM - 0.16) upper_part.row(v).setTo(0);
  }
  look(upper_part, 30);
  EXPECT_TRUE(occupied(grid(), 1.5, 0.0));
}

TEST_F(Mapping, ReturnsFromBelowTheFloorMarkNothing) {
  // A mirror of a floor: where it should be at 1 to 3 m, the wall's image lies twice as deep.
  cv::Mat depth = view(camera_, {wall(3.02)});
  for (int v = 300; v < 480; ++v) depth.row(v).setTo(3020);
  look(depth, 10);
  EXPECT_TRUE(free(grid(), 1.5, 0.0));
  EXPECT_TRUE(occupied(grid(), 3.02, 0.0));
}

TEST_F(Mapping, AnImageWithoutReturnsSaysNothing) {
  look(cv::Mat(480, 640, CV_16UC1, cv::Scalar(0)), 3);
  for (const auto cell : grid().cells) EXPECT_EQ(cell, maps::OccupancyGrid::kUnknown);
}

TEST_F(Mapping, WhereTheRoverWasIsFree) {
  voter_.vote_driven({1.0, 1.0}, 0.2, patch_);
  EXPECT_TRUE(free(grid(), 1.1, 1.0));
  EXPECT_TRUE(unknown(grid(), 1.4, 1.0));
}

TEST_F(Mapping, PatchesMoveWithTheirKeyframes) {
  look_at({wall(2.02)}, 3);
  const auto moved = render_grid({{{1.0, 0.5, maps::kPi / 2}, &patch_}}, config_);
  EXPECT_TRUE(occupied(moved, 1.0, 2.52));
  EXPECT_TRUE(free(moved, 1.0, 1.5));
}

TEST_F(Mapping, TheOrderOfPatchesDoesNotMatter) {
  EvidencePatch other;
  look_at({wall(2.02)}, 3);
  voter_.vote(
      scanner_.scan(view(camera_, {{1.5, 1.7, 0.0, 0.3}, wall(4.0)}), 0.001, level_camera()),
      {0, 0, 0}, other);
  const PlacedPatch a{{0.3, 0.2, 0.1}, &patch_}, b{{0.1, 0.4, -0.2}, &other};
  EXPECT_EQ(render_grid({a, b}, config_).cells, render_grid({b, a}, config_).cells);
}

TEST_F(Mapping, MemoryDoesNotGrowWhileTheSameIsSeen) {
  const cv::Mat depth = view(camera_, {wall(3.0)});
  look(depth, 1);
  const std::size_t once = patch_.memory_bytes();
  look(depth, 50);
  EXPECT_EQ(patch_.memory_bytes(), once);
  EXPECT_LT(once, 200000u);
}

TEST_F(Mapping, ASmallerDepthImageGivesTheSameWalls) {
  cv::Mat small;
  cv::resize(view(camera_, {wall(2.02)}), small, {160, 120}, 0, 0, cv::INTER_NEAREST);
  look(small, 3);
  EXPECT_TRUE(occupied(grid(), 2.02, 0.0));
  EXPECT_TRUE(free(grid(), 1.0, 0.0));
}

}  // namespace
}  // namespace rovigo::slam
