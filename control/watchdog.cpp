#include "control/watchdog.h"

#include <limits>

namespace rovigo::control {

double Watchdog::silence_s(double now_s) const {
  return fed_s_ ? now_s - *fed_s_ : std::numeric_limits<double>::infinity();
}

bool Watchdog::expired(double now_s) const {
  constexpr double kRounding = 1e-9;  // so that a step exactly timeout_s later is not missed
  const double silence = silence_s(now_s);
  return !(silence >= 0.0 && silence < timeout_s_ - kRounding);
}

}  // namespace rovigo::control
