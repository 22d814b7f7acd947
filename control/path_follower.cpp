#include "control/path_follower.h"

#include <algorithm>
#include <cmath>

#include "control/ramps.h"

namespace rovigo::control {
namespace {

using maps::wrap_angle;

constexpr double kEasyHeadingErrorRad = 0.15;  ///< up to here the rover drives at full speed
constexpr double kEasyOffPathM = 0.03, kFarOffPathM = 0.12;  ///< in between it slows down ...
constexpr double kOffPathShare = 0.4;                        ///< ... to this share of the speed
constexpr double kFadeBeforeStopM = 0.10;  ///< cross-track correction fades out towards a stop
constexpr double kStandingSpeedMS = 0.02;
constexpr double kTurnShare = 0.9;        ///< of the turn limits used, so that feedback has room
constexpr double kCatchUpShare = 0.2;     ///< a late rover may drive this much above plan ...
constexpr double kCatchUpSpeedMS = 0.04;  ///< ... plus this
constexpr double kIntegralShare = 0.3;    ///< the speed integral's authority; none at a stop
constexpr double kSlowestCrabMS = 0.1, kMostCrabRad = 0.3;
constexpr SearchWindow kResumeWindow{.back_m = 0.5, .ahead_m = 1.0};

PiGains heading_gains(const ControlConfig& c) {
  return {c.heading_kp_1_s, c.heading_ki_1_s2, c.anti_windup_time_s};
}
PiGains speed_gains(const ControlConfig& c) {
  return {c.speed_kp_1_s, c.speed_ki_1_s2, c.anti_windup_time_s};
}

}  // namespace

PathFollower::PathFollower(const ControlConfig& config, const DriveLimits& limits,
                           planning::Trajectory trajectory)
    : config_(config),
      limits_(limits),
      legs_(std::move(trajectory)),
      heading_pi_(heading_gains(config)),
      speed_pi_(speed_gains(config)) {
  reference_time_s_ = legs_.trajectory().points.front().time_s;
}

FollowOutput PathFollower::step(const FollowInput& input) {
  if (leg_index_ >= legs_.legs().size()) {
    FollowOutput done;
    done.finished = true;
    done.heading_error_rad = wrap_angle(goal().phi - input.pose.phi);
    return done;
  }
  if (!maps::is_finite(input.pose)) return {};  // standstill is wanted
  const Leg& leg = legs_.legs()[leg_index_];
  return leg.kind == LegKind::kDrive ? drive(leg, input) : turn(leg, input);
}

void PathFollower::resume(const TPose2D& pose, double speed_m_s) {
  heading_pi_.reset();
  speed_pi_.reset();
  pace_ = 0.0;
  rest_time_s_ = 0.0;
  if (leg_index_ >= legs_.legs().size()) return;
  const Leg& leg = legs_.legs()[leg_index_];
  turn_begin_.reset();
  drifted_m_ = 0.0;
  if (leg.kind == LegKind::kTurn) return;  // the turn's pace waits for the heading by itself
  const PathPlace place = legs_.project(maps::position_of(pose), leg, arc_m_, kResumeWindow);
  arc_m_ =
      std::clamp(place.arc_m, legs_.arc_at_time(legs_.start_time_s(leg)), legs_.end_arc_m(leg));
  reference_time_s_ = place.time_s;
  const double planned = reference().speed_m_s;
  if (planned > kStandingSpeedMS) {
    pace_ = std::clamp(speed_m_s / planned, 0.0, 1.0);
  } else {
    pace_ = 1.0;  // near a rest the plan's own speed is slow enough
  }
}

planning::TrajectoryPoint PathFollower::reference() const {
  return planning::sample(legs_.trajectory(), reference_time_s_);
}

void PathFollower::next_leg() {
  const Leg& done = legs_.legs()[leg_index_];
  reference_time_s_ = legs_.end_time_s(done);
  arc_m_ = legs_.end_arc_m(done);
  ++leg_index_;
  pace_ = 1.0;  // a leg starts at rest, so full pace is no jump
  rest_time_s_ = 0.0;
  turning_first_ = false;
  turn_begin_.reset();
  drifted_m_ = 0.0;
  nudge_.reset();
  heading_pi_.reset();
  speed_pi_.reset();
}

/// `rate_limit`: change of pace per second that keeps the feed-forward within its acceleration.
void PathFollower::advance_reference(const Leg& leg, double pace_wanted, double rate_limit,
                                     double dt_s) {
  const double dt = dt_s > 0.0 ? std::min(dt_s, PiController::kLongestStepS) : 0.0;
  pace_ += std::clamp(pace_wanted - pace_, -rate_limit * dt, rate_limit * dt);
  const double end = legs_.end_time_s(leg);
  reference_time_s_ = std::min(reference_time_s_ + pace_ * dt, end);
  if (reference_time_s_ >= end) rest_time_s_ += dt;
}

/// Heading per metre of cross-track error: constant in time where the speed allows it, so that the
/// loop is equally far from its stability limit at every speed.
double PathFollower::approach_gain(double speed) const {
  const double cap = config_.cross_track_max_gain_1_m;
  return speed * cap > config_.cross_track_rate_1_s ? config_.cross_track_rate_1_s / speed : cap;
}

PathFollower::Approach PathFollower::approach(const PathPlace& place, double heading_error,
                                              double remaining, double speed) const {
  // Fades out just before a stop, so that the rover ends along the path.
  const double gain = approach_gain(speed) * std::clamp(remaining / kFadeBeforeStopM, 0.0, 1.0);
  const double steepest = config_.max_approach_angle_rad;
  const double bend = std::tanh(gain * place.cross_track_m / steepest);
  const double speed_across = speed * std::sin(-heading_error);
  return {-steepest * bend, -gain * (1.0 - bend * bend) * speed_across};
}

/// Where the floor slides the rover aside, it has to point against that.
double PathFollower::crab(double path_heading, double remaining, const FollowInput& in) const {
  const double aside =
      in.side_drift_m_s.y * std::cos(path_heading) - in.side_drift_m_s.x * std::sin(path_heading);
  const double angle = -aside / std::max(in.twist.vx, kSlowestCrabMS);
  return std::clamp(angle, -kMostCrabRad, kMostCrabRad) *
         std::clamp(remaining / kFadeBeforeStopM, 0.0, 1.0);
}

FollowOutput PathFollower::drive(const Leg& leg, const FollowInput& in) {
  const PathPlace place = legs_.project(maps::position_of(in.pose), leg, arc_m_, SearchWindow{});
  arc_m_ = std::min(place.arc_m, legs_.end_arc_m(leg));
  const double remaining = legs_.end_arc_m(leg) - place.arc_m;
  FollowOutput out;
  out.cross_track_error_m = place.cross_track_m;
  out.heading_error_rad = wrap_angle(place.pose.phi - in.pose.phi);

  if (std::abs(place.cross_track_m) > config_.max_off_path_m) {
    pace_ = 0.0;
    speed_pi_.reset();
    return out;  // standstill is wanted
  }
  if (has_arrived(leg, remaining)) {
    advance_reference(leg, 1.0, limits_.max_acceleration_m_s2, in.dt_s);
    if (std::abs(in.twist.vx) < kStandingSpeedMS) next_leg();
    return out;  // standstill is wanted
  }
  const Approach to_path = approach(place, out.heading_error_rad, remaining, in.twist.vx);
  const double error =
      wrap_angle(out.heading_error_rad + to_path.heading + crab(place.pose.phi, remaining, in));
  if (must_turn_first(error)) {
    pace_ = 0.0;
    speed_pi_.reset();
    out.wanted.omega = turn_in_place(error, 0.0, in);
    return out;
  }
  out.wanted.vx = wanted_speed(leg, place, std::abs(error), in);
  const double curvature =
      legs_.at_arc(arc_m_ + in.twist.vx * config_.drive_lag_s, leg).curvature_1_m;
  const double stretch = std::clamp(1.0 - curvature * place.cross_track_m, 0.5, 2.0);
  const double path_turn = out.wanted.vx * curvature * std::cos(out.heading_error_rad) / stretch;
  const double feed_forward = path_turn + to_path.heading_rate;
  out.wanted.vx *= steering_room(feed_forward + config_.heading_kp_1_s * error, in);
  out.wanted.omega = steer(stoppable_error(error), feed_forward, 0.05 + 0.5 * in.twist.vx, in);
  return out;
}

bool PathFollower::has_arrived(const Leg& leg, double remaining) const {
  if (reference_time_s_ < legs_.end_time_s(leg)) return false;
  if (remaining <= config_.fine_tolerance_m) return true;  // also past it: no reversing
  return rest_time_s_ > config_.settle_time_s && remaining <= config_.goal_tolerance_m;
}

bool PathFollower::must_turn_first(double error) {
  if (std::abs(error) > config_.turn_first_angle_rad) turning_first_ = true;
  if (std::abs(error) < config_.turn_done_angle_rad) turning_first_ = false;
  return turning_first_;
}

double PathFollower::wanted_speed(const Leg& leg, const PathPlace& place, double heading_error,
                                  const FollowInput& in) {
  const double end_time = legs_.end_time_s(leg);
  const double lead = std::min(reference_time_s_ + config_.drive_lag_s, end_time);
  const double planned = std::max(0.0, planning::sample(legs_.trajectory(), lead).speed_m_s);
  const double remaining = legs_.end_arc_m(leg) - place.arc_m;
  const double lag = legs_.arc_at_time(reference_time_s_) - place.arc_m;
  const double off_path = falling(std::abs(place.cross_track_m), kEasyOffPathM, kFarOffPathM);
  const double care = falling(heading_error, kEasyHeadingErrorRad, config_.turn_first_angle_rad) *
                      (kOffPathShare + (1.0 - kOffPathShare) * off_path);

  // Where scrubbing eats turn rate, a curve planned at the turn limit must be driven slower.
  const double bend = std::abs(place.curvature_1_m);
  const double curve_cap = bend > 0.0
                               ? kTurnShare * limits_.max_yaw_rate_rad_s * in.turn_gain / bend
                               : limits_.max_speed_m_s;
  const double cap = std::min({in.speed_cap_m_s, curve_cap, limits_.max_speed_m_s});

  double pace = falling(lag, config_.lag_slowdown_m, config_.lag_stop_m) * care;
  if (planned > 0.0) pace = std::min(pace, cap / planned);
  advance_reference(leg, pace, limits_.max_acceleration_m_s2 / std::max(planned, kStandingSpeedMS),
                    in.dt_s);

  const double feed_forward = pace_ * planned;
  const double catch_up = kCatchUpShare * planned + kCatchUpSpeedMS;
  const double braking = braking_speed(remaining, limits_.max_acceleration_m_s2);
  return care * speed_pi_.update({.error = lag,
                                  .feed_forward = feed_forward,
                                  .dt_s = in.dt_s,
                                  .min = 0.0,
                                  .max = std::min({cap, feed_forward + catch_up, braking}),
                                  .integral_limit = kIntegralShare * feed_forward});
}

}  // namespace rovigo::control
