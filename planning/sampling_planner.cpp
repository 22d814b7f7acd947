#include "planning/sampling_planner.h"

#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/samplers/InformedStateSampler.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/base/terminationconditions/IterationTerminationCondition.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/prm/PRMstar.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/Console.h>

#include <memory>
#include <random>
#include <vector>

namespace rovigo::planning {

namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

using Plane = ob::RealVectorStateSpace;

TPoint2D point_of(const ob::State* state) {
  const auto* s = state->as<Plane::StateType>();
  return {s->values[0], s->values[1]};
}

std::vector<maps::Cell> passable_cells(const maps::Costmap& costmap) {
  std::vector<maps::Cell> cells;
  for (std::size_t i = 0; i < costmap.cells.size(); ++i) {
    if (maps::Costmap::is_passable(costmap.cells[i])) cells.push_back(costmap.geometry.cell_of(i));
  }
  return cells;
}

/// Uniform over the passable cells: maps are mostly walls and unknown ground. OMPL seeds its own
/// samplers from a generator that is global to the process; this one has its seed to itself.
class SeededSampler final : public ob::StateSampler {
 public:
  SeededSampler(const ob::StateSpace* space, const FreeSpace& free, std::uint64_t seed)
      : ob::StateSampler(space),
        geometry_(free.geometry()),
        cells_(passable_cells(free.costmap())),
        random_(seed) {}

  void sampleUniform(ob::State* state) override {
    const std::uint64_t pick = random_() % cells_.size();  // the start's cell is one of them
    const TPoint2D center = geometry_.center_of(cells_[pick]);
    const double half = 0.5 * geometry_.resolution_m;
    set(state, {center.x - half, center.y - half}, {center.x + half, center.y + half});
  }
  void sampleUniformNear(ob::State* state, const ob::State* near, double distance) override {
    const TPoint2D p = point_of(near);
    set(state, {p.x - distance, p.y - distance}, {p.x + distance, p.y + distance});
    space_->enforceBounds(state);
  }
  void sampleGaussian(ob::State* state, const ob::State* mean, double deviation) override {
    const TPoint2D p = point_of(mean);
    std::normal_distribution<double> normal(0.0, deviation);
    auto* s = state->as<Plane::StateType>();
    s->values[0] = p.x + normal(random_);
    s->values[1] = p.y + normal(random_);
    space_->enforceBounds(state);
  }

 private:
  void set(ob::State* state, const TPoint2D& low, const TPoint2D& high) {
    auto* s = state->as<Plane::StateType>();
    s->values[0] = std::uniform_real_distribution<double>(low.x, high.x)(random_);
    s->values[1] = std::uniform_real_distribution<double>(low.y, high.y)(random_);
  }
  maps::GridGeometry geometry_;
  std::vector<maps::Cell> cells_;
  std::mt19937_64 random_;
};

class ExactMotionValidator final : public ob::MotionValidator {
 public:
  ExactMotionValidator(const ob::SpaceInformationPtr& info, const FreeSpace& space)
      : ob::MotionValidator(info), free_(space) {}

  bool checkMotion(const ob::State* a, const ob::State* b) const override {
    return free_.is_free(point_of(a), point_of(b));
  }
  bool checkMotion(const ob::State* a, const ob::State* b,
                   std::pair<ob::State*, double>& last_valid) const override {
    if (checkMotion(a, b)) return true;
    last_valid.second = 0.0;
    if (last_valid.first != nullptr) si_->copyState(last_valid.first, a);
    return false;
  }

 private:
  const FreeSpace& free_;
};

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

ob::SpaceInformationPtr make_space(const FreeSpace& space, std::uint64_t seed) {
  const auto& g = space.geometry();
  auto plane = std::make_shared<Plane>(2);
  ob::RealVectorBounds bounds(2);
  bounds.setLow(0, g.origin.x);
  bounds.setLow(1, g.origin.y);
  bounds.setHigh(0, g.origin.x + g.width * g.resolution_m);
  bounds.setHigh(1, g.origin.y + g.height * g.resolution_m);
  plane->setBounds(bounds);
  plane->setStateSamplerAllocator([seed, &space](const ob::StateSpace* s) {
    return std::make_shared<SeededSampler>(s, space, seed);
  });
  auto info = std::make_shared<ob::SpaceInformation>(plane);
  info->setStateValidityChecker(
      [&space](const ob::State* s) { return space.is_free(point_of(s)); });
  info->setMotionValidator(std::make_shared<ExactMotionValidator>(info, space));
  info->setup();
  return info;
}

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

SamplingResult sample_path(const FreeSpace& space, PlannerKind kind, const TPoint2D& start,
                           const TPoint2D& goal, const OmplConfig& config, std::uint64_t seed) {
  ompl::msg::noOutputHandler();  // a library does not print
  SamplingResult result;
  const ob::SpaceInformationPtr info = make_space(space, seed);
  ob::ScopedState<Plane> from(info);
  ob::ScopedState<Plane> to(info);
  from[0] = start.x;
  from[1] = start.y;
  to[0] = goal.x;
  to[1] = goal.y;
  auto problem = std::make_shared<ob::ProblemDefinition>(info);
  problem->setStartAndGoalStates(from, to, 1e-9);
  problem->setOptimizationObjective(std::make_shared<SeededPathLength>(info));
  const ob::PlannerPtr planner = make_planner(info, kind, config, seed);
  planner->setProblemDefinition(problem);
  planner->setup();
  ob::IterationTerminationCondition limit(static_cast<unsigned>(iterations_of(kind, config)));
  const ob::PlannerStatus status = planner->solve(limit);
  ob::PlannerData data(info);
  planner->getPlannerData(data);
  result.states = data.numVertices();
  if (status != ob::PlannerStatus::EXACT_SOLUTION) return result;
  auto* path = problem->getSolutionPath()->as<og::PathGeometric>();
  for (const ob::State* state : path->getStates()) result.path.points.push_back(point_of(state));
  result.found = is_free(space, result.path);
  return result;
}

}  // namespace rovigo::planning
