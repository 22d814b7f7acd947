// Which of a world's surfaces a camera has looked at: for scoring only.

#include <cmath>
#include <vector>

#include "sim/pixel_rays.h"
#include "sim/ray_scene.h"
#include "sim/simulator.h"
#include "sim/surfaces.h"
#include "sim/world_model.h"

namespace rovigo::sim {

struct SeenSurfaces::Impl {
  Impl(const World& world, double resolution_m, double low, double high)
      : surfaces(make_surfaces(world.model().solids, nullptr)),
        scene(surfaces.quads),
        truth(true_grid(world, resolution_m, low, high)),
        min_height_m(low),
        max_height_m(high),
        seen(truth.cells.size(), false) {}

  void mark(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) {
    constexpr double kIntoSurfaceM =
        1e-4;  // a point on a cell's border belongs to the solid's cell
    if (point.z() < min_height_m || point.z() > max_height_m) return;
    const Eigen::Vector3d inside = point - kIntoSurfaceM * normal;
    const maps::Cell c = truth.geometry.cell_at({inside.x(), inside.y()});
    if (truth.geometry.contains(c)) seen[truth.geometry.index_of(c)] = true;
  }

  Surfaces surfaces;
  RayScene scene;
  maps::OccupancyGrid truth;
  double min_height_m;
  double max_height_m;
  std::vector<bool> seen;
};

SeenSurfaces::SeenSurfaces(const World& world, double resolution_m, double min_height_m,
                           double max_height_m)
    : impl_(std::make_unique<Impl>(world, resolution_m, min_height_m, max_height_m)) {}
SeenSurfaces::~SeenSurfaces() = default;

void SeenSurfaces::add_view(const mrpt::poses::CPose3D& world_from_camera,
                            const mrpt::img::TCamera& camera) {
  constexpr int kStride = 4;  // pixels
  const CameraNoise limits;   // too near, too far or too grazing gives no return: not seen
  const double min_cosine = std::cos(limits.max_incidence_deg * maps::kPi / 180.0);
  const PixelRays rays = pixel_rays(world_from_camera, camera);
  const int columns = (static_cast<int>(camera.ncols) + kStride - 1) / kStride;
  std::vector<std::uint32_t> quad(static_cast<std::size_t>(columns));
  std::vector<float> depth(static_cast<std::size_t>(columns));
  for (int y = 0; y < static_cast<int>(camera.nrows); y += kStride) {
    const Eigen::Vector3d first = rays.d0 + y * rays.dy;
    const Eigen::Vector3d step = kStride * rays.dx;
    RayRow row;
    row.origin = rays.origin.cast<float>();
    row.first = first.cast<float>();
    row.step = step.cast<float>();
    row.count = columns;
    row.max_t = static_cast<float>(limits.max_range_m);
    impl_->scene.cast_row(row, quad.data(), depth.data());
    for (int i = 0; i < columns; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (quad[k] == RayScene::kMiss) continue;
      const auto& q = impl_->surfaces.quads[quad[k]];
      const Eigen::Vector3d& normal =
          impl_->surfaces.faces[static_cast<std::size_t>(q.face)].normal;
      const Eigen::Vector3d ray = first + i * step;
      if (std::abs(normal.dot(ray.normalized())) < min_cosine) continue;
      if (depth[k] < static_cast<float>(limits.min_range_m)) continue;
      impl_->mark(rays.origin + static_cast<double>(depth[k]) * ray, normal);
    }
  }
}

maps::OccupancyGrid SeenSurfaces::grid() const {
  maps::OccupancyGrid out = impl_->truth;
  for (std::size_t i = 0; i < out.cells.size(); ++i) {
    if (maps::OccupancyGrid::is_occupied(out.cells[i]) && !impl_->seen[i]) {
      out.cells[i] = maps::OccupancyGrid::kUnknown;
    }
  }
  return out;
}

}  // namespace rovigo::sim
