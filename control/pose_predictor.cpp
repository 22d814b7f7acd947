#include "control/pose_predictor.h"

#include <algorithm>
#include <cmath>

namespace rovigo::control {

bool PosePredictor::rolls(const TTwist2D& twist) const {
  constexpr double kRollingMS = 0.02;
  return std::abs(twist.vx) + std::abs(twist.omega) * drive_.track_width_m / 2 > kRollingMS;
}

/// `pose` after moving with `twist` for `dt_s`, along the chord of the arc, and sliding aside.
TPose2D PosePredictor::moved(const TPose2D& pose, const TTwist2D& twist, double dt_s) const {
  const double turn = twist.omega * dt_s;
  const double heading = pose.phi + turn / 2;
  const double half = turn / 2;
  const double chord = std::abs(half) > 1e-9 ? std::sin(half) / half : 1.0;
  const double length = twist.vx * dt_s * chord;
  const double c = std::cos(heading), s = std::sin(heading);
  const double aside = rolls(twist) ? (side_drift_.y * c - side_drift_.x * s) * dt_s : 0.0;
  return {pose.x + length * c - aside * s, pose.y + length * s + aside * c,
          maps::wrap_angle(pose.phi + turn)};
}

/// The command without the wheels that stiction holds.
TTwist2D PosePredictor::what_the_wheels_follow() const {
  constexpr double kStandingShare = 0.1, kKineticShare = 0.4;  // of the dead zone
  const double dead_zone = drive_.dead_zone_m_s, half = drive_.track_width_m / 2;
  if (!(dead_zone > 0.0)) return command_;
  const auto followed = [&](double wanted, double present) {
    const bool stands = std::abs(present) < kStandingShare * dead_zone;
    return std::abs(wanted) < (stands ? 1.0 : kKineticShare) * dead_zone * 0.999 ? 0.0 : wanted;
  };
  const double left =
      followed(command_.vx - half * command_.omega, modelled_.vx - half * modelled_.omega);
  const double right =
      followed(command_.vx + half * command_.omega, modelled_.vx + half * modelled_.omega);
  return {(left + right) / 2, 0.0, (right - left) / (2 * half)};
}

void PosePredictor::advance(double now_s) {
  if (!started_) {
    started_ = true;
    now_s_ = now_s;
    return;
  }
  const double dt = now_s - now_s_;
  if (!(dt > 0.0)) return;
  if (dt > kMemoryS) {  // nobody knows what the drive did meanwhile: its own watchdog stopped it
    motions_.clear();
    modelled_ = {};
    now_s_ = now_s;
    return;
  }
  // First-order lag, solved exactly over the interval: its mean and its end value.
  const double lag = drive_.lag_s, delay = drive_.command_delay_s;
  const double decay = lag > 0.0 ? std::exp(-dt / lag) : 0.0;
  const double mean_share = lag > 0.0 ? lag / dt * (1.0 - decay) : 0.0;
  const TTwist2D target = what_the_wheels_follow();
  const TTwist2D gap(modelled_.vx - target.vx, 0.0, modelled_.omega - target.omega);
  motions_.push_back(
      {now_s_ + delay,
       now_s + delay,
       {target.vx + gap.vx * mean_share, 0.0, target.omega + gap.omega * mean_share}});
  modelled_ = {target.vx + gap.vx * decay, 0.0, target.omega + gap.omega * decay};
  now_s_ = now_s;
  while (!motions_.empty() && motions_.front().to_s < now_s_ - kMemoryS) motions_.pop_front();
}

void PosePredictor::reset(double time_s, const TPose2D& pose) {
  anchor_time_s_ = time_s;
  anchor_ = pose;
}

void PosePredictor::correct(double time_s, const TPose2D& pose, double share) {
  const TPose2D predicted = at(time_s);
  reset(time_s,
        {predicted.x + share * (pose.x - predicted.x), predicted.y + share * (pose.y - predicted.y),
         maps::wrap_angle(predicted.phi + share * maps::wrap_angle(pose.phi - predicted.phi))});
}

TPose2D PosePredictor::at(double time_s) const {
  TPose2D pose = anchor_;
  double reached = anchor_time_s_;
  for (const Motion& m : motions_) {
    const double from = std::max(m.from_s, anchor_time_s_);
    const double to = std::min(m.to_s, time_s);
    if (to <= from) continue;
    pose = moved(pose, {m.twist.vx, 0.0, m.twist.omega * turn_gain_}, to - from);
    reached = to;
  }
  if (!motions_.empty() && reached < time_s && time_s > motions_.back().to_s) {
    const double from = std::max(reached, motions_.back().to_s);
    pose = moved(pose, twist(), std::min(time_s - from, kMemoryS));
  }
  return pose;
}

TTwist2D PosePredictor::twist() const { return {modelled_.vx, 0.0, modelled_.omega * turn_gain_}; }

double PosePredictor::asked_turn(double from_s, double to_s) const {
  double turn = 0.0;
  for (const Motion& m : motions_) {
    const double overlap = std::min(m.to_s, to_s) - std::max(m.from_s, from_s);
    if (overlap > 0.0) turn += m.twist.omega * overlap;
  }
  return turn;
}

double PosePredictor::rolled_s(double from_s, double to_s) const {
  double seconds = 0.0;
  for (const Motion& m : motions_) {
    const double overlap = std::min(m.to_s, to_s) - std::max(m.from_s, from_s);
    if (overlap > 0.0 && rolls(m.twist)) seconds += overlap;
  }
  return seconds;
}

}  // namespace rovigo::control
