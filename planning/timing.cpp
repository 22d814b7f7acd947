#include "planning/timing.h"

#include <algorithm>
#include <cmath>

namespace rovigo::planning {

namespace {

constexpr double kProfileSpacingM = 0.01;
// Of the yaw acceleration, for the change of curvature and for the change of speed each; a little
// is left for what lies between the profile's points.
constexpr double kYawShare = 0.48;
constexpr double kSmallestTurnRad = 1e-3;  // below it a turn in place is left to the tracker

/// Speed profile over points along one curve.
struct Profile {
  std::vector<double> parameter;
  std::vector<double> distance_m;  ///< along the curve
  std::vector<double> speed_m_s;
};

/// Highest speed at a point of the curve, whatever comes before or after.
double speed_limit(double curvature, double curvature_rate, bool slow, const MotionLimits& limits,
                   const TimingConfig& config) {
  const double bend = std::abs(curvature);
  double v = slow ? std::min(config.escape_speed_m_s, limits.speed_m_s) : limits.speed_m_s;
  v = std::min(v, limits.wheel_speed_m_s / (1.0 + 0.5 * bend * limits.track_width_m));
  if (bend > 1e-9) {
    v = std::min(v, limits.yaw_rate_rad_s / bend);
    v = std::min(v, std::sqrt(limits.lateral_acceleration_m_s2 / bend));
  }
  const double rate = std::abs(curvature_rate);
  if (rate > 1e-9) v = std::min(v, std::sqrt(kYawShare * limits.yaw_acceleration_rad_s2 / rate));
  return v;
}

double acceleration_limit(double curvature, const MotionLimits& limits) {
  const double bend = std::abs(curvature);
  if (bend < 1e-9) return limits.acceleration_m_s2;
  return std::min(limits.acceleration_m_s2, kYawShare * limits.yaw_acceleration_rad_s2 / bend);
}

Profile speed_profile(const PathPiece& piece, const MotionLimits& limits,
                      const TimingConfig& config) {
  Profile p;
  p.parameter = sample_parameters(piece.curve, kProfileSpacingM);
  if (p.parameter.size() < 3) {
    p.parameter.insert(p.parameter.begin() + 1, 0.5 * (p.parameter.front() + p.parameter.back()));
  }
  const std::size_t n = p.parameter.size();
  std::vector<double> acceleration(n);
  std::vector<double> curvature(n);
  std::vector<double> curvature_rate(n);
  p.distance_m.assign(n, 0.0);
  p.speed_m_s.assign(n, 0.0);
  TPoint2D last;
  for (std::size_t i = 0; i < n; ++i) {
    const CurvePoint at = piece.curve.at(p.parameter[i]);
    curvature[i] = at.curvature();
    curvature_rate[i] = at.curvature_rate();
    acceleration[i] = acceleration_limit(curvature[i], limits);
    if (i > 0) p.distance_m[i] = p.distance_m[i - 1] + maps::distance(last, at.position);
    last = at.position;
  }
  // The curvature's rate jumps at knots: the larger of both sides counts.
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double rate = std::max({std::abs(curvature_rate[i - 1]), std::abs(curvature_rate[i]),
                                  std::abs(curvature_rate[i + 1])});
    p.speed_m_s[i] = speed_limit(curvature[i], rate, piece.slow, limits, config);
  }
  const auto reachable = [&](std::size_t from, std::size_t to) {
    const double a = std::min(acceleration[from], acceleration[to]);
    const double ds = std::abs(p.distance_m[to] - p.distance_m[from]);
    return std::sqrt(p.speed_m_s[from] * p.speed_m_s[from] + 2.0 * a * ds);
  };
  for (std::size_t i = 1; i < n; ++i) {
    p.speed_m_s[i] = std::min(p.speed_m_s[i], reachable(i - 1, i));
  }
  for (std::size_t i = n - 1; i-- > 0;) {
    p.speed_m_s[i] = std::min(p.speed_m_s[i], reachable(i + 1, i));
  }
  return p;
}

class Timer {
 public:
  Timer(const MotionLimits& limits, const TimingConfig& config)
      : limits_(limits), config_(config) {}

  void begin(const TPose2D& pose) { push({.time_s = 0.0, .pose = pose}); }

  /// Rests between pieces need no time of their own; the turn starts and ends at rest.
  void turn_to(double heading_rad) {
    const TrajectoryPoint from = trajectory_.points.back();
    const double turn = maps::wrap_angle(heading_rad - from.pose.phi);
    if (std::abs(turn) < kSmallestTurnRad) return;
    const double angle = std::abs(turn);
    const double alpha = limits_.yaw_acceleration_rad_s2;
    const double peak = std::min(limits_.yaw_rate_rad_s, std::sqrt(angle * alpha));
    const double ramp = peak / alpha;
    const double duration = angle / peak + ramp;
    const int n = steps(duration);
    for (int i = 1; i <= n; ++i) {
      const double t = duration * i / n;
      const double up = std::min(t, ramp);
      const double down = std::max(0.0, t - (duration - ramp));
      const double flat = t - up - down;
      const double done =
          0.5 * alpha * up * up + peak * flat + peak * down - 0.5 * alpha * down * down;
      const double rate = alpha * up - alpha * down;
      TrajectoryPoint p = from;
      p.time_s = from.time_s + t;
      p.pose.phi = maps::wrap_angle(from.pose.phi + std::copysign(done, turn));
      p.yaw_rate_rad_s = i == n ? 0.0 : std::copysign(rate, turn);
      p.speed_m_s = 0.0;
      p.curvature_1_m = 0.0;
      if (i == n) p.pose.phi = maps::wrap_angle(heading_rad);
      push(p);
    }
  }

  void drive(const PathPiece& piece) {
    const Profile profile = speed_profile(piece, limits_, config_);
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
  }

  Trajectory take() { return std::move(trajectory_); }

 private:
  int steps(double duration) const {
    return std::max(1, static_cast<int>(std::ceil(duration / config_.sample_period_s)));
  }

  static TrajectoryPoint state_at(const PathPiece& piece, const Profile& profile,
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
  timer.begin({start.x, start.y, problem.start_heading_rad.value_or(along)});
  for (const PathPiece& piece : pieces) {
    timer.turn_to(piece.curve.at(piece.curve.begin()).heading());
    timer.drive(piece);
  }
  if (problem.goal_heading_rad) timer.turn_to(*problem.goal_heading_rad);
  return timer.take();
}

}  // namespace rovigo::planning
