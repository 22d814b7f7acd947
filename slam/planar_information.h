#pragma once
// What a look at the world says of a rover on its floor.

#include <Eigen/Core>

#include "maps/geometry.h"

namespace rovigo::slam {

/// A look at the world, as a quadratic cost on the planar pose (x, y, yaw in the map frame):
/// cost(d) = gradient' d + d' information d / 2 around `map_from_base`. The information may be
/// singular: a direction that vision does not constrain is left alone.
struct PlanarInformation {
  TPose2D map_from_base;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
};

}  // namespace rovigo::slam
