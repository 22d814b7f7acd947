#include "sim/pixel_rays.h"

namespace rovigo::sim {

PixelRays pixel_rays(const mrpt::poses::CPose3D& world_from_camera,
                     const mrpt::img::TCamera& camera) {
  Eigen::Matrix3d r;
  const auto& m = world_from_camera.getRotationMatrix();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) r(i, j) = m(i, j);
  }
  PixelRays rays;
  rays.origin = {world_from_camera.x(), world_from_camera.y(), world_from_camera.z()};
  rays.dx = r.col(0) / camera.fx();
  rays.dy = r.col(1) / camera.fy();
  rays.d0 = r.col(2) - camera.cx() * rays.dx - camera.cy() * rays.dy;
  return rays;
}

PixelRays mirrored(const PixelRays& rays, double floor_z_m) {
  PixelRays out = rays;
  out.origin.z() = 2.0 * floor_z_m - rays.origin.z();
  for (auto* direction : {&out.d0, &out.dx, &out.dy}) direction->z() = -direction->z();
  return out;
}

}  // namespace rovigo::sim
