#pragma once
// The control law of the rover thesis, kept exactly as published, faults included, so that users
// can compare. For driving, use TrajectoryTracker.

#include <vector>

#include "maps/geometry.h"
#include "maps/settings.h"

namespace rovigo::control {

/// Gains and limits as reported for the thesis's experiment (mission R10).
struct ReferenceConfig {
  double heading_kp = 0.75;
  double heading_ki = 0.1;
  double speed_kp = 1.0;
  double speed_ki = 0.01;
  double integral_limit = 10.0;
  double max_speed_m_s = 0.25;
  double max_yaw_rate_rad_s = 0.4;
  double waypoint_tolerance_m = 0.15;
  double turn_first_angle_rad = 0.5235987755982988;  // 30 deg
  int skipped_points = 10;

  void describe(maps::SettingsVisitor& v);
};

/// Two uncoupled PI loops, heading and distance to the next waypoint. What is wrong with it, and
/// stays so: the heading error is not wrapped; the sign of the speed comes from the x axis alone,
/// so goals at smaller x are driven away from; the integrators know no time step (the loop is meant
/// to run at 100 Hz) and, being scaled by their gain each time, forget at once; near a waypoint the
/// bearing is unstable; the last point of the path is never steered to.
/// The listing declares the turn-first angle without using it; here it withholds the speed, as the
/// text has it.
class ReferenceController {
 public:
  static constexpr double kStepS = 0.01;

  struct Output {
    TTwist2D command;
    bool finished = false;
    double heading_error_rad = 0.0;  ///< not wrapped
    double position_error_m = 0.0;   ///< signed by the x axis
    std::size_t waypoint = 0;        ///< steered to now
  };

  ReferenceController(const ReferenceConfig& config, std::vector<TPoint2D> path);

  /// To be called 100 times a second.
  Output step(const TPose2D& map_from_base);

 private:
  /// The thesis's PI: I = clamp(ki * (e + I)); u = kp * e + I.
  struct Pi {
    double kp, ki, limit;
    double integral = 0.0;
    double update(double error);
  };

  ReferenceConfig config_;
  std::vector<TPoint2D> path_;
  std::size_t waypoint_;
  Pi heading_;
  Pi speed_;
};

}  // namespace rovigo::control
