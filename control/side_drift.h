#pragma once
// How fast the floor lets the rover slide sideways while its wheels roll: on a slope tyres give way
// downhill. Learned from poses, because nobody tells the controller of slopes.

#include "control/pose_predictor.h"

namespace rovigo::control {

/// A constant velocity over the map, of which the rover feels what lies along its axles. An
/// integral observer: what poses say beyond the prediction, to the side, is taken in slowly.
class SideDriftEstimator {
 public:
  static constexpr double kMostMS = 0.06;

  /// A measured pose, `share` of which corrects the predictor next, and `moved_s`, the time since
  /// the one before.
  void add(const TPose2D& measured, const TPose2D& predicted, double share, double moved_s);
  const TPoint2D& drift_m_s() const { return drift_; }

 private:
  TPoint2D drift_{0.0, 0.0};
  double rolled_s_ = 0.0;
};

}  // namespace rovigo::control
