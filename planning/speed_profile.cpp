#include "planning/speed_profile.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace rovigo::planning {

namespace {

constexpr double kProfileSpacingM = 0.01;
constexpr double kYawUse = 0.97;          // of the yaw acceleration; the rest for what lies between
constexpr double kStartTolerance = 5e-3;  // by which a start speed may have been rounded
constexpr double kInside = 1e-6;          // of a segment, to be on its side of a knot

/// a * acceleration + b * squared speed <= c, c >= 0: to stand still is always allowed.
struct Bound {
  double a = 0.0;
  double b = 0.0;
  double c = 0.0;
};
using Bounds = std::array<Bound, 8>;

/// The highest squared speed, at most `most`, at which some acceleration meets all bounds.
double highest(const Bounds& bounds, double most) {
  for (const Bound& upper : bounds) {
    if (upper.a == 0.0 && upper.b > 0.0) most = std::min(most, upper.c / upper.b);
    if (upper.a <= 0.0) continue;
    for (const Bound& lower : bounds) {
      if (lower.a >= 0.0) continue;
      // What the one asks of the acceleration at least, the other must allow.
      const double slope = upper.b / upper.a - lower.b / lower.a;
      const double room = upper.c / upper.a - lower.c / lower.a;
      if (slope > 0.0) most = std::min(most, room / slope);
    }
  }
  return most;
}

double highest_acceleration(const Bounds& bounds, double squared_speed) {
  double most = 1e9;
  for (const Bound& bound : bounds) {
    if (bound.a > 0.0) most = std::min(most, (bound.c - bound.b * squared_speed) / bound.a);
  }
  return most;
}

/// One step between two points: its length, and the curvature and its rate at either end.
struct Segment {
  double length = 0.0;
  std::array<double, 2> curvature{};
  std::array<double, 2> rate{};
};

Bounds bounds_of(const Segment& s, double highest_next, const MotionLimits& limits) {
  const double step = 2.0 * s.length;  // x_next = x + step * a
  const double alpha = kYawUse * limits.yaw_acceleration_rad_s2;
  const Bound here{s.curvature[0], s.rate[0], alpha};
  const Bound next{s.curvature[1] + step * s.rate[1], s.rate[1], alpha};
  return {Bound{1.0, 0.0, limits.acceleration_m_s2},
          Bound{-1.0, 0.0, limits.acceleration_m_s2},
          here,
          Bound{-here.a, -here.b, alpha},
          next,
          Bound{-next.a, -next.b, alpha},
          Bound{step, 1.0, highest_next},
          Bound{-step, -1.0, 0.0}};
}

double speed_limit(const CurvePoint& at, bool slow,
                   const std::function<double(const TPoint2D&)>& room_m, const MotionLimits& limits,
                   const TimingConfig& config) {
  const double bend = std::abs(at.curvature());
  double v = slow ? std::min(config.escape_speed_m_s, limits.speed_m_s) : limits.speed_m_s;
  if (room_m && config.slow_within_m > 0.0) {
    const double share = std::clamp(room_m(at.position) / config.slow_within_m, 0.0, 1.0);
    const double least = std::min(v, config.slow_speed_m_s);
    v = least + share * (v - least);
  }
  v = std::min(v, limits.wheel_speed_m_s / (1.0 + 0.5 * bend * limits.track_width_m));
  if (bend > 1e-9) {
    v = std::min(v, limits.yaw_rate_rad_s / bend);
    v = std::min(v, std::sqrt(limits.lateral_acceleration_m_s2 / bend));
  }
  return v;
}

}  // namespace

std::optional<SpeedProfile> speed_profile(const PathPiece& piece, double start_speed_m_s,
                                          const std::function<double(const TPoint2D&)>& room_m,
                                          const MotionLimits& limits, const TimingConfig& config) {
  SpeedProfile p;
  p.parameter = sample_parameters(piece.curve, kProfileSpacingM);
  if (p.parameter.size() < 3) {
    p.parameter.insert(p.parameter.begin() + 1, 0.5 * (p.parameter.front() + p.parameter.back()));
  }
  const std::size_t n = p.parameter.size();
  p.distance_m.assign(n, 0.0);
  std::vector<double> most(n);  // squared speed
  std::vector<Segment> segments(n - 1);
  TPoint2D last;
  for (std::size_t i = 0; i < n; ++i) {
    const CurvePoint at = piece.curve.at(p.parameter[i]);
    const double v = speed_limit(at, piece.slow, room_m, limits, config);
    most[i] = v * v;
    if (i > 0) p.distance_m[i] = p.distance_m[i - 1] + maps::distance(last, at.position);
    last = at.position;
  }
  for (std::size_t i = 0; i + 1 < n; ++i) {
    // The curvature's rate jumps at knots, which are among the points: each side has its own.
    const double width = p.parameter[i + 1] - p.parameter[i];
    const CurvePoint first = piece.curve.at(p.parameter[i] + kInside * width);
    const CurvePoint second = piece.curve.at(p.parameter[i + 1] - kInside * width);
    segments[i] = {.length = p.distance_m[i + 1] - p.distance_m[i],
                   .curvature = {first.curvature(), second.curvature()},
                   .rate = {first.curvature_rate(), second.curvature_rate()}};
  }

  const double start = start_speed_m_s * start_speed_m_s;
  most.front() = std::max(most.front(), start);  // the rover is as fast as it is
  most.back() = 0.0;
  for (std::size_t i = n - 1; i-- > 0;) {
    most[i] = highest(bounds_of(segments[i], most[i + 1], limits), most[i]);
  }
  if (start > most.front() * (1.0 + kStartTolerance) + 1e-9) return std::nullopt;
  p.speed_m_s.assign(n, 0.0);
  double x = std::min(start, most.front());
  p.speed_m_s.front() = std::sqrt(x);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double a = highest_acceleration(bounds_of(segments[i], most[i + 1], limits), x);
    x = std::clamp(x + 2.0 * a * segments[i].length, 0.0, most[i + 1]);
    p.speed_m_s[i + 1] = std::sqrt(x);
  }
  return p;
}

}  // namespace rovigo::planning
