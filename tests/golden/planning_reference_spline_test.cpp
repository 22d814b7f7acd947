// The reference spline against SciPy's splprep: the figures of the shared golden file, restated
// here so that the test needs nothing beside it; `data/golden/bspline_smoothing.py` made them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "planning/reference_spline.h"
#include "tests/support/scipy_spline.h"

namespace rovigo::planning {
namespace {

/// A staircase of cells: straight, diagonal, up, and back down, four times.
std::vector<TPoint2D> staircase() {
  std::vector<TPoint2D> points{{0.0, 0.0}};
  const auto go = [&](double dx, double dy, int n) {
    for (int i = 0; i < n; ++i) {
      points.push_back({points.back().x + dx, points.back().y + dy});
    }
  };
  for (int k = 0; k < 4; ++k) {
    go(1, 0, 5), go(1, 1, 4), go(0, 1, 3), go(1, 1, 2), go(1, 0, 3), go(1, -1, 3);
  }
  return points;
}

struct Expected {
  std::optional<double> smoothing;
  double residual;
  std::size_t knots;
  double node_deviation;
  double line_deviation;
  double start_deviation;
  double end_deviation;
  double length;
  double curvature;
};

// Columns as the script prints them.
const Expected kExpected[] = {
    {std::nullopt, 68.269168, 17, 1.8502, 1.7159, 0.5966, 0.7127, 84.3724, 0.6069},
    {0.0, 0.0, 85, 0.0, 0.1004, 0.0, 0.0, 95.5330, 1.4290},
    {2.0, 2.000556, 38, 0.3424, 0.3115, 0.0167, 0.0393, 92.9078, 0.5035},
    {4.0, 4.001022, 26, 0.4686, 0.4271, 0.0539, 0.1180, 91.6541, 0.4617},
    {6.0, 6.001191, 22, 0.6922, 0.6166, 0.1585, 0.1884, 91.5845, 0.9038},
    {10.0, 10.003778, 21, 0.7572, 0.6731, 0.3169, 0.1409, 90.5598, 0.7137},
    {50.0, 50.000741, 17, 1.7121, 1.5875, 0.8678, 0.7895, 86.5630, 0.6180},
};

double distance_to_line(const std::vector<TPoint2D>& line, const TPoint2D& p) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const double dx = line[i + 1].x - line[i].x;
    const double dy = line[i + 1].y - line[i].y;
    const double along = (p.x - line[i].x) * dx + (p.y - line[i].y) * dy;
    const double f = std::clamp(along / (dx * dx + dy * dy), 0.0, 1.0);
    best = std::min(best, std::hypot(line[i].x + f * dx - p.x, line[i].y + f * dy - p.y));
  }
  return best;
}

class GoldenSpline : public testing::TestWithParam<Expected> {};

TEST_P(GoldenSpline, HasTheFiguresOfSciPy) {
  const Expected& e = GetParam();
  const auto points = staircase();
  const double s = e.smoothing.value_or(default_smoothing(points.size()));
  const ReferenceSpline spline = reference_spline(points, s);
  EXPECT_EQ(spline.curve.knots().size(), e.knots);
  EXPECT_NEAR(spline.residual, e.residual, 2e-6);  // the same search, so the very same residual
  EXPECT_NEAR(spline.residual, s, 1e-3 * s + 1e-9);

  double node = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    node = std::max(node, maps::distance(points[i], spline.curve.position(spline.parameter[i])));
  }
  EXPECT_NEAR(node, e.node_deviation, 1e-4);
  EXPECT_NEAR(maps::distance(points.front(), spline.curve.position(0.0)), e.start_deviation, 1e-4);
  EXPECT_NEAR(maps::distance(points.back(), spline.curve.position(1.0)), e.end_deviation, 1e-4);

  double length = 0.0;
  double curvature = 0.0;
  double deviation = 0.0;
  TPoint2D last = spline.curve.position(0.0);
  for (int i = 0; i <= 20000; ++i) {
    const CurvePoint at = spline.curve.at(i / 20000.0);
    length += maps::distance(last, at.position);
    last = at.position;
    curvature = std::max(curvature, std::abs(at.curvature()));
    if (i % 20 == 0) deviation = std::max(deviation, distance_to_line(points, at.position));
  }
  EXPECT_NEAR(length, e.length, 1e-3);
  EXPECT_NEAR(curvature, e.curvature, 2e-3);
  EXPECT_NEAR(deviation, e.line_deviation, 2e-4);
}

