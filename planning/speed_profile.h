#pragma once
// How fast along one curve: the quickest speeds that the rover's limits allow.

#include <functional>
#include <optional>
#include <vector>

#include "planning/timing.h"

namespace rovigo::planning {

/// Speeds at points along a curve; between two points the acceleration is constant.
struct SpeedProfile {
  std::vector<double> parameter;
  std::vector<double> distance_m;  ///< along the curve
  std::vector<double> speed_m_s;
};

/// Time-optimal path parameterisation by reachability (Pham & Pham 2018, TOPP-RA) on points about a
/// centimetre apart. With x = v^2 and the acceleration a, all limits are linear in (a, x): speed,
/// turn rate, wheel speed and lateral acceleration bound x; acceleration bounds a; the turn rate
/// v kappa changes by kappa a + kappa' x, which the yaw acceleration bounds. A pass from the end
/// finds the speeds from which rest at the end can be reached, a pass from the start takes the
/// highest of them. nullopt when the start speed is not among them.
std::optional<SpeedProfile> speed_profile(const PathPiece& piece, double start_speed_m_s,
                                          const std::function<double(const TPoint2D&)>& room_m,
                                          const MotionLimits& limits, const TimingConfig& config);

}  // namespace rovigo::planning
