#pragma once
// How much of the free ground a map holds, asked only where the camera could tell.

#include <optional>
#include <vector>

#include "maps/occupancy_grid.h"

namespace rovigo::maps {

/// A pose of the camera over the floor.
struct View {
  TPose2D world_from_camera;  ///< heading: along the optical axis
};
struct FieldOfView {
  double left_rad = 0.5;
  double right_rad = 0.5;
  double range_m = 6.0;
  double floor_range_m = 1.4;  ///< farther floor is too grazing for a return
};

/// Which cells of `truth` (world frame) the camera could tell to be free, from any of the
/// views: before an obstacle within its range, or floor near enough to be seen. A ray that meets
/// nothing within range has no return and shows no more than the floor nearby.
std::vector<bool> cells_in_view(const OccupancyGrid& truth, const std::vector<View>& views,
                                const FieldOfView& field);

/// The same where low obstacles do not stop every ray: those over a low table may meet nothing, and
/// do not tell then whether something hangs before it. `tall`: what reaches up to the greatest
/// height asked for; same frame, any geometry.
std::vector<bool> cells_in_view(const OccupancyGrid& truth, const OccupancyGrid& tall,
                                const std::vector<View>& views, const FieldOfView& field);

/// Of the cells that are free in truth and were in view, or that `estimate` calls free, the share
/// that is free in both.
std::optional<double> free_iou_in_view(const OccupancyGrid& estimate, const OccupancyGrid& truth,
                                       const TPose2D& truth_from_estimate,
                                       const std::vector<bool>& in_view);

}  // namespace rovigo::maps
