#include "slam/rig.h"

#include <mrpt/math/CMatrixFixed.h>

namespace rovigo::slam {
namespace {

/// Sensor frame x forward, y left, z up; optical frame x right, y down, z forward. The matrix is
/// written out, because sines of 90 degrees would leave 1e-17 where zeros belong.
mrpt::poses::CPose3D mrpt_sensor_from_optical() {
  mrpt::math::CMatrixDouble44 matrix;
  matrix.setZero();
  matrix(0, 2) = 1.0;
  matrix(1, 0) = -1.0;
  matrix(2, 1) = -1.0;
  matrix(3, 3) = 1.0;
  return mrpt::poses::CPose3D(matrix);
}

}  // namespace

mrpt::poses::CPose3D base_from_optical(const mrpt::poses::CPose3D& base_from_mrpt_sensor) {
  return base_from_mrpt_sensor + mrpt_sensor_from_optical();
}

mrpt::poses::CPose3D base_from_mrpt_sensor(const mrpt::poses::CPose3D& base_from_optical) {
  const mrpt::poses::CPose3D optical_from_mrpt_sensor = -mrpt_sensor_from_optical();
  return base_from_optical + optical_from_mrpt_sensor;
}

}  // namespace rovigo::slam
