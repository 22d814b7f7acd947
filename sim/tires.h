#pragma once
// What a tyre does along its axle, where it cannot roll. The physics engine has no such tyre.

#include "maps/robot_model.h"

namespace rovigo::sim {

/// While its wheel rolls a tyre scrubs: the side force grows with the speed of scrubbing up to a
/// limit. (Plain Coulomb friction would let the rover slide sideways freely as soon as all four
/// wheels scrub, which they do in every turn.) While its wheel stands it also grips the spot it
/// stands on, as a stiff spring, so that a rover parked across a slope does not creep.
class TireSide {
 public:
  explicit TireSide(const maps::RobotModel& robot)
      : scrub_n_s_m_(robot.tire_scrub_n_s_m), friction_(robot.tire_side_friction) {}

  /// Force along the axle, N, on the rover. `load_n`: what the wheel presses; `grip`: share of
  /// friction that the floor gives.
  double force(double scrub_m_s, bool rolls, double load_n, double grip, double dt_s);

 private:
  double scrub_n_s_m_;
  double friction_;
  double bent_m_ = 0.0;  ///< how far the tyre is bent from the spot it stands on
};

}  // namespace rovigo::sim
