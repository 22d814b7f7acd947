#pragma once
// OMPL's planners made repeatable: seeded, bounded by iterations. Brings OMPL's headers with it.

#include <ompl/base/MotionValidator.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/spaces/RealVectorBounds.h>

#include <cstdint>
#include <random>
#include <vector>

#include "maps/costmap.h"
#include "planning/planner_config.h"

namespace rovigo::planning {

std::vector<maps::Cell> passable_cells(const maps::Costmap& costmap);
/// The map's rectangle.
ompl::base::RealVectorBounds bounds_of(const maps::GridGeometry& geometry);

/// For motions that are checked as a whole, not up to where they are free.
class WholeMotionValidator : public ompl::base::MotionValidator {
 public:
  using ompl::base::MotionValidator::checkMotion;
  using ompl::base::MotionValidator::MotionValidator;
  bool checkMotion(const ompl::base::State* from, const ompl::base::State* to,
                   std::pair<ompl::base::State*, double>& last_valid) const final;
};

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
