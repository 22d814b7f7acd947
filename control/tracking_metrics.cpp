#include "control/tracking_metrics.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace rovigo::control {
namespace {

using maps::wrap_angle;

/// Root mean square and largest size of a series.
class Spread {
 public:
  void add(double value) {
    sum_of_squares_ += value * value;
    max_ = std::max(max_, std::abs(value));
    ++count_;
  }
  double rms() const {
    return count_ > 0 ? std::sqrt(sum_of_squares_ / static_cast<double>(count_)) : 0.0;
  }
  double max() const { return max_; }

 private:
  double sum_of_squares_ = 0.0;
  double max_ = 0.0;
  std::size_t count_ = 0;
};

bool is_saturated(const TTwist2D& command, const CommandLimits& limits) {
  constexpr double kAlmost = 1.0 - 1e-6;
  return std::abs(command.vx) >= kAlmost * limits.max_speed_m_s ||
         std::abs(command.omega) >= kAlmost * limits.max_yaw_rate_rad_s;
}

/// Distance of `offset` (planned point to true point) along the direction `yaw`.
double along(const TPose2D& reference, const TPose2D& truth) {
  return (truth.x - reference.x) * std::cos(reference.phi) +
         (truth.y - reference.y) * std::sin(reference.phi);
}

/// When the plan is at its last position; turns in place may follow.
double arrival_time_s(const planning::Trajectory& planned) {
  std::size_t i = planned.points.size() - 1;
  const TPoint2D end = maps::position_of(planned.points.back().pose);
  while (i > 0 && maps::position_of(planned.points[i - 1].pose) == end) --i;
  return planned.points[i].time_s;
}

/// Direction of travel when the goal is reached.
double last_direction(const planning::Trajectory& planned) {
  double direction = planned.points.back().pose.phi;
  for (const auto& p : planned.points) {
    if (p.speed_m_s > 0.0) direction = p.pose.phi;
  }
  return direction;
}

/// How the drive came to rest: overshoot and settling.
void measure_arrival(const DriveLog& log, const planning::Trajectory& planned, DriveMetrics& m) {
  constexpr double kSettledM = 0.005;
  constexpr double kTimeSlackS = 1e-6;
  const double arrival_s = arrival_time_s(planned);
  const auto arrived = std::find_if(log.steps.begin(), log.steps.end(), [&](const DriveStep& s) {
    return s.reference.time_s >= arrival_s - kTimeSlackS;
  });
  if (arrived == log.steps.end()) return;
  const TPose2D goal(planned.points.back().pose.x, planned.points.back().pose.y,
                     last_direction(planned));
  const TPoint2D rest = maps::position_of(log.steps.back().true_pose);
  for (auto step = arrived; step != log.steps.end(); ++step) {
    m.overshoot_m = std::max(m.overshoot_m, along(goal, step->true_pose));
    if (maps::distance(maps::position_of(step->true_pose), rest) > kSettledM) {
      m.settling_s = step->time_s - arrived->time_s;
    }
  }
}

int reversals_at(const TPoint2D& goal, const DriveLog& log) {
  constexpr double kAtGoalM = 0.02;
  constexpr double kTurningRadS = 0.15;
  int reversals = 0;
  double last = 0.0;
  for (const DriveStep& s : log.steps) {
    if (maps::distance(maps::position_of(s.true_pose), goal) >= kAtGoalM) continue;
    if (std::abs(s.true_twist.omega) < kTurningRadS) continue;
    reversals += s.true_twist.omega * last < 0.0 ? 1 : 0;
    last = s.true_twist.omega;
  }
  return reversals;
}

/// Second difference of the commanded speed, averaged over windows so that the steps of a sampled
/// command do not count as jerk.
double jerk_rms(const DriveLog& log) {
  constexpr double kWindowS = 0.1;
  std::vector<double> mean;
  double sum = 0.0, until = log.steps.front().time_s + kWindowS;
  int count = 0;
  for (const DriveStep& step : log.steps) {
    if (step.time_s >= until - 1e-9 && count > 0) {
      mean.push_back(sum / count);
      sum = 0.0;
      count = 0;
      until += kWindowS;
    }
    sum += step.command.vx;
    ++count;
  }
  Spread jerk;
  for (std::size_t i = 2; i < mean.size(); ++i) {
    jerk.add((mean[i] - 2.0 * mean[i - 1] + mean[i - 2]) / (kWindowS * kWindowS));
  }
  return jerk.rms();
}

double success_by_length(const DriveLog& log, const DriveMetrics& m) {
  if (log.status != TrackStatus::kReached || log.contact_events > 0) return 0.0;
  const double longer = std::max(m.driven_length_m, m.path_length_m);
  return longer > 0.0 ? m.path_length_m / longer : 1.0;
}

}  // namespace

