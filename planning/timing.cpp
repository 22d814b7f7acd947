#include "planning/timing.h"

#include <algorithm>
#include <cmath>

#include "planning/speed_profile.h"

namespace rovigo::planning {

namespace {

constexpr double kSmallestTurnRad = 1e-3;  // below it a turn in place is left to the tracker

/// A turn in place as fast as the limits allow, from a turn rate to rest: speed up, hold, slow
/// down. Angles and rates are counted in its direction.
struct Turn {
  double sign = 1.0;
  double rate = 0.0;  ///< at its start; negative when it first has to stop turning the other way
  double peak = 0.0;
  double ramp = 0.0;  ///< seconds until the peak
  double hold = 0.0;
  double alpha = 1.0;

  double duration() const { return ramp + hold + peak / alpha; }
  double rate_at(double t) const {
    if (t < ramp) return rate + alpha * t;
    return std::max(0.0, peak - alpha * std::max(0.0, t - ramp - hold));
  }
  double angle_at(double t) const {
    const double up = std::min(t, ramp);
    const double flat = std::clamp(t - ramp, 0.0, hold);
    const double down = std::max(0.0, t - ramp - hold);
    return rate * up + 0.5 * alpha * up * up + peak * flat + peak * down -
           0.5 * alpha * down * down;
  }
};

Turn fastest_turn(double angle_rad, double rate, const MotionLimits& limits) {
  const double alpha = limits.yaw_acceleration_rad_s2;
  // The short way round from where the rover can be at rest.
  const double rest = 0.5 * rate * std::abs(rate) / alpha;
  const double beyond = maps::wrap_angle(angle_rad - rest);
  Turn turn{.sign = beyond < 0.0 ? -1.0 : 1.0, .alpha = alpha};
  turn.rate = turn.sign * rate;
  const double angle = turn.sign * (rest + beyond);
  const double highest = std::max(limits.yaw_rate_rad_s, turn.rate);
  turn.peak = std::min(highest, std::sqrt(std::max(0.0, alpha * angle + 0.5 * rate * rate)));
  turn.ramp = std::max(0.0, (turn.peak - turn.rate) / alpha);
  const double ramps = (turn.peak * turn.peak - 0.5 * rate * rate) / alpha;
  turn.hold = turn.peak > 0.0 ? std::max(0.0, (angle - ramps) / turn.peak) : 0.0;
  return turn;
}

class Timer {
 public:
  Timer(const MotionLimits& limits, const TimingConfig& config)
      : limits_(limits), config_(config) {}

  void begin(const TPose2D& pose, double speed, double yaw_rate) {
    push({.time_s = 0.0,
          .pose = pose,
          .speed_m_s = speed,
          .yaw_rate_rad_s = yaw_rate,
          .curvature_1_m = speed > 0.0 ? yaw_rate / speed : 0.0});
  }

  /// Ends at rest; begins with the last point's turn rate.
  void turn_to(double heading_rad) {
    const TrajectoryPoint from = trajectory_.points.back();
    const double angle = maps::wrap_angle(heading_rad - from.pose.phi);
    if (std::abs(angle) < kSmallestTurnRad && from.yaw_rate_rad_s == 0.0) return;
    const Turn turn = fastest_turn(angle, from.yaw_rate_rad_s, limits_);
    const int n = steps(turn.duration());
    for (int i = 1; i <= n; ++i) {
      const double t = turn.duration() * i / n;
      TrajectoryPoint p = from;
      p.time_s = from.time_s + t;
      p.pose.phi =
          maps::wrap_angle(i == n ? heading_rad : from.pose.phi + turn.sign * turn.angle_at(t));
      p.yaw_rate_rad_s = i == n ? 0.0 : turn.sign * turn.rate_at(t);
      p.speed_m_s = 0.0;
      p.curvature_1_m = 0.0;
      push(p);
    }
  }

