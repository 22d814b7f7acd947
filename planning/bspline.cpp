#include "planning/bspline.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace rovigo::planning {

namespace {

TPoint2D difference(const TPoint2D& b, const TPoint2D& a, double scale) {
  return {scale * (b.x - a.x), scale * (b.y - a.y)};
}

double cross(const TPoint2D& a, const TPoint2D& b) { return a.x * b.y - a.y * b.x; }
double dot(const TPoint2D& a, const TPoint2D& b) { return a.x * b.x + a.y * b.y; }

constexpr double kStandstill = 1e-12;  // squared speed below which a direction means nothing

}  // namespace

double CurvePoint::curvature() const {
  const double speed2 = dot(first, first);
  if (speed2 < kStandstill) return 0.0;
  return cross(first, second) / (speed2 * std::sqrt(speed2));
}

double CurvePoint::curvature_rate() const {
  const double speed2 = dot(first, first);
  if (speed2 < kStandstill) return 0.0;
  const double by_parameter = cross(first, third) / (speed2 * std::sqrt(speed2)) -
                              3.0 * curvature() * dot(first, second) / speed2;
  return by_parameter / std::sqrt(speed2);
}

double CurvePoint::heading() const { return std::atan2(first.y, first.x); }

CubicBSpline::CubicBSpline(std::vector<double> knots, std::vector<TPoint2D> control)
    : knots_(std::move(knots)), control_(std::move(control)) {
  assert(control_.size() >= 4 && knots_.size() == control_.size() + 4);
}

CubicBSpline CubicBSpline::uniform(const std::vector<TPoint2D>& points,
                                   const TPoint2D& start_second) {
  assert(points.size() >= 2);
  const std::size_t n = points.size();
  // Phantom points mirrored at the ends make the curve begin and end there: (p + 4 q + r) / 6 = q
  // when p and r lie opposite each other.
  std::vector<TPoint2D> control;
  control.reserve(n + 2);
  control.push_back({2.0 * points[0].x - points[1].x + start_second.x,
                     2.0 * points[0].y - points[1].y + start_second.y});
  control.insert(control.end(), points.begin(), points.end());
  control.push_back(
      {2.0 * points[n - 1].x - points[n - 2].x, 2.0 * points[n - 1].y - points[n - 2].y});
  std::vector<double> knots(control.size() + 4);
  for (std::size_t i = 0; i < knots.size(); ++i) knots[i] = static_cast<double>(i) - 3.0;
  CubicBSpline out(std::move(knots), std::move(control));
  out.is_uniform_ = true;
  return out;
}

/// As at(), in closed form: most curves have uniform knots, and are looked at thousands of times.
CurvePoint CubicBSpline::at_uniform(double parameter) const {
  const std::size_t spans = control_.size() - 3;
  const double u = std::clamp(parameter, 0.0, static_cast<double>(spans));
  const std::size_t span = std::min(static_cast<std::size_t>(u), spans - 1);
  const TPoint2D* c = control_.data() + span;
  const double f = u - static_cast<double>(span), g = 1.0 - f;
  const auto mix = [c](double b0, double b1, double b2, double b3) -> TPoint2D {
    return {b0 * c[0].x + b1 * c[1].x + b2 * c[2].x + b3 * c[3].x,
            b0 * c[0].y + b1 * c[1].y + b2 * c[2].y + b3 * c[3].y};
  };
  constexpr double kSixth = 1.0 / 6.0;
  CurvePoint out;
  out.position = mix(kSixth * g * g * g, kSixth * (4.0 + f * f * (3.0 * f - 6.0)),
                     kSixth * (4.0 + g * g * (3.0 * g - 6.0)), kSixth * f * f * f);
  out.first = mix(-0.5 * g * g, f * (1.5 * f - 2.0), g * (2.0 - 1.5 * g), 0.5 * f * f);
  out.second = mix(g, 3.0 * f - 2.0, 3.0 * g - 2.0, f);
  out.third = mix(-1.0, 3.0, -3.0, 1.0);
  return out;
}

CurvePoint CubicBSpline::at(double parameter) const {
  if (is_uniform_) return at_uniform(parameter);
  const double u = std::clamp(parameter, begin(), end());
  // Span k with t_k <= u < t_{k+1}; the last one includes its end.
  const auto after = std::upper_bound(knots_.begin() + 4, knots_.end() - 4, u);
  const auto k = static_cast<std::size_t>(after - knots_.begin()) - 1;
  const double* t = knots_.data() + k;
  const TPoint2D* c = control_.data() + (k - 3);

  // Basis functions of degree 1 and 2, then 3 (de Boor's triangle).
  const auto ratio = [](double a, double b) { return b > 0.0 ? a / b : 0.0; };
  const double l1 = ratio(u - t[0], t[1] - t[0]);
  const std::array<double, 2> b1{1.0 - l1, l1};
  const double q0 = ratio(u - t[-1], t[1] - t[-1]);
  const double q1 = ratio(u - t[0], t[2] - t[0]);
  const std::array<double, 3> b2{(1.0 - q0) * b1[0], q0 * b1[0] + (1.0 - q1) * b1[1], q1 * b1[1]};
  const double c0 = ratio(u - t[-2], t[1] - t[-2]);
  const double c1 = ratio(u - t[-1], t[2] - t[-1]);
  const double c2 = ratio(u - t[0], t[3] - t[0]);
  const std::array<double, 4> b3{(1.0 - c0) * b2[0], c0 * b2[0] + (1.0 - c1) * b2[1],
                                 c1 * b2[1] + (1.0 - c2) * b2[2], c2 * b2[2]};

  // Derivatives are splines of lower degree over differences of the control points.
  std::array<TPoint2D, 3> d1;
  for (int i = 0; i < 3; ++i) {
    d1[static_cast<std::size_t>(i)] = difference(c[i + 1], c[i], ratio(3.0, t[i + 1] - t[i - 2]));
  }
  const std::array<TPoint2D, 2> d2{difference(d1[1], d1[0], ratio(2.0, t[1] - t[-1])),
                                   difference(d1[2], d1[1], ratio(2.0, t[2] - t[0]))};
  CurvePoint out;
  for (std::size_t i = 0; i < 4; ++i) {
    out.position.x += b3[i] * c[i].x;
    out.position.y += b3[i] * c[i].y;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    out.first.x += b2[i] * d1[i].x;
    out.first.y += b2[i] * d1[i].y;
  }
  out.second = {b1[0] * d2[0].x + b1[1] * d2[1].x, b1[0] * d2[0].y + b1[1] * d2[1].y};
  out.third = difference(d2[1], d2[0], ratio(1.0, t[1] - t[0]));
  return out;
}

}  // namespace rovigo::planning
