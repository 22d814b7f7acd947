#pragma once
// How slam's poses enter Ceres: six numbers that step away from a fixed pose (see `retract`).

#include <ceres/rotation.h>

#include <Eigen/Core>

#include "slam/se3.h"

namespace rovigo::slam {

template <class T>
struct PoseOf {
  Eigen::Matrix<T, 3, 3> rotation;
  Eigen::Matrix<T, 3, 1> translation;

  /// retract(origin, step) for Ceres' scalar types.
  PoseOf(const Se3& origin, const T* step) {
    Eigen::Matrix<T, 3, 3> turn;
    ceres::AngleAxisToRotationMatrix(step + 3, turn.data());  // column-major, as Eigen's
    const Eigen::Matrix<T, 3, 3> base = origin.rotation.cast<T>();
    rotation = base * turn;
    translation =
        origin.translation.cast<T>() + base * Eigen::Map<const Eigen::Matrix<T, 3, 1>>(step);
  }
};

}  // namespace rovigo::slam
