#include "slam/se3.h"

#include <Eigen/Geometry>
#include <cmath>

namespace rovigo::slam {

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

Eigen::Matrix3d so3_exp(const Eigen::Vector3d& rotation_vector) {
  const double angle2 = rotation_vector.squaredNorm();
  const Eigen::Matrix3d k = skew(rotation_vector);
  double a = 1.0 - angle2 / 6.0;   // sin(x)/x near zero
  double b = 0.5 - angle2 / 24.0;  // (1 - cos(x))/x^2 near zero
  if (angle2 > 1e-8) {
    const double angle = std::sqrt(angle2);
    a = std::sin(angle) / angle;
    b = (1.0 - std::cos(angle)) / angle2;
  }
  return Eigen::Matrix3d::Identity() + a * k + b * k * k;
}

Eigen::Vector3d so3_log(const Eigen::Matrix3d& rotation) {
  // Through the quaternion: well conditioned at zero and at half a turn alike.
  Eigen::Quaterniond q(rotation);
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const double n = q.vec().norm();
  const double scale = n > 1e-10 ? 2.0 * std::atan2(n, q.w()) / n : 2.0 / q.w();
  return scale * q.vec();
}

Se3 retract(const Se3& pose, const Vector6d& step) {
  return {pose.rotation * so3_exp(step.tail<3>()),
          pose.translation + pose.rotation * step.head<3>()};
}

Vector6d local(const Se3& from, const Se3& to) {
  Vector6d step;
  step.head<3>() = from.rotation.transpose() * (to.translation - from.translation);
  step.tail<3>() = so3_log(from.rotation.transpose() * to.rotation);
  return step;
}

Se3 normalized(const Se3& pose) {
  return {Eigen::Quaterniond(pose.rotation).normalized().toRotationMatrix(), pose.translation};
}

Se3 from_planar(const TPose2D& pose) {
  return {Eigen::AngleAxisd(pose.phi, Eigen::Vector3d::UnitZ()).toRotationMatrix(),
          {pose.x, pose.y, 0.0}};
}

TPose2D to_planar(const Se3& pose) {
  return {pose.translation.x(), pose.translation.y(),
          std::atan2(pose.rotation(1, 0), pose.rotation(0, 0))};
}

Se3 from_mrpt(const mrpt::poses::CPose3D& pose) {
  Se3 out;
  const auto& r = pose.getRotationMatrix();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) out.rotation(i, j) = r(i, j);
  }
  out.translation = {pose.x(), pose.y(), pose.z()};
  return out;
}

mrpt::poses::CPose3D to_mrpt(const Se3& pose) {
  mrpt::math::CMatrixDouble33 r;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) r(i, j) = pose.rotation(i, j);
  }
  mrpt::math::CVectorFixedDouble<3> t;
  for (int i = 0; i < 3; ++i) t[i] = pose.translation[i];
  return mrpt::poses::CPose3D(r, t);
}

bool is_finite(const Se3& pose) {
  return pose.rotation.allFinite() && pose.translation.allFinite();
}

}  // namespace rovigo::slam
