#pragma once
// Small curves that the law of motion is made of.

#include <algorithm>
#include <cmath>

namespace rovigo::control {

/// 1 up to `from`, falling to 0 at `to`.
inline double falling(double value, double from, double to) {
  return to > from ? 1.0 - std::clamp((value - from) / (to - from), 0.0, 1.0)
                   : (value <= from ? 1.0 : 0.0);
}

/// The highest speed from which `distance` suffices to stop.
inline double braking_speed(double distance, double deceleration) {
  return std::sqrt(2.0 * deceleration * std::max(distance, 0.0));
}

}  // namespace rovigo::control
