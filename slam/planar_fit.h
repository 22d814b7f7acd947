#pragma once
// Gauss-Newton for a pose on the floor: shared by what matches scans against walls and grids.

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "slam/planar_information.h"

namespace rovigo::slam {

/// A scan's cost at one pose, quadratic around it.
struct PlanarCost {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  int points = 0;  ///< that could be judged
  int inliers = 0;
};

struct PlanarFit {
  PlanarInformation look;  ///< the cost's own word on the pose, without the prior's
  int points = 0;
  int inliers = 0;
  double inlier_share() const { return points > 0 ? static_cast<double>(inliers) / points : 0.0; }
};

/// From the prior pose downhill; the prior holds the directions the cost says nothing about.
/// `linearize`: PlanarCost of a TPose2D.
template <class Linearize>
PlanarFit fit_planar(const TPose2D& prior, const Eigen::Matrix3d& prior_covariance, int iterations,
                     const Linearize& linearize) {
  // A covariance this small would pin the pose; a nanometre keeps it invertible.
  const Eigen::Matrix3d prior_information =
      (prior_covariance + 1e-9 * Eigen::Matrix3d::Identity()).inverse();
  TPose2D pose = prior;
  PlanarCost cost = linearize(pose);
  for (int i = 0; i < iterations; ++i) {
    const Eigen::Vector3d away(pose.x - prior.x, pose.y - prior.y,
                               maps::wrap_angle(pose.phi - prior.phi));
    const Eigen::Vector3d step = (cost.information + prior_information)
                                     .ldlt()
                                     .solve(-(cost.gradient + prior_information * away));
    if (!step.allFinite()) break;
    pose = {pose.x + step.x(), pose.y + step.y(), maps::wrap_angle(pose.phi + step.z())};
    cost = linearize(pose);
    if (step.norm() < 1e-5) break;
  }
  return {{pose, cost.information, cost.gradient}, cost.points, cost.inliers};
}

}  // namespace rovigo::slam
