#include "sim/marker_place.h"

#include <cmath>

#include "sim/marker_texture.h"
#include "sim/world_model.h"

namespace rovigo::sim {

std::vector<MarkerPlace> markers_in(const World& world) {
  std::vector<MarkerPlace> out;
  for (const Solid& solid : world.model().solids) {
    if (solid.material.pattern != Pattern::kMarker || solid.kind != Solid::Kind::kBox) continue;
    const Eigen::Vector3d face =
        solid.world_from_solid * Eigen::Vector3d(solid.size.x() / 2, 0.0, 0.0);
    const Eigen::Vector3d normal = solid.world_from_solid.linear().col(0);
    out.push_back({static_cast<int>(solid.material.seed),
                   {face.x(), face.y(), std::atan2(normal.y(), normal.x())},
                   face.z(),
                   kMarkerShare * solid.size.y()});
  }
  return out;
}

}  // namespace rovigo::sim
