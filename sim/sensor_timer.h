#pragma once
// When a sensor of a given rate is due, in physics steps.

#include <cstdint>

namespace rovigo::sim {

/// Tells at which physics steps a sensor of a given rate is due: the first step at or after each
/// multiple of its period, so that stamps are exact.
class SensorTimer {
 public:
  SensorTimer(double rate_hz, double step_s)
      : step_s_(step_s), steps_per_sample_(1.0 / (rate_hz * step_s)) {}
  bool is_due(long step) {
    if (static_cast<double>(step) + 1e-9 < static_cast<double>(count_) * steps_per_sample_) {
      return false;
    }
    ++count_;
    interval_s_ = static_cast<double>(step - last_step_) * step_s_;
    last_step_ = step;
    return true;
  }
  /// Between the last two samples; the nominal one at the first.
  double interval_s() const {
    return interval_s_ > 0.0 ? interval_s_ : steps_per_sample_ * step_s_;
  }
  std::uint64_t index() const { return count_ - 1; }

 private:
  double step_s_;
  double steps_per_sample_;
  std::uint64_t count_ = 0;
  long last_step_ = 0;
  double interval_s_ = 0.0;
};

}  // namespace rovigo::sim
