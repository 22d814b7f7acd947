#include "control/docking.h"

#include <algorithm>
#include <cmath>

namespace rovigo::control {
namespace {

using maps::wrap_angle;

constexpr double kFadeM = 0.15;  ///< the correction across fades out over the last stretch

}  // namespace

DockingOutput DockingController::step(const TPose2D& at) {
  DockingOutput out;
  if (maps::is_finite(at) && status_ == DockingStatus::kRunning) {
    switch (phase_) {
      case Phase::kApproach:
        out.command = approach(at);
        break;
      case Phase::kAlign:
        out.command = align(at);
        break;
      case Phase::kBackUp:
        out.command = back_up(at);
        break;
    }
  }
  out.status = status_;
  return out;
}

TTwist2D DockingController::approach(const TPose2D& at) {
  const double left = -at.x;
  if (left <= config_.along_tolerance_m) {
    phase_ = Phase::kAlign;
    return {};
  }
  const double fade = std::clamp(left / kFadeM, 0.0, 1.0);
  const double towards_axis =
      -std::clamp(std::atan(config_.approach_gain_1_m * at.y) * fade,
                  -config_.max_approach_angle_rad, config_.max_approach_angle_rad);
  const double heading_error = wrap_angle(towards_axis - at.phi);
  const double speed = std::max(0.0, along_.update(left));
  const bool turns_first = std::abs(heading_error) > config_.turn_first_angle_rad;
  return {turns_first ? 0.0 : speed * std::cos(heading_error), 0.0, turn_rate(heading_error)};
}

TTwist2D DockingController::align(const TPose2D& at) {
  const double error = wrap_angle(-at.phi);
  if (std::abs(error) > config_.heading_tolerance_rad) {
    const double rate = turn_rate(error);
    const double least = std::copysign(config_.least_turn_rate_rad_s, rate);
    return {0.0, 0.0, std::abs(rate) < std::abs(least) ? least : rate};
  }
  if (std::abs(at.y) <= config_.across_tolerance_m &&
      std::abs(at.x) <= 2.0 * config_.along_tolerance_m) {
    status_ = DockingStatus::kDocked;
  } else if (attempts_ >= config_.most_attempts) {
    status_ = DockingStatus::kMissed;
  } else {
    phase_ = Phase::kBackUp;
  }
  return {};
}

TTwist2D DockingController::back_up(const TPose2D& at) {
  if (at.x <= -config_.back_up_m) {
    ++attempts_;
    along_ = SwitchingPi(config_.along);
    phase_ = Phase::kApproach;
    return {};
  }
  return {-config_.back_up_speed_m_s, 0.0, turn_rate(wrap_angle(-at.phi))};
}

double DockingController::turn_rate(double heading_error) const {
  return std::clamp(config_.heading_gain_1_s * heading_error, -config_.max_turn_rate_rad_s,
                    config_.max_turn_rate_rad_s);
}

}  // namespace rovigo::control
