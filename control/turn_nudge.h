#pragma once
// The last bit of a turn in place, against stiction: one push of the right size, then a wait until
// its effect is seen. A loop that pushes until it sees the effect overshoots by its own delay, and
// back again.

#include "control/command_limiter.h"

namespace rovigo::control {

class TurnNudge {
 public:
  /// The turn rate to ask for now, rad/s. `dead_zone_m_s`: rim speed that a standing wheel needs;
  /// `turn_gain`: real turn per commanded turn.
  double step(double error_rad, double dt_s, double dead_zone_m_s, double turn_gain,
              const DriveLimits& limits);
  bool is_pushing() const { return push_s_ > 0.0; }
  void reset() { *this = {}; }

 private:
  double push_s_ = 0.0;  ///< left of the push under way
  double rate_rad_s_ = 0.0;
  double wait_s_ = kWaitS;
  static constexpr double kWaitS = 0.4;  ///< for the drive's lag and a late pose
};

}  // namespace rovigo::control
