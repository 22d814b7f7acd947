#include "control/look_around.h"

#include <cmath>

namespace rovigo::control {

namespace {

constexpr double kStandS = 1.0;
constexpr double kTurnRadS = 0.4;                            // slow enough for sharp images
constexpr double kOnceRoundS = 2.4 * maps::kPi / kTurnRadS;  // wheels scrub: a little longer
constexpr double kFacingRad = 0.1;

TrackerOutput ended(TrackStatus status) {
  TrackerOutput out;
  out.status = status;
  return out;
}

TrackerOutput turning(double rate_rad_s) {
  TrackerOutput out;
  out.command.omega = rate_rad_s;
  return out;
}

}  // namespace

void LookAround::enter(Phase phase, double now_s) {
  phase_ = phase;
  phase_since_s_ = now_s;
}

/// Nothing when the rover faces where it should.
std::optional<double> LookAround::away_rad(const PoseInput& pose) const {
  if (!facing_rad_) return std::nullopt;
  const double away = maps::wrap_angle(*facing_rad_ - pose.map_from_base.phi);
  return std::abs(away) > kFacingRad ? std::optional(away) : std::nullopt;
}

TrackerOutput LookAround::step(double now_s, const PoseInput& pose) {
  if (!phase_since_s_) phase_since_s_ = now_s;
  if (held_since_s_ >= 0.0) *phase_since_s_ += now_s - held_since_s_;
  held_since_s_ = -1.0;
  const bool good = pose.quality == PoseQuality::kGood;
  const double in_phase_s = now_s - *phase_since_s_;
  switch (phase_) {
    case Phase::kStand:
      if (good) return ended(TrackStatus::kReached);
      if (in_phase_s >= kStandS) enter(Phase::kSearch, now_s);
      return {};
    case Phase::kSearch:
      if (good) {
        enter(Phase::kFace, now_s);
        return {};
      }
      return in_phase_s < kOnceRoundS ? turning(kTurnRadS) : ended(TrackStatus::kPoseLost);
    case Phase::kFace:
      break;
  }
  const auto away = away_rad(pose);
  if (away && in_phase_s < kOnceRoundS) return turning(std::copysign(kTurnRadS, *away));
  return ended(good ? TrackStatus::kReached : TrackStatus::kPoseLost);
}

TrackerOutput LookAround::hold(double now_s) {
  if (held_since_s_ < 0.0) held_since_s_ = now_s;
  return {};
}

}  // namespace rovigo::control
