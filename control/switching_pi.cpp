#include "control/switching_pi.h"

#include <algorithm>
#include <cmath>

namespace rovigo::control {

void WindowedDerivative::add(double value) {
  if (!std::isfinite(value)) return;
  ring_[next_] = value;
  next_ = (next_ + 1) % kRing;
  count_ = std::min(count_ + 1, kRing);
}

std::optional<double> WindowedDerivative::per_second(double sample_time_s) const {
  if (count_ < kRing || !(sample_time_s > 0.0)) return std::nullopt;
  double oldest = 0.0, newest = 0.0;
  for (std::size_t i = 0; i < kWindow; ++i) {
    oldest += ring_[(next_ + i) % kRing];
    newest += ring_[(next_ + kRing - 1 - i) % kRing];
  }
  constexpr double kStepsBetweenMiddles = kRing - kWindow;
  return (newest - oldest) / kWindow / (kStepsBetweenMiddles * sample_time_s);
}

double SwitchingPi::update(double error) {
  if (!std::isfinite(error)) return 0.0;
  rate_.add(error);
  const auto rate = rate_.per_second(config_.sample_time_s);
  const bool in_box =
      rate && std::abs(error) <= config_.box_error && std::abs(*rate) <= config_.box_error_rate;
  on_ = on_ || in_box;
  if (on_) integral_ += config_.ki * error * config_.sample_time_s;
  const double limit = std::abs(config_.output_limit);
  return std::clamp(config_.kp * error + integral_, -limit, limit);
}

}  // namespace rovigo::control
