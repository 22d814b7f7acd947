#pragma once
// From a commanded twist to the wheels: mixing, wheel speed loop, motor limits, friction, slip.

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

  struct Input {
    double time_s = 0.0;
    double dt_s = 0.0;
    TTwist2D command;               ///< finite
    double voltage_share = 1.0;     ///< of the battery's nominal voltage
    double left_speed_rad_s = 0.0;  ///< of the wheels, after the last step
    double right_speed_rad_s = 0.0;
  };
  Output step(const Input& in);

 private:
  /// The speed loop of one side's wheels.
  struct SpeedLoop {
    double wanted_m_s = 0.0;  ///< the target behind its first-order lag
    double trim_m_s = 0.0;    ///< integral action
  };
  SideDrive drive_side(const Input& in, double target_m_s, double measured_rad_s, double grip,
                       SpeedLoop& loop) const;
  double motor_torque_nm(double rim_m_s, bool driving, double voltage_share) const;
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
};

}  // namespace rovigo::sim
