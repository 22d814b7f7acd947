#include "control/tracker.h"

#include <algorithm>
#include <cmath>

#include "control/approach.h"
#include "control/command_limiter.h"
#include "control/path_follower.h"
#include "control/pose_predictor.h"
#include "control/pose_use.h"
#include "control/progress_monitor.h"
#include "control/side_drift.h"
#include "control/stiction.h"
#include "control/turn_gain.h"
#include "control/watchdog.h"

namespace rovigo::control {
namespace {

using maps::wrap_angle;

constexpr double kStandstillS = 0.3;  ///< at rest this long before "reached" is said
constexpr double kStandingRimSpeedMS = 0.01;
constexpr int kMostApproaches = 6;          ///< second tries at a missed goal
constexpr double kLongestApproachM = 0.30;  ///< a goal missed by more needs a new plan

DriveModel drive_model(const ControlConfig& config, const maps::RobotModel& robot) {
  return {config.drive_lag_s, config.command_delay_s, config.dead_zone_speed_m_s,
          robot.track_width_m};
}

/// Only turns in place go backwards, to keep their place.
DriveLimits tracking_limits(const ControlConfig& config, const maps::RobotModel& robot) {
  DriveLimits limits = drive_limits(config, robot);
  limits.max_reverse_speed_m_s = std::min(kTurnBackSpeedMS, limits.max_speed_m_s);
  return limits;
}

bool at_rest(const TTwist2D& twist) {
  return std::abs(twist.vx) < 0.005 && std::abs(twist.omega) < 0.02;
}

}  // namespace

struct TrajectoryTracker::Impl {
  Impl(const ControlConfig& config_in, const maps::RobotModel& robot,
       planning::Trajectory trajectory)
      : config(config_in),
        limits(tracking_limits(config_in, robot)),
        time_limit_s(config_in.timeout_factor * trajectory.duration_s() +
                     config_in.timeout_extra_s),
        follower(config_in, limits, std::move(trajectory)),
        goal(follower.goal()),
        predictor(drive_model(config_in, robot)),
        stiction(config_in.dead_zone_speed_m_s, robot.track_width_m),
        watchdog(config_in.watchdog_s),
        monitor(config_in.stagnation_time_s) {}

  TrackerOutput step(double now_s, const PoseInput& pose);
  TrackerOutput hold(double now_s);

  double pass_time(double now_s);
  void take_pose(double now_s, const PoseInput& pose);
  bool jumps(const PoseInput& pose) const;
  void correct_estimate(const PoseInput& pose);
  void start_anew();
  TTwist2D follow(double now_s, double dt_s);
  TTwist2D settle(double now_s, const TPose2D& estimate);
  void watch_time(double now_s);
  TrackerOutput emit(const TTwist2D& command);

  ControlConfig config;
  DriveLimits limits;
  double time_limit_s;
  PathFollower follower;
  TPose2D goal;
  PosePredictor predictor;
  TurnGainEstimator turn_gain;
  SideDriftEstimator side_drift;
  StictionEstimator stiction;
  Watchdog watchdog;
  ProgressMonitor monitor;

