#pragma once
// Pulls a grid path straight where that costs nothing.

#include "planning/free_space.h"
#include "planning/path.h"

namespace rovigo::planning {

/// A polyline from the path's first to its last point with few vertices: pieces of the path are
/// replaced by straight segments that are free and no dearer (length weighted by soft cost).
/// Pieces of the path that scrape an obstacle's corner are led round it; where that is impossible
/// `ok` is false and `blocked` tells the index of the first point of the piece.
struct ShortcutResult {
  bool ok = true;
  std::size_t blocked = 0;
  Path path;
};
ShortcutResult shortcut(const FreeSpace& space, const Path& path, double soft_cost_weight);

}  // namespace rovigo::planning
