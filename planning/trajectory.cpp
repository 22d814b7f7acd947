#include "planning/trajectory.h"

#include <algorithm>
#include <cassert>

namespace rovigo::planning {

TrajectoryPoint sample(const Trajectory& trajectory, double time_s) {
  const auto& points = trajectory.points;
  assert(!points.empty());
  if (time_s <= points.front().time_s) return points.front();
  if (time_s >= points.back().time_s) return points.back();
  const auto after =
      std::upper_bound(points.begin(), points.end(), time_s,
                       [](double t, const TrajectoryPoint& p) { return t < p.time_s; });
  const TrajectoryPoint& a = *(after - 1);
  const TrajectoryPoint& b = *after;
  const double span = b.time_s - a.time_s;
  const double f = span > 0.0 ? (time_s - a.time_s) / span : 0.0;
  const auto mix = [f](double from, double to) { return from + f * (to - from); };
  TrajectoryPoint out;
  out.time_s = time_s;
  out.pose = {mix(a.pose.x, b.pose.x), mix(a.pose.y, b.pose.y),
              maps::wrap_angle(a.pose.phi + f * maps::wrap_angle(b.pose.phi - a.pose.phi))};
  out.speed_m_s = mix(a.speed_m_s, b.speed_m_s);
  out.yaw_rate_rad_s = mix(a.yaw_rate_rad_s, b.yaw_rate_rad_s);
  out.curvature_1_m = mix(a.curvature_1_m, b.curvature_1_m);
  return out;
}

double length_m(const Trajectory& trajectory) {
  double length = 0.0;
  for (std::size_t i = 1; i < trajectory.points.size(); ++i) {
    length += maps::distance(maps::position_of(trajectory.points[i - 1].pose),
                             maps::position_of(trajectory.points[i].pose));
  }
  return length;
}

}  // namespace rovigo::planning
