#pragma once
// Where the rover is now, from a pose that is old and the commands given since.

#include <deque>

#include "maps/geometry.h"

namespace rovigo::control {

/// What is assumed of the drive: a first-order lag behind a dead time, and stiction.
struct DriveModel {
  double lag_s = 0.06;
  double command_delay_s = 0.0;
  double dead_zone_m_s = 0.0;  ///< rim speed that a standing wheel needs to start
  double track_width_m = 0.358;
};

/// Dead reckoning on commands with the drive's model and a gain on turns (the wheels scrub). Poses
/// correct it at the time they held.
class PosePredictor {
 public:
  explicit PosePredictor(const DriveModel& drive) : drive_(drive) {}

  /// Brings the model up to `now_s` under the present command. Time never runs backwards.
  void advance(double now_s);
  /// The command in force from the last advance() on.
  void set_command(const TTwist2D& command) { command_ = command; }

  /// Takes `pose` as the truth at `time_s`.
  void reset(double time_s, const TPose2D& pose);
  /// Moves the estimate at `time_s` by `share` (0..1) of its difference to `pose`.
  void correct(double time_s, const TPose2D& pose, double share);

  /// The estimate at `time_s`; beyond the modelled time the drive is taken to keep its twist.
  TPose2D at(double time_s) const;
  /// The modelled twist at the end of the modelled time, turn gain included.
  TTwist2D twist() const;
  /// Turn that the commands asked for between two times, without the turn gain, radians.
  double asked_turn(double from_s, double to_s) const;

  void set_turn_gain(double gain) { turn_gain_ = gain; }
  /// Sideways motion while the wheels roll: what of this, over the map, lies along the axles.
  void set_side_drift(const TPoint2D& m_s) { side_drift_ = m_s; }
  /// For how long the wheels rolled between two times, seconds.
  double rolled_s(double from_s, double to_s) const;
  /// The wheels were found standing, whatever was modelled.
  void stop() { modelled_ = {}; }
  void set_dead_zone(double rim_m_s) { drive_.dead_zone_m_s = rim_m_s; }
  double anchor_time_s() const { return anchor_time_s_; }

 private:
  /// Mean modelled twist between two times.
  struct Motion {
    double from_s;
    double to_s;
    TTwist2D twist;
  };
  static constexpr double kMemoryS = 2.0;

  TTwist2D what_the_wheels_follow() const;
  bool rolls(const TTwist2D& twist) const;
  TPose2D moved(const TPose2D& pose, const TTwist2D& twist, double dt_s) const;

  DriveModel drive_;
  double turn_gain_ = 1.0;
  TPoint2D side_drift_{0.0, 0.0};
  bool started_ = false;
  double now_s_ = 0.0;
  TTwist2D command_;
  TTwist2D modelled_;  ///< at now_s_ + delay_s_
  std::deque<Motion> motions_;
  double anchor_time_s_ = 0.0;
  TPose2D anchor_;
};

}  // namespace rovigo::control
