#pragma once
// A world's visible solids cut into flat faces, as the renderer needs them.

#include <Eigen/Core>
#include <vector>

#include "sim/textures.h"
#include "sim/world_model.h"

namespace rovigo::sim {

/// A flat, textured, lit piece of a surface. Texture coordinates are texels:
/// u = (p - origin) . u_axis + u_offset.
struct Face {
  Eigen::Vector3d origin;
  Eigen::Vector3d normal;  ///< unit, outwards
  Eigen::Vector3d u_axis;
  Eigen::Vector3d v_axis;
  double u_offset = 0.0;
  double v_offset = 0.0;
  const Texture* texture = nullptr;
  Eigen::Vector3f color;  ///< red, green, blue, light included
};

struct Quad {
  Eigen::Vector3d corners[4];
  int face = 0;
};

struct Surfaces {
  std::vector<Face> faces;
  std::vector<Quad> quads;
};

/// `library` owns the textures that faces point to; without one they have none.
Surfaces make_surfaces(const std::vector<Solid>& solids, TextureLibrary* library);

}  // namespace rovigo::sim
