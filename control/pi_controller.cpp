#include "control/pi_controller.h"

#include <algorithm>
#include <cmath>

namespace rovigo::control {
namespace {

double usable_step(double dt_s) {
  if (!(dt_s > 0.0)) return 0.0;  // also NaN
  return std::min(dt_s, PiController::kLongestStepS);
}

}  // namespace

double PiController::update(const PiInput& in) {
  const double error = std::isfinite(in.error) ? in.error : 0.0;
  const double dt = usable_step(in.dt_s);
  const auto clamped = [&in](double u) { return std::min(std::max(u, in.min), in.max); };
  const auto limited = [&in](double i) {
    return std::clamp(i, -std::abs(in.integral_limit), std::abs(in.integral_limit));
  };

  integral_ = limited(integral_);
  const double wanted = in.feed_forward + gains_.kp * error + integral_;
  const double excess = wanted - clamped(wanted);
  const bool pushes_further_out = excess * error > 0.0;
  if (!pushes_further_out) integral_ = limited(integral_ + gains_.ki * error * dt);
  back_calculate(excess, dt);
  return clamped(in.feed_forward + gains_.kp * error + integral_);
}

void PiController::back_calculate(double excess, double dt_s) {
  if (!std::isfinite(excess) || excess * integral_ <= 0.0) return;
  const double share = std::min(1.0, usable_step(dt_s) / gains_.anti_windup_time_s);
  const double own = std::min(std::abs(excess), std::abs(integral_));
  integral_ -= std::copysign(own * share, integral_);
}

}  // namespace rovigo::control
