#include "slam/keyframe_uncertainty.h"

#include <cmath>

namespace rovigo::slam {

namespace {

// What one step from keyframe to keyframe adds: at rest, by its length and by its turn. Chosen by
// NEES on recorded drives (./run bench slam prints it); turns and mirroring floors ask for most.
constexpr double kStepM = 0.0007, kStepMPerRootM = 0.003;
constexpr double kStepRad = 0.0005, kStepRadPerRootRad = 0.001;
// A floor read unevenly adds in proportion: the corners on it err together.
constexpr double kUnevenMPerRootM = 0.25, kUnevenRadPerRootM = 0.08;
constexpr double kLoopM = 0.01, kLoopRad = 0.004;  // between the views of one place

Eigen::Matrix3d carried(const Eigen::Matrix3d& covariance, const Se3& from, const Se3& to) {
  Eigen::Matrix3d lever = Eigen::Matrix3d::Identity();
  lever(0, 2) = -(to.translation.y() - from.translation.y());
  lever(1, 2) = to.translation.x() - from.translation.x();
  return lever * covariance * lever.transpose();
}

Eigen::Matrix3d planar(double variance_m2, double variance_rad2) {
  return Eigen::Vector3d(0.5 * variance_m2, 0.5 * variance_m2, variance_rad2).asDiagonal();
}

double square(double x) { return x * x; }

/// Known as `covariance` at `from`, what is known one step on; `roughness` is the floor's there.
Eigen::Matrix3d stepped(const Eigen::Matrix3d& covariance, const Se3& from, const Se3& to,
                        double roughness) {
  const double way = (to.translation - from.translation).norm();
  const double turn = so3_log(from.rotation.transpose() * to.rotation).norm();
  return carried(covariance, from, to) +
         planar(
             square(kStepM) + (square(kStepMPerRootM) + square(kUnevenMPerRootM * roughness)) * way,
             square(kStepRad) + square(kStepRadPerRootRad) * turn +
                 square(kUnevenRadPerRootM * roughness) * way);
}

double position_variance(const Eigen::Matrix3d& covariance) {
  return covariance(0, 0) + covariance(1, 1);
}

}  // namespace

void MapUncertainty::see(const Keyframe& keyframe) {
  map_from_base_ = keyframe.map_from_base;
  covariance_ = keyframe.covariance;
}

void MapUncertainty::join(Keyframe& keyframe, const Eigen::Matrix3d& reckoned, bool blind) {
  const bool first = !begun_;  // what all others are held against
  if (!first) {
    covariance_ = stepped(covariance_, map_from_base_, keyframe.map_from_base,
                          static_cast<double>(keyframe.features.floor_roughness()));
  }
  begun_ = true;
  map_from_base_ = keyframe.map_from_base;
  keyframe.covariance = covariance_;
  // Dead reckoning stays in the filter until a look takes it away: here it would count again with
  // every blind keyframe.
  if (blind && !first) keyframe.covariance += reckoned;
}

Eigen::Matrix3d MapUncertainty::at(const Se3& map_from_base) const {
  return carried(covariance_, map_from_base_, map_from_base);
}

void share_certainty(int seen_again, LandmarkMap& map) {
  int k = static_cast<int>(map.keyframes().size()) - 1;
  const Keyframe& again = map.keyframe(seen_again);
  Eigen::Matrix3d known =
      carried(again.covariance, again.map_from_base, map.keyframe(k).map_from_base) +
      planar(kLoopM * kLoopM, kLoopRad * kLoopRad);
  while (k > seen_again &&
         position_variance(known) < position_variance(map.keyframe(k).covariance)) {
    map.keyframe(k).covariance = known;
    const Keyframe& from = map.keyframe(k--);
    known = stepped(known, from.map_from_base, map.keyframe(k).map_from_base,
                    static_cast<double>(from.features.floor_roughness()));
  }
}

}  // namespace rovigo::slam
