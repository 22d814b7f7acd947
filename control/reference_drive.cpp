#include "control/reference_drive.h"

#include <algorithm>
#include <cmath>

namespace rovigo::control {
namespace {

std::vector<TPoint2D> positions_of(const std::vector<planning::TrajectoryPoint>& points) {
  std::vector<TPoint2D> out;
  out.reserve(points.size());
  for (const auto& p : points) out.push_back(maps::position_of(p.pose));
  return out;
}

}  // namespace

std::vector<planning::TrajectoryPoint> evenly_spaced(const planning::Trajectory& trajectory,
                                                     int segments) {
  const auto& points = trajectory.points;
  std::vector<double> arc(points.size(), 0.0);
  for (std::size_t i = 1; i < points.size(); ++i) {
    arc[i] = arc[i - 1] + maps::distance(maps::position_of(points[i - 1].pose),
                                         maps::position_of(points[i].pose));
  }
  std::vector<planning::TrajectoryPoint> out;
  for (int k = 0; k <= segments; ++k) {
    const double at = arc.back() * k / segments;
    const auto after = std::lower_bound(arc.begin(), arc.end(), at);
    const auto i = static_cast<std::size_t>(std::min(after, arc.end() - 1) - arc.begin());
    const double span = i > 0 ? arc[i] - arc[i - 1] : 0.0;
    const double share = span > 0.0 ? (at - arc[i - 1]) / span : 1.0;
    const double time =
        i > 0 ? points[i - 1].time_s + share * (points[i].time_s - points[i - 1].time_s)
              : points[i].time_s;
    out.push_back(planning::sample(trajectory, time));
  }
  return out;
}

ReferenceDrive::ReferenceDrive(const ReferenceConfig& config,
                               const planning::Trajectory& trajectory, double time_limit_s)
    : ReferenceDrive(config, evenly_spaced(trajectory, kSegments), time_limit_s) {}

ReferenceDrive::ReferenceDrive(const ReferenceConfig& config,
                               std::vector<planning::TrajectoryPoint> waypoints,
                               double time_limit_s)
    : waypoints_(std::move(waypoints)),
      law_(config, positions_of(waypoints_)),
      time_limit_s_(time_limit_s) {
  last_.reference = waypoints_.front();
}

TrackerOutput ReferenceDrive::step(double now_s, const PoseInput& pose) {
  if (last_.status != TrackStatus::kRunning) return last_;
  pass_time(now_s);
  if (now_s - start_s_ > time_limit_s_) {
    last_.status = TrackStatus::kTimedOut;
    last_.command = {};
    return last_;
  }
  const bool usable = pose.quality != PoseQuality::kLost && maps::is_finite(pose.map_from_base);
  if (now_s + 1e-9 < next_step_s_ || !usable) return last_;
  next_step_s_ = std::max(next_step_s_ + ReferenceController::kStepS, now_s);
  const ReferenceController::Output out = law_.step(pose.map_from_base);
  last_.command = out.command;
  last_.heading_error_rad = out.heading_error_rad;
  last_.reference = waypoints_[std::min(out.waypoint, waypoints_.size() - 1)];
  if (out.finished) last_.status = TrackStatus::kReached;
  return last_;
}

TrackerOutput ReferenceDrive::hold(double now_s) {
  const double before_s = last_s_;
  pass_time(now_s);
  start_s_ += last_s_ - std::min(before_s, last_s_);
  next_step_s_ = now_s;
  last_.command = {};
  return last_;
}

void ReferenceDrive::pass_time(double now_s) {
  if (!started_) {
    started_ = true;
    start_s_ = next_step_s_ = now_s;
  }
  last_s_ = now_s;
}

}  // namespace rovigo::control
