#include "slam/wheel_slip.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace rovigo::slam {

namespace {

using S = InertialState;
using Term = InertialState::Term;

constexpr double kGravity = 9.81;
constexpr double kLongestStepS = 0.1;  // over a longer one gyro and accelerometer are no witnesses
constexpr double kSlipMemoryS = 0.1;   // smoothing of wheels against gyro
constexpr double kTrackM = 0.358;      // lever of a slipping wheel; nominal is good enough
constexpr double kFeltMemoryS = 0.5;   // the accelerometer's speed is drawn to the wheels' so fast
constexpr double kFeltMemorySlippingS = 2.0;
constexpr double kFeltSigmaMS2 = 0.03;  // what shaking leaves of the mean over that time
constexpr double kMinSlipMS = 0.1;
constexpr double kMinTurnToCalibrate = 0.15;
constexpr double kLongestSlideS = 0.5;  // braking at 2 m/s^2 from 1 m/s

double squared(double x) { return x * x; }

/// Only the scale of the wheels learns from this: scrubbing wheels must not teach the gyro
/// (a consider update: Schmidt 1966).
void teach_turn_scale(double wheel_turn_rate, double apart, double wheel_turn_sigma_rad_s,
                      InertialState& state) {
  auto& p = state.covariance;
  const double prior = p(S::kTurnScale, S::kTurnScale);
  const double h = wheel_turn_rate;
  const double variance = squared(wheel_turn_sigma_rad_s + 0.05 * std::abs(h));
  const double gain = prior * h / (h * h * prior + variance);
  state.turn_scale -= gain * apart;
  p.row(S::kTurnScale) *= 1.0 - gain * h;
  p.col(S::kTurnScale) *= 1.0 - gain * h;
  p(S::kTurnScale, S::kTurnScale) += gain * gain * variance + 1e-8;
}

}  // namespace

double WheelSlip::distance_gripped(const WheelStep& wheels, const SlipWitnesses& witnesses,
                                   InertialState& state) {
  judge_one_side(wheels, witnesses, state);
  double distance = wheels.distance_m;
  const double excess = std::abs(disagreement_rad_s_) * 0.5 * kTrackM * wheels.dt;
  unseen_speed_m_s_ = std::max(0.0, excess - std::abs(distance)) / wheels.dt;
  if (one_slips_) {
    // One wheel spins faster than the ground passes: follow the other one.
    distance = std::copysign(std::max(0.0, std::abs(distance) - excess), distance);
  }
  return judge_both_sides(wheels, distance, witnesses, state);
}

void WheelSlip::judge_one_side(const WheelStep& wheels, const SlipWitnesses& witnesses,
                               InertialState& state) {
  one_slips_ = false;
  if (!witnesses.gyro || wheels.dt > kLongestStepS) return;
  const double wheel_turn_rate = wheels.turn_rad / wheels.dt;
  const double apart =
      wheel_turn_rate * (1.0 + state.turn_scale) - witnesses.gyro_turn_rad / wheels.dt;
  const double blend = 1.0 - std::exp(-wheels.dt / kSlipMemoryS);
  disagreement_rad_s_ += blend * (apart - disagreement_rad_s_);
  const double scale_sigma = std::sqrt(state.covariance(S::kTurnScale, S::kTurnScale)) + 0.03;
  const double sigma = config_.wheel_turn_sigma_rad_s + scale_sigma * std::abs(wheel_turn_rate);
  one_slips_ = std::abs(disagreement_rad_s_) > config_.slip_gate * sigma;
  // A slip begins before the smoothed figure shows it, and must not pass for a wrong scale.
  const bool doubtful = one_slips_ || std::abs(apart) > 0.5 * config_.slip_gate * sigma;
  if (!doubtful && std::abs(wheel_turn_rate) > kMinTurnToCalibrate) {
    teach_turn_scale(wheel_turn_rate, apart, config_.wheel_turn_sigma_rad_s, state);
  }
}

/// Both sides spin, or are blocked and slide: the gyro sees nothing of it, but the body does not
/// feel the change of speed that the wheels report. The body's own speed is then followed.
double WheelSlip::judge_both_sides(const WheelStep& wheels, double gripped_m,
                                   const SlipWitnesses& witnesses, InertialState& state) {
  const double scale = 1.0 + state.speed_scale;
  const double wheel_speed = gripped_m / wheels.dt * scale;
  // A slide on blocked wheels is soon over: a body that moves for longer above them is carried.
  if (!witnesses.accelerometer || wheels.dt > kLongestStepS ||
      witnesses.resting_s > kLongestSlideS) {
    both_slip_ = false;
    felt_speed_m_s_ = wheel_speed;
    return gripped_m;
  }
  const double apart = wheel_speed - felt_speed_m_s_;
  // What the accelerometer reads wrongly forwards: its bias, and gravity through the pitch.
  const std::array<Term, 2> forwards = {
      {{S::kAccelerometerBias, 1.0}, {S::kAttitude + 1, -kGravity}}};
  const double force_variance = state.innovation_variance(forwards, squared(kFeltSigmaMS2));
  const double sigma = config_.wheel_speed_sigma_m_s + kFeltMemoryS * std::sqrt(force_variance);
  const bool slipped = both_slip_;
  both_slip_ = !witnesses.standing && !one_slips_ &&
               std::abs(apart) > std::max(kMinSlipMS, config_.slip_gate * sigma);
  const double memory = both_slip_ ? kFeltMemorySlippingS : kFeltMemoryS;
  felt_speed_m_s_ += std::min(1.0, wheels.dt / memory) * apart;
  if (!both_slip_) return gripped_m;
  if (!slipped) {  // the wheels have misled the speed for a moment already
    state.add_doubt(S::kVelocity, squared(apart), kSlipMemoryS);
    const std::array<Term, 1> speed = {{{S::kVelocity, 1.0}}};
    state.update(speed, felt_speed_m_s_ / scale - state.velocity.x(), squared(sigma));
  }
  return felt_speed_m_s_ * wheels.dt / scale;
}

}  // namespace rovigo::slam