  /// False when the last point's speed is too high for the piece.
  bool drive(const PathPiece& piece, const std::function<double(const TPoint2D&)>& room_m) {
    const auto planned =
        speed_profile(piece, trajectory_.points.back().speed_m_s, room_m, limits_, config_);
    if (!planned) return false;
    const SpeedProfile& profile = *planned;
    const double start_time = trajectory_.points.back().time_s;
    const std::size_t n = profile.parameter.size();
    std::vector<double> time(n, 0.0);
    for (std::size_t i = 1; i < n; ++i) {
      const double ds = profile.distance_m[i] - profile.distance_m[i - 1];
      const double sum = profile.speed_m_s[i] + profile.speed_m_s[i - 1];
      time[i] = time[i - 1] + (sum > 0.0 ? 2.0 * ds / sum : 0.0);
    }
    const double duration = time.back();
    const int count = steps(duration);
    std::size_t segment = 1;
    for (int k = 1; k <= count; ++k) {
      const double t = k == count ? duration : duration * k / count;
      while (segment + 1 < n && time[segment] < t) ++segment;
      TrajectoryPoint p = state_at(piece, profile, time, segment, t);
      p.time_s = start_time + t;
      if (k == count) p.speed_m_s = p.yaw_rate_rad_s = 0.0;
      push(p);
    }
    return true;
  }

  Trajectory take() { return std::move(trajectory_); }

 private:
  int steps(double duration) const {
    return std::max(1, static_cast<int>(std::ceil(duration / config_.sample_period_s)));
  }

  static TrajectoryPoint state_at(const PathPiece& piece, const SpeedProfile& profile,
                                  const std::vector<double>& time, std::size_t segment, double t) {
    const double v0 = profile.speed_m_s[segment - 1];
    const double v1 = profile.speed_m_s[segment];
    const double span = time[segment] - time[segment - 1];
    const double ds = profile.distance_m[segment] - profile.distance_m[segment - 1];
    const double tau = std::clamp(t - time[segment - 1], 0.0, span);
    const double a = span > 0.0 ? (v1 - v0) / span : 0.0;
    const double f = ds > 0.0 ? std::clamp((v0 * tau + 0.5 * a * tau * tau) / ds, 0.0, 1.0) : 1.0;
    const double u = profile.parameter[segment - 1] +
                     f * (profile.parameter[segment] - profile.parameter[segment - 1]);
    const CurvePoint at = piece.curve.at(u);
    TrajectoryPoint p;
    p.pose = {at.position.x, at.position.y, at.heading()};
    p.speed_m_s = v0 + a * tau;
    p.curvature_1_m = at.curvature();
    p.yaw_rate_rad_s = p.speed_m_s * p.curvature_1_m;
    return p;
  }

  void push(const TrajectoryPoint& point) {
    auto& points = trajectory_.points;
    if (!points.empty() && point.time_s <= points.back().time_s) return;
    points.push_back(point);
  }

  const MotionLimits& limits_;
  const TimingConfig& config_;
  Trajectory trajectory_;
};

}  // namespace

MotionLimits limits_of(const maps::RobotModel& robot, const TimingConfig& config) {
  return {
      .speed_m_s = robot.max_speed_m_s * config.speed_fraction,
      .yaw_rate_rad_s = robot.max_yaw_rate_rad_s * config.speed_fraction,
      .acceleration_m_s2 = robot.max_acceleration_m_s2 * config.acceleration_fraction,
      .yaw_acceleration_rad_s2 = robot.max_yaw_acceleration_rad_s2 * config.acceleration_fraction,
      .lateral_acceleration_m_s2 = config.max_lateral_acceleration,
      .wheel_speed_m_s = config.max_wheel_speed_m_s,
      .track_width_m = robot.track_width_m};
}

Trajectory time_path(const TimingProblem& problem, const MotionLimits& limits,
                     const TimingConfig& config) {
  Timer timer(limits, config);
  const auto& pieces = problem.pieces;
  const TPoint2D start =
      pieces.empty() ? problem.at : pieces.front().curve.position(pieces.front().curve.begin());
  const double along = pieces.empty()
                           ? problem.goal_heading_rad.value_or(0.0)
                           : pieces.front().curve.at(pieces.front().curve.begin()).heading();
  const bool moves = problem.start_speed_m_s > 0.0;
  timer.begin({start.x, start.y, problem.start_heading_rad.value_or(along)},
              problem.start_speed_m_s, problem.start_yaw_rate_rad_s);
  for (const PathPiece& piece : pieces) {
    if (!moves || &piece != &pieces.front()) {
      timer.turn_to(piece.curve.at(piece.curve.begin()).heading());
    }
    if (!timer.drive(piece, problem.room_m)) return {};
  }
  if (problem.goal_heading_rad) timer.turn_to(*problem.goal_heading_rad);
  return timer.take();
}

}  // namespace rovigo::planning
