#pragma once
// From a commanded twist to the wheels: mixing, wheel speed loop, motor limits, stiction, slip.

#include "maps/geometry.h"
#include "maps/robot_model.h"
#include "sim/random.h"
#include "sim/rover.h"
#include "sim/scenario.h"

namespace rovigo::sim {

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
  /// The speed loop of one side's wheels.
  struct SpeedLoop {
    double wanted_m_s = 0.0;  ///< the target behind its first-order lag
    double trim_m_s = 0.0;    ///< integral action
  };
  SideDrive drive_side(double target_m_s, double measured_rad_s, double grip, double dt_s,
                       SpeedLoop& loop) const;
  void update_slip(double time_s);

  MotorModel motor_;
  WheelNoise wheels_;
  maps::RobotModel robot_;
  RandomStream slip_random_;
  SpeedLoop left_loop_;
  SpeedLoop right_loop_;
  double next_slip_s_ = 0.0;
  double slip_end_s_ = 0.0;
  double slip_grip_ = 1.0;
  bool slip_on_left_ = false;
  std::vector<std::pair<double, TTwist2D>> delayed_;
};

}  // namespace rovigo::sim
