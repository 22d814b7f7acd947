#pragma once
// OMPL's planners in the plane, behind a light header.

#include <cstdint>

#include "planning/free_space.h"
#include "planning/planner_config.h"

namespace rovigo::planning {

struct SamplingResult {
  bool found = false;
  Path path;               ///< every segment free
  std::size_t states = 0;  ///< in the planner's tree
};

/// RRTConnect, RRT*, PRM* or BIT* (Kuffner & LaValle 2000; Karaman & Frazzoli 2011; Gammell et al.
/// 2015) between two free points, bounded by iterations and seeded, so that the same arguments give
/// the same path. Motions are checked exactly, not at samples. Precondition: kind is one of these.
SamplingResult sample_path(const FreeSpace& space, PlannerKind kind, const TPoint2D& start,
                           const TPoint2D& goal, const OmplConfig& config, std::uint64_t seed);

}  // namespace rovigo::planning
