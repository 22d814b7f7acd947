#pragma once
// A pinhole camera's rays in the world.

#include <mrpt/img/TCamera.h>
#include <mrpt/poses/CPose3D.h>

#include <Eigen/Core>

namespace rovigo::sim {

/// Ray directions in the world: D(x, y) = d0 + x dx + y dy, with depth 1 along the optical axis.
struct PixelRays {
  Eigen::Vector3d origin;
  Eigen::Vector3d d0;
  Eigen::Vector3d dx;
  Eigen::Vector3d dy;
};

/// `world_from_camera` is the optical frame.
PixelRays pixel_rays(const mrpt::poses::CPose3D& world_from_camera,
                     const mrpt::img::TCamera& camera);

/// The same rays as a mirror at height `floor_z_m` sends them on: they come from below the floor.
PixelRays mirrored(const PixelRays& rays, double floor_z_m);

}  // namespace rovigo::sim
