#include "planning/bspline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/scipy_spline.h"

namespace rovigo::planning {
namespace {

const std::vector<TPoint2D> kZigZag{{0, 0}, {1, 0.4}, {2, -0.5}, {2.5, 1.0}, {4, 1.2}, {5, 0}};

TEST(CubicBSpline, BeginsAndEndsAtTheFirstAndLastPoint) {
  const auto spline = CubicBSpline::uniform(kZigZag);
  EXPECT_NEAR(maps::distance(spline.position(spline.begin()), kZigZag.front()), 0.0, 1e-12);
  EXPECT_NEAR(maps::distance(spline.position(spline.end()), kZigZag.back()), 0.0, 1e-12);
}

TEST(CubicBSpline, TwoPointsMakeAStraightLineWithoutCurvature) {
  const auto spline = CubicBSpline::uniform({{1, 1}, {4, 5}});
  for (double u = 0.0; u <= 1.0; u += 0.125) {
    const CurvePoint p = spline.at(u);
    EXPECT_NEAR(p.position.x, 1.0 + 3.0 * u, 1e-12);
    EXPECT_NEAR(p.position.y, 1.0 + 4.0 * u, 1e-12);
    EXPECT_NEAR(p.curvature(), 0.0, 1e-12);
    EXPECT_NEAR(p.heading(), std::atan2(4.0, 3.0), 1e-12);
  }
}

TEST(CubicBSpline, IsTwiceContinuouslyDifferentiableAtItsKnots) {
  const auto spline = CubicBSpline::uniform(kZigZag);
  constexpr double kStep = 1e-9;
  for (double knot = 1.0; knot < spline.end(); knot += 1.0) {
    const CurvePoint before = spline.at(knot - kStep);
    const CurvePoint after = spline.at(knot + kStep);
    EXPECT_NEAR(maps::distance(before.position, after.position), 0.0, 1e-7);
    EXPECT_NEAR(maps::distance(before.first, after.first), 0.0, 1e-7);
    EXPECT_NEAR(maps::distance(before.second, after.second), 0.0, 1e-7);
    EXPECT_NEAR(before.curvature(), after.curvature(), 1e-6);
  }
}

TEST(CubicBSpline, DerivativesAgreeWithDifferences) {
  const auto spline = CubicBSpline::uniform(kZigZag);
  constexpr double kStep = 1e-4;
  for (double u = 0.3; u < 4.8; u += 0.371) {
    const CurvePoint p = spline.at(u);
    const CurvePoint a = spline.at(u - kStep);
    const CurvePoint b = spline.at(u + kStep);
    EXPECT_NEAR((b.position.x - a.position.x) / (2 * kStep), p.first.x, 1e-6);
    EXPECT_NEAR((b.first.y - a.first.y) / (2 * kStep), p.second.y, 1e-6);
    EXPECT_NEAR((b.second.x - a.second.x) / (2 * kStep), p.third.x, 1e-6);
    const double speed = std::hypot(p.first.x, p.first.y);
    EXPECT_NEAR((b.curvature() - a.curvature()) / (2 * kStep * speed), p.curvature_rate(), 1e-4);
  }
}

TEST(CubicBSpline, PointsOnACircleGiveItsCurvature) {
  std::vector<TPoint2D> circle;
  for (int i = 0; i <= 40; ++i)
    circle.push_back({2.0 * std::cos(0.1 * i), 2.0 * std::sin(0.1 * i)});
  EXPECT_NEAR(CubicBSpline::uniform(circle).at(20.0).curvature(), 0.5, 2e-3);
}

TEST(CubicBSpline, EvaluatesSciPysSplineWithUnevenKnots) {
  const auto& [knots, x, y] = test::scipy_spline_for_four();
  std::vector<TPoint2D> control;
  for (std::size_t i = 0; i < x.size(); ++i) control.push_back({x[i], y[i]});
  const CubicBSpline spline(knots, control);
  const std::vector<std::vector<double>> expected{
      {0.25, 17.182918, 6.321425}, {0.5, 34.184522, 12.320563}, {0.75, 51.261177, 18.304397}};
  for (const auto& e : expected) {
    EXPECT_NEAR(spline.position(e[0]).x, e[1], 2e-4);
    EXPECT_NEAR(spline.position(e[0]).y, e[2], 2e-4);
  }
}

TEST(CubicBSpline, ParametersOutsideTheDomainAreClamped) {
  const auto spline = CubicBSpline::uniform(kZigZag);
  EXPECT_EQ(spline.position(-5.0).x, spline.position(0.0).x);
  EXPECT_EQ(spline.position(50.0).x, spline.position(5.0).x);
}

}  // namespace
}  // namespace rovigo::planning
