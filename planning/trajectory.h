#pragma once
// Geometry with time: what control tracks.

#include <vector>

#include "maps/geometry.h"

namespace rovigo::planning {

struct TrajectoryPoint {
  double time_s = 0.0;     ///< since the trajectory's start, increasing
  TPose2D pose;            ///< map_from_base; yaw is the direction of travel
  double speed_m_s = 0.0;  ///< along x of base_link
  double yaw_rate_rad_s = 0.0;
  double curvature_1_m = 0.0;  ///< 0 during in-place turns
};

/// Timed points, dense enough to interpolate linearly (at most 0.05 s apart). In-place turns are
/// points with speed 0 and a yaw rate. Starts and ends at rest unless spliced.
struct Trajectory {
  std::vector<TrajectoryPoint> points;
  double duration_s() const { return points.empty() ? 0.0 : points.back().time_s; }
};

/// The reference at `time_s`: clamped to the ends, yaw interpolated the short way round.
/// Precondition: the trajectory is not empty.
TrajectoryPoint sample(const Trajectory& trajectory, double time_s);

double length_m(const Trajectory& trajectory);

}  // namespace rovigo::planning
