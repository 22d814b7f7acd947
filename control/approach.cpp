#include "control/approach.h"

#include <algorithm>
#include <cmath>

namespace rovigo::control {
namespace {

using planning::Trajectory;
using planning::TrajectoryPoint;

constexpr double kSampleS = 0.02;

/// Rest to rest over `distance` with a trapezoid of speed; position and speed over time.
class Trapezoid {
 public:
  Trapezoid(double distance, double top_speed, double acceleration)
      : distance_(distance),
        acceleration_(acceleration),
        peak_(std::min(top_speed, std::sqrt(distance * acceleration))),
        ramp_s_(peak_ / acceleration),
        duration_s_(ramp_s_ + distance / peak_) {}

  double duration_s() const { return duration_s_; }
  double position(double t) const {
    if (t < ramp_s_) return acceleration_ * t * t / 2;
    const double left = duration_s_ - t;
    if (left < ramp_s_) return distance_ - acceleration_ * left * left / 2;
    return peak_ * (t - ramp_s_ / 2);
  }
  double speed(double t) const {
    return std::max(0.0, std::min({acceleration_ * t, acceleration_ * (duration_s_ - t), peak_}));
  }

 private:
  double distance_, acceleration_, peak_, ramp_s_, duration_s_;
};

template <class At>
void append(Trajectory& trajectory, const Trapezoid& profile, const At& point_at) {
  const double start = trajectory.duration_s();
  const int steps = std::max(1, static_cast<int>(std::ceil(profile.duration_s() / kSampleS)));
  for (int i = 1; i <= steps; ++i) {
    const double t = profile.duration_s() * i / steps;
    TrajectoryPoint p = point_at(profile.position(t), profile.speed(t));
    p.time_s = start + t;
    trajectory.points.push_back(p);
  }
}

void append_turn(Trajectory& trajectory, double to_yaw, const DriveLimits& limits) {
  constexpr double kNoTurnRad = 1e-3;
  const TPose2D from = trajectory.points.back().pose;
  const double turn = maps::wrap_angle(to_yaw - from.phi);
  if (std::abs(turn) < kNoTurnRad) return;
  const Trapezoid profile(std::abs(turn), limits.max_yaw_rate_rad_s / 2,
                          limits.max_yaw_acceleration_rad_s2 / 2);
  append(trajectory, profile, [&](double angle, double rate) {
    TrajectoryPoint p;
    p.pose = {from.x, from.y, maps::wrap_angle(from.phi + std::copysign(angle, turn))};
    p.yaw_rate_rad_s = std::copysign(rate, turn);
    return p;
  });
}

void append_straight(Trajectory& trajectory, double length, double speed,
                     const DriveLimits& limits) {
  const TPose2D from = trajectory.points.back().pose;
  const Trapezoid profile(length, std::min(speed, limits.max_speed_m_s),
                          limits.max_acceleration_m_s2 / 2);
  append(trajectory, profile, [&](double done, double v) {
    TrajectoryPoint p;
    p.pose = {from.x + done * std::cos(from.phi), from.y + done * std::sin(from.phi), from.phi};
    p.speed_m_s = v;
    return p;
  });
}

}  // namespace

Trajectory approach_trajectory(const TPose2D& from, const TPose2D& to, double speed_m_s,
                               double position_slack_m, const DriveLimits& limits) {
  Trajectory trajectory;
  trajectory.points.push_back({.time_s = 0.0, .pose = from});
  const double length = maps::distance(maps::position_of(from), maps::position_of(to));
  if (length > position_slack_m) {
    append_turn(trajectory, std::atan2(to.y - from.y, to.x - from.x), limits);
    append_straight(trajectory, length, speed_m_s, limits);
  }
  append_turn(trajectory, to.phi, limits);
  return trajectory;
}

}  // namespace rovigo::control
