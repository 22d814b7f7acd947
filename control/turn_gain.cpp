#include "control/turn_gain.h"

#include <algorithm>
#include <cmath>

namespace rovigo::control {

void TurnGainEstimator::add(double time_s, double yaw_rad, const PosePredictor& predictor) {
  if (!start_ || time_s - start_->time_s > kLongestWindowS) {
    start_ = Start{time_s, yaw_rad};
    return;
  }
  const double window = time_s - start_->time_s;
  if (window < kWindowS) return;
  const double asked = predictor.asked_turn(start_->time_s, time_s);
  const double measured = maps::wrap_angle(yaw_rad - start_->yaw_rad);
  start_ = Start{time_s, yaw_rad};
  if (std::abs(asked) < kLeastTurnRateRadS * window) return;
  // A turn beyond what any gain explains is a jump of the estimate, not scrubbing.
  if (std::abs(measured - asked) > 0.6 * std::abs(asked) + 0.05) return;
  const double keep = std::exp(-std::abs(asked) / kMemoryRad);
  asked_asked_ = keep * asked_asked_ + asked * asked;
  asked_measured_ = keep * asked_measured_ + asked * measured;
}

double TurnGainEstimator::gain() const {
  return std::clamp((kPriorRad2 + asked_measured_) / (kPriorRad2 + asked_asked_), kLowest,
                    kHighest);
}

}  // namespace rovigo::control
