#pragma once
// Geometry without time.

#include <vector>

#include "maps/geometry.h"

namespace rovigo::planning {

/// A polyline in the map frame, metres.
struct Path {
  std::vector<TPoint2D> points;
};

double length_m(const Path& path);

}  // namespace rovigo::planning