  TrackStatus status = TrackStatus::kRunning;
  bool started = false;
  double start_s = 0.0;
  double now_last_s = 0.0;
  double last_usable_s = 0.0;  ///< arrival of the last usable pose, or the start
  double newest_pose_s = 0.0;
  bool have_pose = false;
  bool placed = false;           ///< the predictor was put somewhere by a usable pose
  bool jumped_in_doubt = false;  ///< a doubtful pose was elsewhere; only a good one is believed now
  bool halted = true;            ///< standing or slowing down until a usable pose comes
  double speed_cap_m_s = 0.0;
  TTwist2D last_command;
  double standing_since_s = -1.0;  ///< at the end of the trajectory; negative: not there
  double standing_s = 0.0;         ///< for how long the wheels have not turned, as modelled
  int approaches = 0;
  double heading_error_rad = 0.0;
  double cross_track_error_m = 0.0;
};

TrackerOutput TrajectoryTracker::Impl::step(double now_s, const PoseInput& pose) {
  if (status != TrackStatus::kRunning || !std::isfinite(now_s)) return emit({});
  const double dt = pass_time(now_s);
  predictor.advance(now_s);
  stiction.expect(last_command, predictor.twist(), dt);
  take_pose(now_s, pose);
  watch_time(now_s);

  if (status != TrackStatus::kRunning || watchdog.expired(now_s)) {
    halted = true;
    monitor.restart();
    return emit({});  // at once: nobody knows what lies ahead
  }
  const TTwist2D wanted = halted ? TTwist2D() : follow(now_s, dt);
  if (status != TrackStatus::kRunning) return emit({});
  return emit(limited_command(wanted, last_command, dt, limits));
}

TrackerOutput TrajectoryTracker::Impl::hold(double now_s) {
  if (status != TrackStatus::kRunning || !std::isfinite(now_s)) return emit({});
  const double held_s = std::max(0.0, pass_time(now_s));
  start_s += held_s;
  last_usable_s += held_s;
  predictor.set_command({});  // whatever was commanded last did not happen
  predictor.advance(now_s);
  halted = true;
  standing_since_s = -1.0;
  monitor.restart();
  turn_gain.interrupt();
  stiction.interrupt();
  return emit({});
}

/// Seconds since the last call.
double TrajectoryTracker::Impl::pass_time(double now_s) {
  if (!started) {
    started = true;
    start_s = now_last_s = last_usable_s = now_s;
  }
  const double dt = now_s - now_last_s;
  now_last_s = std::max(now_s, now_last_s);
  return dt;
}

void TrajectoryTracker::Impl::take_pose(double now_s, const PoseInput& pose) {
  const PoseUse use = judge_pose(config, now_s, pose);
  const bool repeated = have_pose && pose.time_s <= newest_pose_s;
  if (use == PoseUse::kNotFinite || use == PoseUse::kTooOld || repeated) return;
  have_pose = true;
  newest_pose_s = pose.time_s;
  if (pose.quality == PoseQuality::kGood) {
    jumped_in_doubt = false;
  } else if (use == PoseUse::kDrive && placed && jumps(pose)) {
    jumped_in_doubt = true;
  }
  if (use == PoseUse::kLost || jumped_in_doubt) {
    halted = true;
    monitor.restart();
    turn_gain.interrupt();
    stiction.interrupt();
    return;
  }
  watchdog.feed(now_s);
  last_usable_s = now_s;
  speed_cap_m_s = pose.quality == PoseQuality::kGood
                      ? limits.max_speed_m_s
                      : std::min(limits.max_speed_m_s, config.doubtful_speed_m_s);
  placed = true;
  if (halted) {
    halted = false;
    turn_gain.interrupt();
    stiction.interrupt();
    predictor.reset(pose.time_s, pose.map_from_base);
    follower.resume(predictor.at(now_s + config.command_delay_s), last_command.vx);
  } else {
    correct_estimate(pose);
  }
}

/// Farther than dead reckoning errs: the estimator has found itself elsewhere.
bool TrajectoryTracker::Impl::jumps(const PoseInput& pose) const {
  constexpr double kJumpM = 0.3, kJumpRad = 0.5;
  const TPose2D expected = predictor.at(pose.time_s);
  return maps::distance(maps::position_of(expected), maps::position_of(pose.map_from_base)) >
             kJumpM ||
         std::abs(wrap_angle(pose.map_from_base.phi - expected.phi)) > kJumpRad;
}

void TrajectoryTracker::Impl::correct_estimate(const PoseInput& pose) {
  constexpr double kLeastShare = 0.3;
  const bool jumped = jumps(pose);  // relocalised: taken as it is
  const double sigma = pose.sigma_position_m > 0.0 ? pose.sigma_position_m : 0.0;
  const double share =
      std::max(kLeastShare, config.pose_noise_scale_m / (config.pose_noise_scale_m + sigma));
  if (jumped) {
    turn_gain.interrupt();
    stiction.interrupt();
  }
  if (!jumped && pose.quality == PoseQuality::kGood) {
    side_drift.add(pose.map_from_base, predictor.at(pose.time_s), share,
                   predictor.rolled_s(predictor.anchor_time_s(), pose.time_s));
    predictor.set_side_drift(side_drift.drift_m_s());
  }
  predictor.correct(pose.time_s, pose.map_from_base, jumped ? 1.0 : share);
  if (config.adapt_turn_gain && pose.quality == PoseQuality::kGood) {
    turn_gain.add(pose.time_s, pose.map_from_base.phi, predictor);
    predictor.set_turn_gain(turn_gain.gain());
  }
  if (pose.quality == PoseQuality::kGood) {
    const bool stalled = stiction.pose(pose.map_from_base, sigma);
    predictor.set_dead_zone(stiction.dead_zone_m_s());
    if (stalled) start_anew();
  }
}

/// Wheels that were taken to turn stand: who pushes a standing rover knows how.
void TrajectoryTracker::Impl::start_anew() {
  predictor.stop();
  turn_gain.interrupt();
  monitor.restart();
}

TTwist2D TrajectoryTracker::Impl::follow(double now_s, double dt_s) {
  FollowInput input;
  input.pose = predictor.at(now_s + config.command_delay_s);
  input.twist = predictor.twist();
  input.dt_s = dt_s;
  input.speed_cap_m_s = speed_cap_m_s;
  input.turn_gain = turn_gain.gain();
  input.dead_zone_m_s = stiction.dead_zone_m_s();
  input.side_drift_m_s = side_drift.drift_m_s();
  const bool stands = faster_wheel(input.twist, limits.track_width_m) < kStandingRimSpeedMS;
  standing_s = stands ? standing_s + std::max(dt_s, 0.0) : 0.0;
  const FollowOutput out = follower.step(input);
  heading_error_rad = out.heading_error_rad;
  cross_track_error_m = out.cross_track_error_m;
  if (out.finished) return settle(now_s, input.pose);
  standing_since_s = -1.0;
  if (monitor.stagnated(now_s, {follower.reference_time_s(), follower.arc_m(),
                                std::abs(out.heading_error_rad)})) {
    status = TrackStatus::kNoProgress;
  }
  return with_dead_zone_compensation(out.wanted, standing_s, stiction.dead_zone_m_s(),
                                     limits.track_width_m);
}

/// The trajectory is done: stand still, then look whether this is the goal. A goal that was missed
/// is approached anew by a small plan of turn, straight, turn; never by reversing.
TTwist2D TrajectoryTracker::Impl::settle(double now_s, const TPose2D& estimate) {
  if (!at_rest(predictor.twist()) || !at_rest(last_command))
    standing_since_s = -1.0;
  else if (standing_since_s < 0.0)
    standing_since_s = now_s;
  if (standing_since_s < 0.0 || now_s - standing_since_s < kStandstillS) return {};

  const double missed = maps::distance(maps::position_of(estimate), maps::position_of(goal));
  const double turned = std::abs(wrap_angle(goal.phi - estimate.phi));
  if (missed <= config.goal_tolerance_m && turned <= config.goal_heading_tolerance_rad) {
    status = TrackStatus::kReached;
  } else if (approaches < kMostApproaches && missed <= kLongestApproachM) {
    ++approaches;
    standing_since_s = -1.0;
    monitor.restart();
    follower = PathFollower(config, limits,
                            approach_trajectory(estimate, goal, config.doubtful_speed_m_s,
                                                config.goal_tolerance_m / 2, limits));
  } else {
    status = TrackStatus::kNoProgress;
  }
  return {};
}

void TrajectoryTracker::Impl::watch_time(double now_s) {
  if (now_s - last_usable_s > config.pose_patience_s) status = TrackStatus::kPoseLost;
  if (now_s - start_s > time_limit_s) status = TrackStatus::kTimedOut;
}

TrackerOutput TrajectoryTracker::Impl::emit(const TTwist2D& command) {
  last_command = command;
  predictor.set_command(command);
  TrackerOutput out;
  out.command = command;
  out.status = status;
  out.reference = follower.reference();
  out.heading_error_rad = heading_error_rad;
  out.cross_track_error_m = cross_track_error_m;
  return out;
}

TrajectoryTracker::TrajectoryTracker(const ControlConfig& config, const maps::RobotModel& robot,
                                     planning::Trajectory trajectory)
    : impl_(std::make_unique<Impl>(config, robot, std::move(trajectory))) {}

TrajectoryTracker::~TrajectoryTracker() = default;

TrackerOutput TrajectoryTracker::step(double now_s, const PoseInput& pose) {
  return impl_->step(now_s, pose);
}

TrackerOutput TrajectoryTracker::hold(double now_s) { return impl_->hold(now_s); }

}  // namespace rovigo::control
