#include "sim/tires.h"

#include <algorithm>

namespace rovigo::sim {

double TireSide::force(double scrub_m_s, bool rolls, double load_n, double grip, double dt_s) {
  // Stiff enough that 5 deg of slope bend it by a third of a millimetre, and slow enough (9 Hz with
  // the rover's mass on four of them) for steps of 1/240 s.
  constexpr double kStiffnessNPerM = 5000.0;
  const double limit = friction_ * load_n * grip;
  const double most = limit / kStiffnessNPerM;
  bent_m_ = rolls ? 0.0 : std::clamp(bent_m_ + scrub_m_s * dt_s, -most, most);
  return std::clamp(-scrub_n_s_m_ * scrub_m_s - kStiffnessNPerM * bent_m_, -limit, limit);
}

}  // namespace rovigo::sim
