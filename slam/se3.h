#pragma once
// Rigid motions in three dimensions for slam's inner loops, and their bridge to MRPT's CPose3D.

#include <mrpt/poses/CPose3D.h>

#include <Eigen/Core>

#include "maps/geometry.h"

namespace rovigo::slam {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// `a_from_b`: p_a = rotation * p_b + translation.
struct Se3 {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  Eigen::Vector3d operator*(const Eigen::Vector3d& p) const { return rotation * p + translation; }
  Se3 operator*(const Se3& o) const { return {rotation * o.rotation, *this * o.translation}; }
  Se3 inverse() const { return {rotation.transpose(), -(rotation.transpose() * translation)}; }
};

/// Rotation matrix of a rotation vector (Rodrigues), accurate down to zero.
Eigen::Matrix3d so3_exp(const Eigen::Vector3d& rotation_vector);
/// Rotation vector of a rotation matrix, norm in [0, pi].
Eigen::Vector3d so3_log(const Eigen::Matrix3d& rotation);
Eigen::Matrix3d skew(const Eigen::Vector3d& v);

/// Moves `pose` by a step in its own frame: translation first three (m), rotation vector last
/// three (rad). The chart used by every optimiser here.
Se3 retract(const Se3& pose, const Vector6d& step);
/// The step that leads from `from` to `to`: retract(from, local(from, to)) == to.
Vector6d local(const Se3& from, const Se3& to);

/// Nearest rotation matrix, so that rounding does not pile up over long chains of products.
Se3 normalized(const Se3& pose);

Se3 from_planar(const TPose2D& pose);
/// x, y and the heading of the x axis.
TPose2D to_planar(const Se3& pose);

Se3 from_mrpt(const mrpt::poses::CPose3D& pose);
mrpt::poses::CPose3D to_mrpt(const Se3& pose);

bool is_finite(const Se3& pose);

}  // namespace rovigo::slam
