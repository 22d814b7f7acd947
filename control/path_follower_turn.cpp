// The law of motion's turning half: how hard to steer, and turns in place.

#include <algorithm>
#include <cmath>

#include "control/path_follower.h"
#include "control/ramps.h"

namespace rovigo::control {
namespace {

using maps::wrap_angle;

constexpr double kStandingTurnRateRadS = 0.05;
constexpr double kTurnShare = 0.9;     ///< of the turn limits used, so that feedback has room
constexpr double kEasyTurnRad = 0.15;  ///< a turn's reference waits from this heading error on ...
constexpr double kLostTurnRad = 0.4;   ///< ... and stands from this
constexpr double kNearEnoughToDriveRad = 0.03;             ///< the leg that follows steers anyway
constexpr double kEasySlideM = 0.015, kFarSlideM = 0.035;  ///< poses' noise is no slide
constexpr double kNoDriftMS = 0.01, kSlopeDriftMS = 0.02;
constexpr double kGentleShare = 0.4;  ///< of the planned turn rate
constexpr double kNudgeRad = 0.2;     ///< up to here a standing rover is nudged, not steered
constexpr double kLeastHoldRateRadS = 0.3, kHoldSlack = 0.15;  ///< rad; keeps noise from mattering

}  // namespace

/// A proportional loop asks for more turning than it can stop again when the error is large; what
/// it swings back over grows from swing to swing. Beyond what the acceleration allows the response
/// grows with the root only; half of it is left for what comes late.
double PathFollower::stoppable_error(double error) const {
  const double kp = config_.heading_kp_1_s, a = 0.5 * limits_.max_yaw_acceleration_rad_s2;
  const double linear = a / (kp * kp);
  if (std::abs(error) <= linear) return error;
  return std::copysign(braking_speed(std::abs(error) - linear / 2, a) / kp, error);
}

/// 1 while the turn asked for can be had; below that, the share of speed at which the path's
/// curvature leaves enough of the turn limit to come back.
double PathFollower::steering_room(double turn_rate, const FollowInput& in) const {
  constexpr double kLeast = 0.3;
  const double reach = limits_.max_yaw_rate_rad_s * in.turn_gain;
  const double asked = std::abs(turn_rate);
  return asked > reach ? std::max(kLeast, reach / asked) : 1.0;
}

double PathFollower::steer(double error, double feed_forward, double integral_limit,
                           const FollowInput& in) {
  const double reach = limits_.max_yaw_rate_rad_s * in.turn_gain;
  return heading_pi_.update({.error = error,
                             .feed_forward = feed_forward,
                             .dt_s = in.dt_s,
                             .min = -reach,
                             .max = reach,
                             .integral_limit = integral_limit}) /
         in.turn_gain;
}

/// A large turn is braked in time: the turn rate never exceeds what can still be stopped.
double PathFollower::turn_in_place(double error, double feed_forward, const FollowInput& in) {
  // Near half a turn noise flips the error's sign; the turn under way decides the direction.
  constexpr double kAmbiguousRad = 2.8;
  double to_go = error;
  if (std::abs(error) > kAmbiguousRad && error * in.twist.omega < 0.0 &&
      std::abs(in.twist.omega) > kStandingTurnRateRadS) {
    to_go = error - std::copysign(2.0 * maps::kPi, error);
  }
  const double stoppable =
      braking_speed(std::abs(to_go), kTurnShare * limits_.max_yaw_acceleration_rad_s2);
  const double rate = steer(to_go, feed_forward, 0.1 + 0.2 * std::abs(feed_forward), in);
  return std::clamp(rate, -std::max(stoppable, std::abs(feed_forward)),
                    std::max(stoppable, std::abs(feed_forward)));
}

FollowOutput PathFollower::turn(const Leg& leg, const FollowInput& in) {
  const double end = legs_.end_time_s(leg);
  const auto& trajectory = legs_.trajectory();
  const planning::TrajectoryPoint now = planning::sample(trajectory, reference_time_s_);
  const double ahead = std::min(reference_time_s_ + config_.drive_lag_s, end);
  const double planned = ahead < end ? planning::sample(trajectory, ahead).yaw_rate_rad_s : 0.0;

  FollowOutput out;
  const double error = wrap_angle(now.pose.phi - in.pose.phi);
  out.heading_error_rad = error;
  const double near_enough =
      &leg == &legs_.legs().back() ? config_.fine_heading_tolerance_rad : kNearEnoughToDriveRad;
  const bool close =
      std::abs(error) <= near_enough && std::abs(in.twist.omega) < kStandingTurnRateRadS;
  const bool long_enough = !nudge_.is_pushing() && rest_time_s_ > config_.settle_time_s &&
                           std::abs(error) <= config_.goal_heading_tolerance_rad;
  if (reference_time_s_ >= end && (close || long_enough)) {
    next_leg();
    return out;
  }
  const double behind = error * planned >= 0.0 ? std::abs(error) : 0.0;
  const double pace =
      turning_share(in) * falling(std::abs(error) > kLostTurnRad ? std::abs(error) : behind,
                                  kEasyTurnRad, kLostTurnRad);
  advance_reference(
      leg, pace,
      limits_.max_yaw_acceleration_rad_s2 / std::max(std::abs(planned), kStandingTurnRateRadS),
      in.dt_s);
  const bool stands = std::abs(in.twist.omega) < kStandingTurnRateRadS;
  const bool nearly = reference_time_s_ >= end && std::abs(error) < kNudgeRad;
  if (nudge_.is_pushing() || (nearly && stands)) {
    out.wanted.omega = nudge_.step(error, in.dt_s, in.dead_zone_m_s, in.turn_gain, limits_);
    return out;
  }
  out.wanted.omega = turn_in_place(error, pace_ * planned, in);
  out.wanted.vx = hold_place(leg, pace_ * planned, in);
  return out;
}

/// Of the planned turn rate. A turn that slides off its place goes on gently, and so do those after
/// it: the faster the tyres scrub, the sooner those on slippery ground let go while the others
/// hold. Not so where a slope takes the rover aside all the time: there a longer turn slides
/// farther.
double PathFollower::turning_share(const FollowInput& in) {
  const double drift = std::hypot(in.side_drift_m_s.x, in.side_drift_m_s.y);
  const TPoint2D here = maps::position_of(in.pose);
  if (!turn_begin_) turn_begin_ = here;
  drifted_m_ += drift * std::max(in.dt_s, 0.0);
  const double slid = maps::distance(*turn_begin_, here) - drifted_m_;
  const double share = falling(slid, kEasySlideM, kFarSlideM);
  gentleness_ = std::min(gentleness_, kGentleShare + (1.0 - kGentleShare) * share);
  return 1.0 - (1.0 - gentleness_) * falling(drift, kNoDriftMS, kSlopeDriftMS);
}

/// A turn slides off its place: wheels slip, floors slope. Of all speeds forwards and backwards
/// over the rest of the turn that bring it back there by its end, what is known of the sliding
/// included, these are the slowest ones (least squares: a speed along t(angle) that is t * lambda).
double PathFollower::hold_place(const Leg& leg, double turn_rate, const FollowInput& in) const {
  const TPose2D& end = legs_.trajectory().points[leg.last].pose;
  double to_go = wrap_angle(end.phi - in.pose.phi);
  if (to_go * turn_rate < 0.0 && std::abs(to_go) > maps::kPi / 2) {
    to_go += std::copysign(2.0 * maps::kPi, turn_rate);
  }
  const double from = in.pose.phi, to = from + to_go, size = std::abs(to_go);
  // M = integral of t t' over the angles to come.
  const double side = to_go < 0.0 ? -1.0 : 1.0;
  const double wave = side * (std::sin(2 * to) - std::sin(2 * from)) / 4.0;
  const double xy = -side * (std::cos(2 * to) - std::cos(2 * from)) / 4.0;
  const double xx = size / 2 + wave, yy = size / 2 - wave;
  const double rate = std::max(std::abs(turn_rate), kLeastHoldRateRadS);
  const TPoint2D& d = in.side_drift_m_s;
  const double bx = rate * (end.x - in.pose.x) - ((size - xx) * d.x - xy * d.y);
  const double by = rate * (end.y - in.pose.y) - ((size - yy) * d.y - xy * d.x);
  const double mx = xx + kHoldSlack, my = yy + kHoldSlack;
  const double determinant = mx * my - xy * xy;
  const double lx = (my * bx - xy * by) / determinant, ly = (mx * by - xy * bx) / determinant;
  const double most = std::min(limits_.max_reverse_speed_m_s, in.speed_cap_m_s);
  return std::clamp(lx * std::cos(from) + ly * std::sin(from), -most, most);
}

}  // namespace rovigo::control
