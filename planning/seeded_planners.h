#pragma once
// OMPL's planners made repeatable: seeded, bounded by iterations. Brings OMPL's headers with it.

#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>

#include <cstdint>
#include <random>
#include <vector>

#include "maps/costmap.h"
#include "planning/planner_config.h"

namespace rovigo::planning {

std::vector<maps::Cell> passable_cells(const maps::Costmap& costmap);

struct SeededSolution {
  std::vector<const ompl::base::State*> path;  ///< from start to goal; empty: none was found
  std::size_t states = 0;                      ///< in the planner's tree
  ompl::base::ProblemDefinitionPtr owner;      ///< of the states
};

/// RRTConnect, RRT*, PRM* or BIT*, no others. The space's samplers must be seeded by its allocator:
/// OMPL's own draw from a generator that is global to the process.
SeededSolution solve_seeded(const ompl::base::SpaceInformationPtr& info,
                            const ompl::base::ScopedState<>& start,
                            const ompl::base::ScopedState<>& goal, PlannerKind kind,
                            const OmplConfig& config, std::uint64_t seed);

}  // namespace rovigo::planning
