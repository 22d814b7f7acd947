#include "slam/inertial_filter.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "slam/inertial_updates.h"

namespace rovigo::slam {

namespace {

using S = InertialState;
using Term = InertialState::Term;

constexpr double kGravity = 9.81;
constexpr double kGyroTimeoutS = 0.1;   // an older reading is no reading
constexpr double kWheelTimeoutS = 0.5;  // wheels silent for longer: the speed is not known
constexpr double kMaxRateRadS = 35.0, kMaxForceMS2 = 80.0;  // no rover does more

// Process: fast enough for a small rover's motors; a faster change is noticed by its innovation.
constexpr double kTurningRadS2 = 0.25;
constexpr double kJerkMS3 = 3.0;
constexpr double kStartSigmaMS = 0.3, kStartSigmaRadS = 0.3, kStartSigmaMS2 = 1.0;
constexpr double kSurprise = 9.0;  // squared sigmas

constexpr double kAccelerometerSigmaMS2 = 0.1;  // a rolling rover shakes
constexpr double kAccelerometerBiasSigmaMS2 = 0.15;
constexpr double kAccelerometerWalk = 1e-3;  // m/s^2 per square root of a second

constexpr double kDelayWalk = 2e-5;  // s per square root of a second: clocks and filters wander

constexpr double kStandingSpeedMS = 1e-3, kStandingTurnRadS = 0.01, kStandingGyroRadS = 0.05;
constexpr double kRestS = 0.25;       // no tick of the wheels for so long: standing
constexpr double kCarriedRad = 0.15;  // turned so far on standing wheels: carried
constexpr double kMostCalibrationSigmas = 4.0;

double squared(double x) { return x * x; }

}  // namespace

InertialFilter::InertialFilter(const DeadReckoningConfig& config) : config_(config), slip_(config) {
  for (int i = 0; i < 3; ++i) {
    state_.reset_error(S::kVelocity + i, squared(kStartSigmaMS));
    state_.reset_error(S::kRate + i, squared(kStartSigmaRadS));
    state_.reset_error(S::kAcceleration + i, squared(kStartSigmaMS2));
    state_.reset_error(S::kGyroBias + i, squared(config.gyro_bias_sigma_rad_s));
    state_.reset_error(S::kAccelerometerBias + i, squared(kAccelerometerBiasSigmaMS2));
  }
  state_.gyro_delay_s = config.gyro_delay_s;
  state_.reset_error(S::kGyroDelay, squared(config.gyro_delay_sigma_s));
  state_.reset_error(S::kSpeedScale, squared(config.wheel_speed_scale_sigma));
  state_.reset_error(S::kTurnScale, squared(config.wheel_turn_scale_sigma));
}

void InertialFilter::place(const TPose2D& map_from_base, double sigma_position_m,
                           double sigma_heading_rad) {
  carried_ = false;
  place_on_floor(map_from_base, sigma_position_m, sigma_heading_rad, state_);
}

MotionCalibration InertialFilter::calibration() const {
  return {state_.gyro_bias.z(), state_.speed_scale, state_.turn_scale, state_.gyro_delay_s};
}

TTwist2D InertialFilter::twist() const {
  const double turn_scale = gyro_rate_ ? 0.0 : state_.turn_scale;
  return {state_.body_velocity().x(), 0.0, state_.rate.z() * (1.0 + turn_scale)};
}

Eigen::Matrix3d InertialFilter::pose_covariance() const {
  return state_.covariance(kPlanarError, kPlanarError);
}

std::optional<MotionStep> InertialFilter::take_step() {
  std::optional<MotionStep> out;
  std::swap(out, step_);
  return out;
}

void InertialFilter::advance_to(double time_s) {
  if (!started_) {
    time_s_ = time_s;
    started_ = true;
    return;
  }
  if (!(time_s > time_s_)) return;
  if (gyro_time_s_ && time_s - *gyro_time_s_ > kGyroTimeoutS) gyro_rate_.reset();
  if (time_s - odometry_time_s_ > kWheelTimeoutS) standing_ = false;
  // Short steps, so that the linearisation holds across a gap in the data.
  constexpr double kLongestStepS = 0.02;
  constexpr double kMostSteps = 20000;
  const double steps = std::clamp(std::ceil((time_s - time_s_) / kLongestStepS), 1.0, kMostSteps);
  const double dt = (time_s - time_s_) / steps;
  for (int i = 0; i < static_cast<int>(steps); ++i) propagate(dt);
  time_s_ = time_s;
}

void InertialFilter::propagate(double dt) {
  if (gyro_rate_) {
    gyro_turn_rad_ += (gyro_rate_->z() - state_.gyro_bias.z()) * dt;
    raw_gyro_turn_rad_ += gyro_rate_->z() * dt;
  }
  const bool wheels = odometry_ && time_s_ - odometry_time_s_ < kWheelTimeoutS;
  MotionStep step{.begin_s = 0.0,
                  .end_s = dt,
                  .distance_m = state_.body_velocity().x() * dt,
                  .turn_rad = state_.rate.z() * dt,
                  .has_gyro = gyro_rate_.has_value(),
                  .slipping = false,
                  .unseen_speed_m_s = 0.0,
                  .standing = standing_};
  const StepNoise rolling = noise_of(step, config_);
  step.slipping = slipping();
  step.unseen_speed_m_s = slip_.unseen_speed_m_s();
  const double slip_m2 = noise_of(step, config_).along_m2 - rolling.along_m2;
  state_.propagate(dt, {.turning_rad_s2 = kTurningRadS2,
                        .jerk_m_s3 = kJerkMS3,
                        .gyro_walk_rad_s2 = config_.gyro_bias_walk_rad_s2,
                        .delay_walk = kDelayWalk,
                        .accelerometer_walk = kAccelerometerWalk,
                        .odometer_m2 = rolling.along_m2,
                        .wheel_turn_rad2 = gyro_rate_ ? 0.0 : rolling.heading_rad2,
                        .creep_m2 = rolling.across_m2,
                        .slip_m2 = slip_m2,
                        .turn_by_wheels = !gyro_rate_,
                        .still = standing_,
                        .speed_fades = !wheels,
                        .turn_fades = !gyro_rate_ && !wheels,
                        .tilting_fades = !gyro_rate_});
}

void InertialFilter::add_gyro(double time_s, const Eigen::Vector3d& rate_rad_s) {
  if (!rate_rad_s.allFinite() || rate_rad_s.norm() > kMaxRateRadS) return;
  const double since = gyro_time_s_ ? time_s - *gyro_time_s_ : 0.0;
  const bool fresh = gyro_rate_ && since > 0 && since < kGyroTimeoutS;
  advance_to(time_s);
  // The interval was added up at the old rate; the trapezoid rule asks for the mean of both.
  if (fresh) {
    const double correction = 0.5 * (rate_rad_s.z() - gyro_rate_->z()) * since;
    gyro_turn_rad_ += correction;
    raw_gyro_turn_rad_ += correction;
  }
  gyro_rate_ = rate_rad_s;
  gyro_time_s_ = time_s;
  const double variance = squared(config_.gyro_sigma_rad_s);
  const double half_s = 0.5 * std::clamp(since, 0.0, kGyroTimeoutS);
  for (int i = 0; i < 3; ++i) {
    const double innovation = rate_rad_s(i) - state_.rate(i) - state_.gyro_bias(i);
    const std::array<Term, 2> terms = {{{S::kRate + i, 1.0}, {S::kGyroBias + i, 1.0}}};
    const double expected = state_.innovation_variance(terms, variance);
    // While it stands the doubt is not the rate's, unless it turns for sure about the vertical.
    const double limit = standing_ ? 25.0 : kSurprise;
    if (squared(innovation) < limit * expected) continue;
    if (standing_ && i != 2) continue;
    standing_ = false;
    state_.add_doubt(S::kRate + i, squared(innovation), half_s);
  }
  for (int i = 0; i < 3; ++i) {
    const std::array<Term, 2> terms = {{{S::kRate + i, 1.0}, {S::kGyroBias + i, 1.0}}};
    state_.update(terms, rate_rad_s(i) - state_.rate(i) - state_.gyro_bias(i), variance);
  }
  if (!fresh) led_rate_rad_s_.reset();
  make_up_gyro_delay();
}

/// A rate that nobody saw coming is in the heading already, if at all.
void InertialFilter::make_up_gyro_delay() {
  if (led_rate_rad_s_) state_.make_up_delay(state_.rate.z() - *led_rate_rad_s_);
  led_rate_rad_s_ = state_.rate.z();
}

void InertialFilter::add_accelerometer(double time_s, const Eigen::Vector3d& force) {
  if (!force.allFinite() || force.norm() > kMaxForceMS2) return;
  const double since = accelerometer_time_s_ ? time_s - *accelerometer_time_s_ : 0.0;
  advance_to(time_s);
  accelerometer_time_s_ = time_s;
  const auto others = [&]() -> Eigen::Vector3d {
    return state_.rate.cross(state_.body_velocity()) +
           kGravity * state_.map_from_base.rotation.row(2).transpose() + state_.accelerometer_bias;
  };
  if (since > 0 && since < kGyroTimeoutS) slip_.feel((force - others()).x() * since);
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d up = state_.map_from_base.rotation.row(2);
    const Eigen::Matrix3d by_attitude = kGravity * skew(up);
    // Rate and velocity are taken as known: a body that leans in its bends must not teach them.
    const std::array<Term, 5> terms = {{{S::kAcceleration + i, 1.0},
                                        {S::kAccelerometerBias + i, 1.0},
                                        {S::kAttitude, by_attitude(i, 0)},
                                        {S::kAttitude + 1, by_attitude(i, 1)},
                                        {S::kAttitude + 2, by_attitude(i, 2)}}};
    const double innovation = force(i) - others()(i) - state_.body_acceleration()(i);
    const double variance = squared(kAccelerometerSigmaMS2);
    // A jolt is real, but says nothing about biases and tilt.
    if (squared(innovation) > kSurprise * state_.innovation_variance(terms, variance)) {
      state_.add_doubt(S::kAcceleration + i, squared(innovation), 0.0);
    }
    state_.update(terms, innovation, variance);
  }
}

