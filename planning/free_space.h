#pragma once
// Where the rover's centre may be, exactly: between cell centres, along segments, not only at
// centres.

#include <optional>
#include <vector>

#include "maps/costmap.h"
#include "maps/distance_field.h"
#include "maps/occupancy_grid.h"
#include "planning/path.h"

namespace rovigo::planning {

/// Comparisons with the radius forgive this much rounding, metres.
inline constexpr double kClearanceTolerance = 1e-6;

/// A point is free when its cell is passable and no occupied cell's edge is nearer than the radius.
/// Holds references; the maps must outlive it.
class FreeSpace {
 public:
  /// `radius_m` 0 or less: only the costmap counts (map mode kEverything).
  FreeSpace(const maps::OccupancyGrid& grid, const maps::Costmap& costmap, double radius_m);

  const maps::GridGeometry& geometry() const { return costmap_.geometry; }
  const maps::Costmap& costmap() const { return costmap_; }
  double radius_m() const { return radius_m_; }

  /// Metres from a point to the nearest occupied cell's edge, looked at up to `limit_m`; exact.
  double clearance(const TPoint2D& p, double limit_m) const { return clearance(p, p, limit_m); }
  /// The same for the nearest point of a segment.
  double clearance(const TPoint2D& a, const TPoint2D& b, double limit_m) const;
  /// The same for a polyline.
  double clearance(const Path& path, double limit_m) const;

  /// Free with `margin_m` to spare?
  bool is_free(const TPoint2D& p, double margin_m = 0.0) const;
  bool is_free(const TPoint2D& a, const TPoint2D& b, double margin_m = 0.0) const;

  /// Does a segment run through passable cells only? Where it passes exactly through a corner, all
  /// cells around the corner count.
  bool is_passable(const TPoint2D& a, const TPoint2D& b) const;

  /// Integral of the price (1 + weight * soft cost / kMaxSoft) along a segment, by the midpoint
  /// rule at half a cell. Only for segments on the grid.
  double cost(const TPoint2D& a, const TPoint2D& b, double soft_cost_weight) const;

  /// Room to spare, interpolated between cell centres, with its gradient: fast and smooth enough
  /// to push a path by, not exact. Infinity where nothing is in the way; 0 outside the grid.
  struct Slope {
    double room_m = 0.0;
    TPoint2D gradient{0.0, 0.0};
  };
  Slope slope(const TPoint2D& p) const;

  /// A polyline along a -> b that is free although the straight segment scrapes an obstacle's
  /// corner: the middle is pushed outwards. Without a and b; nullopt where that does not help.
  std::optional<std::vector<TPoint2D>> way_round(const TPoint2D& a, const TPoint2D& b) const;

 private:
  double least_room(const TPoint2D& a, const TPoint2D& b) const;
  bool chunk_is_clear(const TPoint2D& a, const TPoint2D& b, double margin_m) const;
  bool push_middle(const TPoint2D& a, const TPoint2D& b, int depth,
                   std::vector<TPoint2D>& out) const;

  const maps::OccupancyGrid& grid_;
  const maps::Costmap& costmap_;
  double radius_m_;
  /// At cell centres: how far one may go from there in any direction before an occupied cell is
  /// nearer than the radius or impassable unknown ground is entered; negative inside the band.
  std::vector<float> room_m_;
};

/// Every segment of the polyline free?
bool is_free(const FreeSpace& space, const Path& path, double margin_m = 0.0);

}  // namespace rovigo::planning
