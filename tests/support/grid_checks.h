#pragma once
// Questions to a grid that precision and recall do not answer.

#include <optional>
#include <vector>

#include "maps/occupancy_grid.h"
#include "sim/world.h"

namespace rovigo::test {

/// Occupied cells of `estimate` amid ground that is free in truth: nothing occupied or unknown
/// within 0.15 m. Only clusters of three or more count: what a person leaves is as large as a leg.
int ghost_cells(const maps::OccupancyGrid& estimate, const maps::OccupancyGrid& truth,
                const TPose2D& truth_from_estimate);

/// Which cells of `truth` (world frame) the camera could tell to be free, from any of the true
/// poses: before an obstacle within its range, or floor near enough to be seen. A ray that meets
/// nothing within range has no return and shows no more than the floor nearby.
struct View {
  TPose2D world_from_camera;  ///< heading: along the optical axis
};
struct FieldOfView {
  double left_rad = 0.5;
  double right_rad = 0.5;
  double range_m = 6.0;
  double floor_range_m = 1.4;  ///< farther floor is too grazing for a return
};
std::vector<bool> cells_in_view(const maps::OccupancyGrid& truth, const std::vector<View>& views,
                                const FieldOfView& field);

/// Of the cells that are free in truth and were in view, or that `estimate` calls free, the share
/// that is free in both.
std::optional<double> free_iou_in_view(const maps::OccupancyGrid& estimate,
                                       const maps::OccupancyGrid& truth,
                                       const TPose2D& truth_from_estimate,
                                       const std::vector<bool>& in_view);

/// Distance between the walls that are met from `middle` (truth's frame) along +x and -x; the
/// median over parallel rays `spread_m` to either side. None when a ray leaves the grid.
std::optional<double> wall_to_wall_m(const maps::OccupancyGrid& grid,
                                     const TPose2D& grid_from_truth, const TPoint2D& middle,
                                     double spread_m);

/// Of the truly occupied cells under the solids of `world` that are part of a low table, the share
/// that `estimate` holds occupied. None where the camera saw no low table.
std::optional<double> low_table_share(const maps::OccupancyGrid& estimate,
                                      const maps::OccupancyGrid& truth,
                                      const TPose2D& truth_from_estimate, const sim::World& world);

}  // namespace rovigo::test