void InertialFilter::add_wheels(double time_s, const TPose2D& odom_from_base) {
  if (!maps::is_finite(odom_from_base)) return;
  advance_to(time_s);
  const double dt = time_s - odometry_time_s_;
  if (odometry_ && dt > 1e-4 && dt < 2.0) {
    const TPose2D moved = maps::compose(maps::inverse(*odometry_), odom_from_base);
    const double along = moved.x * std::cos(0.5 * moved.phi) + moved.y * std::sin(0.5 * moved.phi);
    const WheelStep wheels{.dt = dt, .distance_m = along, .turn_rad = moved.phi};
    const double gripped_m = slip_.distance_gripped(wheels, witnesses(), state_);
    const bool stood = standing_;
    standing_ = looks_standing(wheels);
    if (standing_) {
      rest();
    } else {
      if (stood) leave_standing(wheels);
      measure_wheels(wheels, gripped_m);
    }
    judge_carrying(wheels);
    step_ = step_of(wheels, gripped_m, time_s);
  } else if (!odometry_ || dt >= 2.0) {
    forget_wheel_count(state_);
  }
  hold_to_floor(state_);
  odometry_ = odom_from_base;
  odometry_time_s_ = time_s;
  gyro_turn_rad_ = raw_gyro_turn_rad_ = 0.0;
  step_rate_rad_s_ = gyro_rate_ ? std::optional(gyro_rate_->z()) : std::nullopt;
}

