#include "control/stiction.h"

#include <algorithm>
#include <cmath>

namespace rovigo::control {

namespace {

constexpr double kNearDeadZone = 1.2;
constexpr double kShortestS = 0.6, kLongestS = 4.0;  // long against a late pose
constexpr double kFarEnoughM = 0.02;                 // at the rim
constexpr double kSigmas = 4.0;                      // of a difference of two poses
constexpr double kHeadingSigmaRad = 0.01;            // of a pose; none states it
constexpr double kStalledShare = 0.25;               // of what was expected
constexpr double kStepMS = 0.01;

double noise_of(double sigma) { return kSigmas * std::sqrt(2.0) * sigma; }

}  // namespace

void StictionEstimator::expect(const TTwist2D& command, const TTwist2D& modelled, double dt_s) {
  if (!window_ || !(dt_s > 0.0)) return;
  const double rim = std::abs(command.vx) + std::abs(command.omega) * half_track_m_;
  if (rim > kNearDeadZone * kHighest) {  // no dead zone explains a stall at such a command
    window_.reset();
    return;
  }
  window_->seconds += dt_s;
  window_->forward_m += modelled.vx * dt_s;
  window_->turn_m += modelled.omega * half_track_m_ * dt_s;
}

bool StictionEstimator::pose(const TPose2D& map_from_base, double sigma_position_m) {
  const double before = dead_zone_m_s_;
  if (window_ && window_->seconds < kLongestS) {
    if (!tells(sigma_position_m)) return false;
    if (stalled(map_from_base, sigma_position_m)) {
      dead_zone_m_s_ = std::max(before, std::min(kHighest, before + kStepMS));
    }
  }
  window_ = Window{.start = map_from_base};
  return dead_zone_m_s_ > before;
}

/// Was so much expected that poses this noisy would show it?
bool StictionEstimator::tells(double sigma_position_m) const {
  const double forward = std::abs(window_->forward_m), turn = std::abs(window_->turn_m);
  return window_->seconds >= kShortestS && forward + turn >= kFarEnoughM &&
         (turn >= noise_of(kHeadingSigmaRad * half_track_m_) ||
          forward >= noise_of(sigma_position_m));
}

bool StictionEstimator::stalled(const TPose2D& now, double sigma_position_m) const {
  const double moved_m = maps::distance(maps::position_of(window_->start), maps::position_of(now));
  const double turned_m = std::abs(maps::wrap_angle(now.phi - window_->start.phi)) * half_track_m_;
  const double forward = std::abs(window_->forward_m), turn = std::abs(window_->turn_m);
  // Only what poses this noisy can tell counts; of that, nothing must have happened.
  // Where next to nothing was expected, not even poses without noise tell anything.
  const bool turn_tells = turn >= noise_of(kHeadingSigmaRad * half_track_m_);
  const bool forward_tells = forward >= std::max(noise_of(sigma_position_m), kFarEnoughM / 4.0);
  return (!turn_tells || turned_m < kStalledShare * turn) &&
         (!forward_tells || moved_m < kStalledShare * forward);
}

}  // namespace rovigo::control
