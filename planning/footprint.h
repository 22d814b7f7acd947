#pragma once
// The rover's rectangle on the grid, exactly: standing, driving straight, turning in place.

#include <vector>

#include "maps/occupancy_grid.h"
#include "maps/robot_model.h"
#include "planning/free_space.h"
#include "planning/trajectory.h"

namespace rovigo::planning {

/// A rectangle centred on base_link, its length along the heading.
struct Footprint {
  double half_length_m = 0.0;
  double half_width_m = 0.0;
  double inscribed_radius_m() const;
  double circumscribed_radius_m() const;
};
Footprint footprint_of(const maps::RobotModel& robot);

/// Outlines along a trajectory, closed, at most `spacing_m` apart; for pictures.
std::vector<std::vector<TPoint2D>> footprint_outlines(const Trajectory& trajectory,
                                                      const Footprint& footprint, double spacing_m);

/// Where the rectangle may be and how it may move. Holds references; the maps must outlive it.
class FootprintSpace {
 public:
  /// `centers`: where the centre may be, with the inscribed radius. The rectangle keeps `margin_m`
  /// on all sides.
  FootprintSpace(const maps::OccupancyGrid& grid, const FreeSpace& centers,
                 const Footprint& footprint, double margin_m);

  const FreeSpace& centers() const { return centers_; }

  bool is_free(const TPose2D& pose) const;
  /// Straight on, facing from `a` to `b`: what is swept is a rectangle again.
  bool drive_is_free(const TPoint2D& a, const TPoint2D& b) const;
  /// In place from one heading to another, the short way round; half a turn must be free both ways.
  bool turn_is_free(const TPoint2D& at, double from_rad, double to_rad) const;

 private:
  struct Box;
  bool is_free(const Box& box) const;
  std::vector<TPoint2D> obstacles_near(const TPoint2D& at, double reach_m) const;
  bool overlaps(const Box& box, const TPoint2D& cell_center) const;

  const maps::OccupancyGrid& grid_;
  const FreeSpace& centers_;
  Footprint footprint_;  ///< with its margin
};

}  // namespace rovigo::planning