MotionStep InertialFilter::step_of(const WheelStep& wheels, double gripped_m, double end_s) const {
  const bool known = gyro_rate_ && step_rate_rad_s_;
  return {.begin_s = odometry_time_s_,
          .end_s = end_s,
          .distance_m = gripped_m,
          .turn_rad = gyro_rate_ ? raw_gyro_turn_rad_ : wheels.turn_rad,
          .turn_rate_change_rad_s = known ? gyro_rate_->z() - *step_rate_rad_s_ : 0.0,
          .has_gyro = gyro_rate_.has_value(),
          .slipping = slipping(),
          .unseen_speed_m_s = slip_.unseen_speed_m_s(),
          .standing = standing_};
}

SlipWitnesses InertialFilter::witnesses() const {
  const bool felt = accelerometer_time_s_ && time_s_ - *accelerometer_time_s_ < kGyroTimeoutS;
  return {.gyro = gyro_rate_.has_value(),
          .accelerometer = felt,
          .gyro_turn_rad = gyro_turn_rad_,
          .resting_s = resting_s_,
          .standing = standing_};
}

/// Wheels at rest and a body that turns: it hangs in somebody's hands, or on a turntable.
void InertialFilter::judge_carrying(const WheelStep& wheels) {
  const bool wheels_rest = std::abs(wheels.distance_m) < 1e-4 && std::abs(wheels.turn_rad) < 1e-4;
  turned_standing_rad_ =
      wheels_rest && !standing_ && gyro_rate_ ? turned_standing_rad_ + gyro_turn_rad_ : 0.0;
  if (std::abs(turned_standing_rad_) > kCarriedRad) carried_ = true;
}

