#include "planning/seeded_planners.h"

#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/samplers/InformedStateSampler.h>
#include <ompl/base/terminationconditions/IterationTerminationCondition.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/prm/PRMstar.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/Console.h>

#include <memory>

namespace rovigo::planning {

namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

/// The planner's own generator, made deterministic.
class SeededRrtStar final : public og::RRTstar {
 public:
  SeededRrtStar(const ob::SpaceInformationPtr& info, std::uint64_t seed) : og::RRTstar(info) {
    rng_.setLocalSeed(static_cast<std::uint_fast32_t>(seed & 0x7FFFFFFFU) + 1U);
  }
};
class SeededRrtConnect final : public og::RRTConnect {
 public:
  SeededRrtConnect(const ob::SpaceInformationPtr& info, std::uint64_t seed) : og::RRTConnect(info) {
    rng_.setLocalSeed(static_cast<std::uint_fast32_t>(seed & 0x7FFFFFFFU) + 1U);
  }
};

/// PRM's own solve() builds its roadmap by the clock and beside a second thread; this one by
/// samples.
class SeededPrmStar final : public og::PRMstar {
 public:
  SeededPrmStar(const ob::SpaceInformationPtr& info, std::uint64_t seed) : og::PRMstar(info) {
    rng_.setLocalSeed(static_cast<std::uint_fast32_t>(seed & 0x7FFFFFFFU) + 1U);
  }
  ob::PlannerStatus solve(const ob::PlannerTerminationCondition& limit) override {
    checkValidity();
    const auto start = addMilestone(si_->cloneState(pis_.nextStart()));
    const auto goal = addMilestone(si_->cloneState(pis_.nextGoal()));
    growRoadmap(limit);
    if (!sameComponent(start, goal)) return ob::PlannerStatus::TIMEOUT;
    pdef_->addSolutionPath(constructSolution(start, goal));
    return ob::PlannerStatus::EXACT_SOLUTION;
  }
};

/// Draws from the space's own, seeded sampler what may still shorten the path; OMPL's informed
/// samplers draw from the generator that is global to the process.
class SeededInformedSampler final : public ob::InformedSampler {
 public:
  SeededInformedSampler(const ob::ProblemDefinitionPtr& problem, unsigned calls)
      : ob::InformedSampler(problem, calls), sampler_(space_->allocStateSampler()) {}

  bool sampleUniform(ob::State* state, const ob::Cost& most) override {
    for (unsigned i = 0; i < numIters_; ++i) {
      sampler_->sampleUniform(state);
      if (opt_->isCostBetterThan(heuristicSolnCost(state), most)) return true;
    }
    return false;
  }
  bool sampleUniform(ob::State* state, const ob::Cost& least, const ob::Cost& most) override {
    for (unsigned i = 0; i < numIters_; ++i) {
      if (!sampleUniform(state, most)) return false;
      if (!opt_->isCostBetterThan(heuristicSolnCost(state), least)) return true;
    }
    return false;
  }
  bool hasInformedMeasure() const override { return false; }
  double getInformedMeasure(const ob::Cost&) const override { return space_->getMeasure(); }

 private:
  ob::StateSamplerPtr sampler_;
};

class SeededPathLength final : public ob::PathLengthOptimizationObjective {
 public:
  using ob::PathLengthOptimizationObjective::PathLengthOptimizationObjective;
  ob::InformedSamplerPtr allocInformedStateSampler(const ob::ProblemDefinitionPtr& problem,
                                                   unsigned calls) const override {
    return std::make_shared<SeededInformedSampler>(problem, calls);
  }
};

ob::PlannerPtr make_planner(const ob::SpaceInformationPtr& info, PlannerKind kind,
                            const OmplConfig& config, std::uint64_t seed) {
  if (kind == PlannerKind::kBitStar) return std::make_shared<og::BITstar>(info);
  if (kind == PlannerKind::kPrmStar) return std::make_shared<SeededPrmStar>(info, seed);
  if (kind == PlannerKind::kRrtStar) {
    auto planner = std::make_shared<SeededRrtStar>(info, seed);
    planner->setRange(config.step_m);
    planner->setGoalBias(config.goal_bias);
    return planner;
  }
  auto planner = std::make_shared<SeededRrtConnect>(info, seed);
  planner->setRange(config.step_m);
  return planner;
}

int iterations_of(PlannerKind kind, const OmplConfig& config) {
  switch (kind) {
    case PlannerKind::kRrtStar:
      return config.rrtstar_iterations;
    case PlannerKind::kBitStar:
      return config.bitstar_iterations;
    case PlannerKind::kPrmStar:
      return config.prmstar_iterations;
    default:
      return config.rrtconnect_iterations;
  }
}

}  // namespace

ob::RealVectorBounds bounds_of(const maps::GridGeometry& g) {
  ob::RealVectorBounds bounds(2);
  bounds.setLow(0, g.origin.x);
  bounds.setLow(1, g.origin.y);
  bounds.setHigh(0, g.origin.x + g.width * g.resolution_m);
  bounds.setHigh(1, g.origin.y + g.height * g.resolution_m);
  return bounds;
}

bool WholeMotionValidator::checkMotion(const ob::State* from, const ob::State* to,
                                       std::pair<ob::State*, double>& last_valid) const {
  if (checkMotion(from, to)) return true;
  last_valid.second = 0.0;
  if (last_valid.first != nullptr) si_->copyState(last_valid.first, from);
  return false;
}

std::vector<maps::Cell> passable_cells(const maps::Costmap& costmap) {
  std::vector<maps::Cell> cells;
  for (std::size_t i = 0; i < costmap.cells.size(); ++i) {
    if (maps::Costmap::is_passable(costmap.cells[i])) cells.push_back(costmap.geometry.cell_of(i));
  }
  return cells;
}

SeededSolution solve_seeded(const ob::SpaceInformationPtr& info, const ob::ScopedState<>& start,
                            const ob::ScopedState<>& goal, PlannerKind kind,
                            const OmplConfig& config, std::uint64_t seed) {
  ompl::msg::noOutputHandler();  // a library does not print
  SeededSolution result;
  auto problem = std::make_shared<ob::ProblemDefinition>(info);
  problem->setStartAndGoalStates(start, goal, 1e-9);
  problem->setOptimizationObjective(std::make_shared<SeededPathLength>(info));
  const ob::PlannerPtr planner = make_planner(info, kind, config, seed);
  planner->setProblemDefinition(problem);
  planner->setup();
  ob::IterationTerminationCondition limit(static_cast<unsigned>(iterations_of(kind, config)));
  const ob::PlannerStatus status = planner->solve(limit);
  ob::PlannerData data(info);
  planner->getPlannerData(data);
  result.states = data.numVertices();
  result.owner = problem;
  if (status != ob::PlannerStatus::EXACT_SOLUTION) return result;
  const auto* path = problem->getSolutionPath()->as<og::PathGeometric>();
  for (std::size_t i = 0; i < path->getStateCount(); ++i) {
    result.path.push_back(path->getState(static_cast<unsigned>(i)));
  }
  return result;
}

}  // namespace rovigo::planning