double cross_track_error_m(const planning::Trajectory& planned, const TPoint2D& point) {
  assert(!planned.points.empty());
  const auto& points = planned.points;
  const TPoint2D first = maps::position_of(points.front().pose);
  double best_squared = std::numeric_limits<double>::infinity();
  double sign = 1.0;
  const auto consider = [&](const TPoint2D& a, const TPoint2D& b) {
    const double dx = b.x - a.x, dy = b.y - a.y;
    const double px = point.x - a.x, py = point.y - a.y;
    const double length_squared = dx * dx + dy * dy;
    const double f =
        length_squared > 0.0 ? std::clamp((px * dx + py * dy) / length_squared, 0.0, 1.0) : 0.0;
    const double ex = px - f * dx, ey = py - f * dy;
    const double squared = ex * ex + ey * ey;
    if (squared >= best_squared) return;
    best_squared = squared;
    sign = dx * py - dy * px < 0.0 ? -1.0 : 1.0;
  };
  consider(first, first);
  for (std::size_t i = 1; i < points.size(); ++i) {
    const TPoint2D a = maps::position_of(points[i - 1].pose);
    const TPoint2D b = maps::position_of(points[i].pose);
    if (a.x != b.x || a.y != b.y) consider(a, b);
  }
  return sign * std::sqrt(best_squared);
}

DriveMetrics measure(const DriveLog& log, const planning::Trajectory& planned, const TPose2D& goal,
                     bool goal_heading_given, const CommandLimits& limits) {
  DriveMetrics m;
  m.goal_heading_given = goal_heading_given;
  m.path_length_m = planning::length_m(planned);
  m.planned_duration_s = planned.duration_s();
  if (log.steps.empty()) return m;

  Spread cross, along_track, heading, estimate, speed;
  std::size_t saturated = 0;
  const DriveStep* previous = nullptr;
  for (const DriveStep& step : log.steps) {
    const TPoint2D position = maps::position_of(step.true_pose);
    if (!planned.points.empty()) cross.add(cross_track_error_m(planned, position));
    along_track.add(along(step.reference.pose, step.true_pose));
    heading.add(wrap_angle(step.true_pose.phi - step.reference.pose.phi));
    if (step.quality != PoseQuality::kLost && maps::is_finite(step.estimated_pose)) {
      estimate.add(maps::distance(position, maps::position_of(step.estimated_pose)));
    }
    speed.add(step.true_twist.vx - step.command.vx);
    saturated += is_saturated(step.command, limits) ? 1 : 0;
    m.max_speed_m_s = std::max(m.max_speed_m_s, std::abs(step.command.vx));
    m.max_yaw_rate_rad_s = std::max(m.max_yaw_rate_rad_s, std::abs(step.command.omega));
    if (previous) {
      m.driven_length_m += maps::distance(maps::position_of(previous->true_pose), position);
    }
    previous = &step;
  }

  const DriveStep& last = log.steps.back();
  m.duration_s = last.time_s - log.steps.front().time_s;
  m.cross_track_rms_m = cross.rms();
  m.cross_track_max_m = cross.max();
  m.along_track_rms_m = along_track.rms();
  m.along_track_max_m = along_track.max();
  m.heading_rms_rad = heading.rms();
  m.heading_max_rad = heading.max();
  m.estimate_rms_m = estimate.rms();
  m.speed_rms_error_m_s = speed.rms();
  m.saturation_share = static_cast<double>(saturated) / static_cast<double>(log.steps.size());
  m.final_position_error_m =
      maps::distance(maps::position_of(last.true_pose), maps::position_of(goal));
  if (goal_heading_given) {
    m.final_heading_error_rad = std::abs(wrap_angle(last.true_pose.phi - goal.phi));
  }
  if (!planned.points.empty()) measure_arrival(log, planned, m);
  m.goal_reversals = reversals_at(maps::position_of(goal), log);
  m.jerk_rms_m_s3 = jerk_rms(log);
  if (m.planned_duration_s > 0.0) m.time_ratio = m.duration_s / m.planned_duration_s;
  m.spl = success_by_length(log, m);
  return m;
}

}  // namespace rovigo::control