/// A motor that turns its wheel at all turns it faster than a tick in that time.
bool InertialFilter::looks_standing(const WheelStep& wheels) {
  const bool no_tick = std::abs(wheels.distance_m) < kStandingSpeedMS * wheels.dt &&
                       std::abs(wheels.turn_rad) < kStandingTurnRadS * wheels.dt;
  resting_s_ = no_tick ? resting_s_ + wheels.dt : 0.0;
  return resting_s_ > kRestS && !slip_.both_sides() &&
         (!gyro_rate_ || std::abs(gyro_rate_->z() - state_.gyro_bias.z()) < kStandingGyroRadS);
}

/// The motion began somewhere in the interval that was taken for rest.
void InertialFilter::leave_standing(const WheelStep& wheels) {
  const double half_s = 0.5 * wheels.dt;
  state_.add_doubt(S::kVelocity, squared(2.0 * wheels.distance_m / wheels.dt), half_s);
  state_.add_doubt(S::kRate + 2, squared(wheels.turn_rad / wheels.dt), half_s);
  state_.add_doubt(S::kAcceleration, squared(kStartSigmaMS2), 0.0);
}

void InertialFilter::measure_wheels(const WheelStep& wheels, double gripped_m) {
  if (slip_.both_sides()) {
    forget_wheel_count(state_);
  } else {
    measure_distance(gripped_m, wheels.dt, state_);
    if (!gyro_rate_) measure_wheel_turn(wheels.turn_rad, wheels.dt, state_);
  }
  if (gyro_rate_) forget_wheel_turn(state_);
  hold_on_track(state_);
}

void InertialFilter::rest() {
  slip_.feel_rest();
  hold_still(state_);
  if (gyro_rate_) make_up_gyro_delay();
  forget_wheel_count(state_);
}

void InertialFilter::correct(const PlanarInformation& look, double floor_m, double floor_rad) {
  if (!take_look(look, floor_m, floor_rad, state_)) return;
  // A jump of the pose (carried, wrongly recognised) must not leave sensors that no rover has.
  const auto within = [](double value, double nominal, double sigma) {
    const double most = kMostCalibrationSigmas * sigma;
    return nominal + std::clamp(value - nominal, -most, most);
  };
  state_.speed_scale = within(state_.speed_scale, 0.0, config_.wheel_speed_scale_sigma);
  state_.turn_scale = within(state_.turn_scale, 0.0, config_.wheel_turn_scale_sigma);
  state_.gyro_delay_s =
      within(state_.gyro_delay_s, config_.gyro_delay_s, config_.gyro_delay_sigma_s);
}

void InertialFilter::shift(const TPose2D& new_map_from_old_map) {
  const Se3 moved = from_planar(new_map_from_old_map);
  state_.map_from_base = moved * state_.map_from_base;
  auto& p = state_.covariance;
  p.topRows<3>() = (moved.rotation * p.topRows<3>()).eval();
  p.leftCols<3>() = (p.leftCols<3>() * moved.rotation.transpose()).eval();
}

}  // namespace rovigo::slam
