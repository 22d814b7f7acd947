#pragma once
// From a polyline to curves that a differential drive follows without stopping.

#include <optional>
#include <vector>

#include "planning/bspline.h"
#include "planning/free_space.h"
#include "planning/path.h"
#include "planning/planner_config.h"

namespace rovigo::planning {

/// One curve, driven without a stop; between two pieces the rover turns in place.
struct PathPiece {
  CubicBSpline curve;
  bool slow = false;  ///< leaves the band around obstacles
};

struct SmoothingProblem {
  /// Free throughout (FreeSpace::is_free), at least two points, no two in a row the same.
  Path polyline;
  /// Indices of vertices that the result must pass through; first and last always are.
  std::vector<std::size_t> pinned;
  /// Directions the first and last curve should have at their ends, where there is room for it.
  std::optional<double> start_heading_rad;
  /// With a start heading: the curvature there, for a rover that is already under way.
  double start_curvature_1_m = 0.0;
  std::optional<double> goal_heading_rad;
};

/// A penalised cubic B-spline (Eilers & Marx 1996) through points of the polyline: it minimises
/// the squared distances to them plus lambda^4 times its squared second derivative. Points nearer
/// to an obstacle than comfortable are pushed away from it. Where the curve is not free, checked
/// between samples too, or too tight, it is drawn back towards the polyline or eased, first by
/// weights, then by finer control points; where that does not help, the polyline is kept there and
/// the rover turns in place at its vertex. So every piece is free; inside, it is C2.
std::vector<PathPiece> smooth(const FreeSpace& space, const SmoothingProblem& problem,
                              const SplineConfig& config);

/// Points along the pieces, no further apart than `spacing_m`.
Path sampled(const std::vector<PathPiece>& pieces, double spacing_m);

/// Parameters along a curve such that the points are no further apart than about `spacing_m`;
/// knots are among them.
std::vector<double> sample_parameters(const CubicBSpline& curve, double spacing_m);

}  // namespace rovigo::planning
