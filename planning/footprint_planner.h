#pragma once
// OMPL's planners for the rover's rectangle: through gaps that its turning circle does not fit in.

#include <cstdint>
#include <optional>
#include <vector>

#include "planning/footprint.h"
#include "planning/planner_config.h"

namespace rovigo::planning {

struct FootprintProblem {
  const FootprintSpace& space;
  TPoint2D start, goal;
  /// Headings the rover has at the start and must have at the goal; none: along the path.
  std::optional<double> start_heading_rad, goal_heading_rad;
  /// A way for the centre, start and goal included: some samples are drawn near it.
  const Path& guide;
};

struct FootprintResult {
  bool found = false;
  Path path;  ///< turn on the spot to each leg, drive it straight: free throughout
  std::size_t states = 0;
};

/// States are position and heading, a motion turns, drives straight ahead and turns again, and all
/// of what it sweeps is checked. Heading and its opposite cover the same ground, so to the planner
/// they are one, and every motion can be reversed; that the rover only drives forwards is checked
/// on the path found. Bounded by iterations and seeded. Precondition: kind is RRTConnect, RRT*,
/// BIT* or PRM*.
FootprintResult plan_with_footprint(const FootprintProblem& problem, PlannerKind kind,
                                    const OmplConfig& config, std::uint64_t seed);

}  // namespace rovigo::planning
