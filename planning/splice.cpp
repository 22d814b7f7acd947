#include "planning/splice.h"

#include <algorithm>
#include <cmath>

namespace rovigo::planning {

namespace {

constexpr double kStandingM_s = 1e-3;  // slower is standing
constexpr double kSameHeadingRad = 1e-6;
constexpr double kSameCurvature = 1e-6;
constexpr double kSameTimeS = 1e-6;
constexpr double kSamePointM = 1e-6;
constexpr int kAttempts = 3;  // each with control points twice as far apart: a gentler beginning

bool continues(const PathPiece& piece, const TrajectoryPoint& from, double curvature) {
  const CurvePoint begin = piece.curve.at(piece.curve.begin());
  return std::abs(maps::wrap_angle(begin.heading() - from.pose.phi)) < kSameHeadingRad &&
         std::abs(begin.curvature() - curvature) < kSameCurvature * (1.0 + std::abs(curvature));
}

}  // namespace

SpliceResult splice(const FreeSpace& space, const SpliceProblem& problem,
                    const SplineConfig& spline, const MotionLimits& limits,
                    const TimingConfig& timing) {
  TrajectoryPoint from = sample(problem.running, problem.time_s);
  const TPoint2D position = maps::position_of(from.pose);
  const bool moves = from.speed_m_s > kStandingM_s;
  const double curvature = moves ? from.yaw_rate_rad_s / from.speed_m_s : 0.0;

  SmoothingProblem smoothing;
  smoothing.polyline.points.push_back(position);
  for (std::size_t i = 1; i < problem.way.points.size(); ++i) {
    const TPoint2D& p = problem.way.points[i];
    if (maps::distance(smoothing.polyline.points.back(), p) > kSamePointM) {
      smoothing.polyline.points.push_back(p);
    }
  }
  TimingProblem timed;
  timed.at = position;
  timed.start_heading_rad = from.pose.phi;
  timed.goal_heading_rad = problem.goal_heading_rad;
  timed.start_yaw_rate_rad_s = from.yaw_rate_rad_s;
  timed.room_m = [&space](const TPoint2D& p) { return space.slope(p).room_m; };
  if (moves) {
    timed.start_speed_m_s = from.speed_m_s;
    smoothing.start_heading_rad = from.pose.phi;
    smoothing.start_curvature_1_m = curvature;
  }
  if (!is_free(space, smoothing.polyline))
    return {.status = SpliceStatus::kNoRoom, .trajectory = {}};
  SpliceResult result;
  SplineConfig gentler = spline;
  for (int attempt = 0; attempt < kAttempts; ++attempt, gentler.control_spacing_m *= 2.0) {
    if (smoothing.polyline.points.size() > 1) timed.pieces = smooth(space, smoothing, gentler);
    if (moves && (timed.pieces.empty() || !continues(timed.pieces.front(), from, curvature))) {
      continue;
    }
    result.trajectory = time_path(timed, limits, timing);
    result.status = result.trajectory.points.empty() ? SpliceStatus::kTooFast : SpliceStatus::kOk;
    if (result.status == SpliceStatus::kOk) break;
  }
  return result;
}

Trajectory joined(const Trajectory& running, double time_s, const Trajectory& next) {
  Trajectory out;
  for (const TrajectoryPoint& p : running.points) {
    if (p.time_s < time_s - kSameTimeS) out.points.push_back(p);
  }
  for (TrajectoryPoint p : next.points) {
    p.time_s += time_s;
    out.points.push_back(p);
  }
  return out;
}

}  // namespace rovigo::planning
