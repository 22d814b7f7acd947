#include "control/side_drift.h"

#include <algorithm>
#include <cmath>

namespace rovigo::control {
namespace {

constexpr double kFirstTimeS = 1.5,
                 kTimeS = 6.0;             ///< long against pose noise, short against a drive
constexpr double kMostInnovationM = 0.02;  ///< more is a slip, or an outlier

}  // namespace

void SideDriftEstimator::add(const TPose2D& measured, const TPose2D& predicted, double share,
                             double moved_s) {
  if (!(moved_s > 0.0)) return;
  const double nx = -std::sin(predicted.phi), ny = std::cos(predicted.phi);
  const double aside = std::clamp((measured.x - predicted.x) * nx + (measured.y - predicted.y) * ny,
                                  -kMostInnovationM, kMostInnovationM);
  rolled_s_ = std::min(rolled_s_ + moved_s, kTimeS);
  const double gain = share / std::max(rolled_s_, kFirstTimeS);
  drift_.x += gain * aside * nx;
  drift_.y += gain * aside * ny;
  const double size = std::hypot(drift_.x, drift_.y);
  if (size > kMostMS) drift_ *= kMostMS / size;
}

}  // namespace rovigo::control
