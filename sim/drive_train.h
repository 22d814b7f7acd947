#pragma once
// From a commanded twist to the wheels: mixing, wheel speed loop, motor limits, stiction, slip.

#include "maps/geometry.h"
#include "maps/robot_model.h"
#include "sim/random.h"
#include "sim/rover.h"
#include "sim/scenario.h"

namespace rovigo::sim {

/// Four wheels scrub when the rover turns, so it turns less than its wheels say. The distance
/// between two ideal wheels that would turn as it does is the track times this factor, measured on
/// the nominal floor (sim_rover_test checks it). Both the mixer and the odometry use it, as a
/// calibrated real rover does.
inline constexpr double kSkidTrackFactor = 1.030;

inline double effective_track_m(const maps::RobotModel& robot) {
  return robot.track_width_m * kSkidTrackFactor;
}

class DriveTrain {
 public:
  DriveTrain(const MotorModel& motor, const WheelNoise& wheels, const maps::RobotModel& robot,
             std::uint64_t seed);

  struct Output {
    SideDrive left;
    SideDrive right;
    double left_grip = 1.0;  ///< share of the wheel's turning that moves the rover
    double right_grip = 1.0;
  };

  /// `command` at `time_s`; the wheels' measured speeds are those after the last step.
  Output step(double time_s, double dt_s, const TTwist2D& command, double left_speed_rad_s,
              double right_speed_rad_s);

 private:
  SideDrive drive_side(double target_m_s, double measured_rad_s, double grip, double dt_s,
                       double& lagged_m_s) const;
  void update_slip(double time_s);

  MotorModel motor_;
  WheelNoise wheels_;
  maps::RobotModel robot_;
  RandomStream slip_random_;
  double left_lagged_ = 0.0;
  double right_lagged_ = 0.0;
  double next_slip_s_ = 0.0;
  double slip_end_s_ = 0.0;
  double slip_grip_ = 1.0;
  bool slip_on_left_ = false;
  std::vector<std::pair<double, TTwist2D>> delayed_;
};

}  // namespace rovigo::sim
