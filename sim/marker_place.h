#pragma once
// Where a world shows ArUco markers: for who puts a rover down before one, and for who judges it.

#include <vector>

#include "maps/geometry.h"
#include "sim/world.h"

namespace rovigo::sim {

struct MarkerPlace {
  int id = 0;
  TPose2D world_from_face;  ///< the print's middle, on the floor; x out of its face
  double height_m = 0.0;    ///< of its middle
  double side_m = 0.0;      ///< of the black square
};

/// In the order of the world's file.
std::vector<MarkerPlace> markers_in(const World& world);

}  // namespace rovigo::sim
