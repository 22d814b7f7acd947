#include "planning/path.h"

namespace rovigo::planning {

double length_m(const Path& path) {
  double length = 0.0;
  for (std::size_t i = 1; i < path.points.size(); ++i) {
    length += maps::distance(path.points[i - 1], path.points[i]);
  }
  return length;
}

}  // namespace rovigo::planning
