#pragma once
// The law of motion: from a place near the path to a wanted twist.
//
// Along the path the reference moves by time, at a pace that waits for the rover; a PI loop closes
// the distance. Across the path the nearest point counts, never the reference, so a late rover
// cuts no corner: the cross-track error asks for a heading (approach angle, after Samson 1992), a
// PI loop with the path's own turn rate as feed-forward follows it.

#include <optional>

#include "control/command_limiter.h"
#include "control/control_config.h"
#include "control/pi_controller.h"
#include "control/trajectory_legs.h"
#include "control/turn_nudge.h"

namespace rovigo::control {

inline constexpr double kTurnBackSpeedMS = 0.08;  ///< turns in place return to their place so fast

struct FollowInput {
  TPose2D pose;       ///< estimated, at the time the command takes effect
  TTwist2D twist;     ///< modelled, now
  double dt_s = 0.0;  ///< since the last step
  double speed_cap_m_s = 0.0;
  double turn_gain = 1.0;      ///< real turn per commanded turn, > 0
  double dead_zone_m_s = 0.0;  ///< rim speed that a standing wheel needs to start
  TPoint2D side_drift_m_s{0.0,
                          0.0};  ///< over the map; the rover slides with what lies along its axles
};

struct FollowOutput {
  TTwist2D wanted;                 ///< before acceleration limits
  double heading_error_rad = 0.0;  ///< path's heading minus the rover's
  double cross_track_error_m = 0.0;
  bool finished = false;  ///< every leg is done; the rover stands at the end
};

class PathFollower {
 public:
  PathFollower(const ControlConfig& config, const DriveLimits& limits,
               planning::Trajectory trajectory);

  FollowOutput step(const FollowInput& input);
  /// Goes on after a halt from wherever the rover is now, on the leg it was on, with the speed it
  /// still has.
  void resume(const TPose2D& pose, double speed_m_s);

  planning::TrajectoryPoint reference() const;
  double reference_time_s() const { return reference_time_s_; }
  double arc_m() const { return arc_m_; }
  const TPose2D& goal() const { return legs_.trajectory().points.back().pose; }

 private:
  /// Where the cross-track error wants the heading, relative to the path's, and how that changes.
  struct Approach {
    double heading;
    double heading_rate;
  };

  FollowOutput drive(const Leg& leg, const FollowInput& in);
  FollowOutput turn(const Leg& leg, const FollowInput& in);
  void next_leg();
  void advance_reference(const Leg& leg, double pace_wanted, double rate_limit, double dt_s);
  bool has_arrived(const Leg& leg, double remaining) const;
  bool must_turn_first(double error);
  double approach_gain(double speed) const;
  double turning_share(const FollowInput& in);
  double hold_place(const Leg& leg, double turn_rate, const FollowInput& in) const;
  double crab(double path_heading, double remaining, const FollowInput& in) const;
  Approach approach(const PathPlace& place, double heading_error, double remaining,
                    double speed) const;
  double wanted_speed(const Leg& leg, const PathPlace& place, double heading_error,
                      const FollowInput& in);
  double stoppable_error(double error) const;
  double steering_room(double turn_rate, const FollowInput& in) const;
  double steer(double error, double feed_forward, double integral_limit, const FollowInput& in);
  double turn_in_place(double error, double feed_forward, const FollowInput& in);

  ControlConfig config_;
  DriveLimits limits_;
  TrajectoryLegs legs_;
  PiController heading_pi_;
  PiController speed_pi_;
  TurnNudge nudge_;
  std::size_t leg_index_ = 0;
  double reference_time_s_ = 0.0;
  double pace_ = 1.0;  ///< seconds of trajectory per second
  double arc_m_ = 0.0;
  double rest_time_s_ = 0.0;  ///< spent at the end of the leg
  bool turning_first_ = false;
  std::optional<TPoint2D> turn_begin_;  ///< where the turn under way began
  double drifted_m_ = 0.0;              ///< since then, as the slope explains it
  double gentleness_ = 1.0;             ///< share of the planned rate at which it turns in place
};

}  // namespace rovigo::control