INSTANTIATE_TEST_SUITE_P(Smoothing, GoldenSpline, testing::ValuesIn(kExpected),
                         [](const auto& param) {
                           const auto& s = param.param.smoothing;
                           return s ? "S" + std::to_string(static_cast<int>(*s)) : "Default";
                         });

TEST(GoldenSpline, HasTheKnotsAndControlPointsOfSciPyForFour) {
  const auto& [knots, x, y] = test::scipy_spline_for_four();
  const ReferenceSpline spline = reference_spline(staircase(), 4.0);
  ASSERT_EQ(spline.curve.knots().size(), knots.size());
  for (std::size_t i = 0; i < knots.size(); ++i) {
    EXPECT_NEAR(spline.curve.knots()[i], knots[i], 1e-6) << "knot " << i;
  }
  ASSERT_EQ(spline.curve.control_points().size(), x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_NEAR(spline.curve.control_points()[i].x, x[i], 1e-5) << "control point " << i;
    EXPECT_NEAR(spline.curve.control_points()[i].y, y[i], 1e-5) << "control point " << i;
  }
  const TPoint2D quarter = spline.curve.position(0.25);
  EXPECT_NEAR(quarter.x, 17.182918, 1e-5);
  EXPECT_NEAR(quarter.y, 6.321425, 1e-5);
}

TEST(ReferenceSpline, AStraightLineNeedsNoKnots) {
  std::vector<TPoint2D> points;
  for (int i = 0; i < 30; ++i) points.push_back({0.5 * i, 0.25 * i});
  const ReferenceSpline spline = reference_spline(points, 2.0);
  EXPECT_EQ(spline.curve.knots().size(), 8U);
  EXPECT_NEAR(spline.residual, 0.0, 1e-12);
}

TEST(ReferenceSpline, InterpolatesFourPointsByOneCubic) {
  const std::vector<TPoint2D> points{{0, 0}, {1, 2}, {3, 2}, {4, 0}};
  const ReferenceSpline spline = reference_spline(points, 0.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(maps::distance(spline.curve.position(spline.parameter[i]), points[i]), 0.0, 1e-12);
  }
}

TEST(ReferenceSpline, KeepsItsBoundOnLongWindingWays) {
  std::vector<TPoint2D> points;
  for (int i = 0; i < 1000; ++i) {
    const double a = 0.02 * i;
    points.push_back(
        {std::round(20.0 * std::sin(a) + 2.0 * i), std::round(50.0 * std::cos(2 * a))});
  }
  for (const double s : {0.0, 2.0, 6.0, 50.0, default_smoothing(points.size())}) {
    const ReferenceSpline spline = reference_spline(points, s);
    EXPECT_NEAR(spline.residual, s, 1e-3 * s + 1e-9) << s;
    const auto& knots = spline.curve.knots();
    EXPECT_TRUE(std::is_sorted(knots.begin(), knots.end()));
  }
}

/// The winding way of tests/benchmark/planning_scipy, which prints SciPy's figures beside ours.
/// With nearly as many knots as cells the control points of the least-squares fit are hardly
/// determined; its residual must not be taken from them.
TEST(GoldenSpline, HasAsManyKnotsAsSciPysOnAThousandCells) {
  std::vector<TPoint2D> cells;
  for (int i = 0; i < 1000; ++i) {
    const double a = 0.02 * i;
    cells.push_back(
        {std::round(20.0 * std::sin(a) + 100.0 * a), std::round(50.0 * std::cos(2.0 * a))});
  }
  EXPECT_EQ(reference_spline(cells, 2.0).curve.knots().size(), 1004U);
  EXPECT_EQ(reference_spline(cells, 4.0).curve.knots().size(), 980U);
  EXPECT_EQ(reference_spline(cells, 6.0).curve.knots().size(), 950U);
}

}  // namespace
}  // namespace rovigo::planning
