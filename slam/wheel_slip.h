#pragma once
// What the wheels say of the way, with slip taken off: gyro and accelerometer are the witnesses.

#include "slam/inertial_state.h"
#include "slam/slam_config.h"

namespace rovigo::slam {

/// What the wheels added up between two readings.
struct WheelStep {
  double dt = 0.0, distance_m = 0.0, turn_rad = 0.0;
};

/// Who else can say how the body moved during a step, and what.
struct SlipWitnesses {
  bool gyro = false, accelerometer = false;
  double gyro_turn_rad = 0.0;  ///< unbiased, since the last reading of the wheels
  double resting_s = 0.0;      ///< without a tick of the wheels, before this step
  bool standing = false;
};

/// Where wheels and gyro disagree on the turn rate a wheel slips, and the speed follows the wheel
/// that grips; where wheels and accelerometer disagree on a change of speed both slip, and the
/// accelerometer is followed.
class WheelSlip {
 public:
  explicit WheelSlip(const DeadReckoningConfig& config) : config_(config) {}

  /// The accelerometer's speed goes on by so much.
  void feel(double change_m_s) { felt_speed_m_s_ += change_m_s; }
  void feel_rest() { felt_speed_m_s_ = 0.0; }

  /// Judges a step, teaches `state` the wheels' turn scale where nothing slips, its speed where
  /// both sides begin to; returns the distance of what grips, in the wheels' own measure.
  double distance_gripped(const WheelStep& wheels, const SlipWitnesses& witnesses,
                          InertialState& state);

  /// In a turn in place either wheel may be the one that slips: so fast the body may move unseen,
  /// forwards or backwards.
  double unseen_speed_m_s() const { return unseen_speed_m_s_; }
  bool one_side() const { return one_slips_; }
  bool both_sides() const { return both_slip_; }

 private:
  void judge_one_side(const WheelStep& wheels, const SlipWitnesses& witnesses,
                      InertialState& state);
  double judge_both_sides(const WheelStep& wheels, double gripped_m, const SlipWitnesses& witnesses,
                          InertialState& state);

  DeadReckoningConfig config_;
  double disagreement_rad_s_ = 0.0;  ///< wheels minus gyro, smoothed
  double unseen_speed_m_s_ = 0.0;
  double felt_speed_m_s_ = 0.0;  ///< by the accelerometer, drawn to the wheels' slowly
  bool one_slips_ = false, both_slip_ = false;
};

}  // namespace rovigo::slam
