#include "planning/sampling_planner.h"

#include <ompl/base/spaces/RealVectorStateSpace.h>

#include <memory>

#include "planning/seeded_planners.h"

namespace rovigo::planning {

namespace {

namespace ob = ompl::base;

using Plane = ob::RealVectorStateSpace;

TPoint2D point_of(const ob::State* state) {
  const auto* s = state->as<Plane::StateType>();
  return {s->values[0], s->values[1]};
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

class ExactMotionValidator final : public WholeMotionValidator {
 public:
  using WholeMotionValidator::checkMotion;
  ExactMotionValidator(const ob::SpaceInformationPtr& info, const FreeSpace& space)
      : WholeMotionValidator(info), free_(space) {}

  bool checkMotion(const ob::State* a, const ob::State* b) const override {
    return free_.is_free(point_of(a), point_of(b));
  }

 private:
  const FreeSpace& free_;
};

ob::SpaceInformationPtr make_space(const FreeSpace& space, std::uint64_t seed) {
  auto plane = std::make_shared<Plane>(2);
  plane->setBounds(bounds_of(space.geometry()));
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

}  // namespace

SamplingResult sample_path(const FreeSpace& space, PlannerKind kind, const TPoint2D& start,
                           const TPoint2D& goal, const OmplConfig& config, std::uint64_t seed) {
  SamplingResult result;
  const ob::SpaceInformationPtr info = make_space(space, seed);
  ob::ScopedState<Plane> from(info);
  ob::ScopedState<Plane> to(info);
  from[0] = start.x;
  from[1] = start.y;
  to[0] = goal.x;
  to[1] = goal.y;
  const SeededSolution solution = solve_seeded(info, from, to, kind, config, seed);
  result.states = solution.states;
  for (const ob::State* state : solution.path) result.path.points.push_back(point_of(state));
  result.found = !solution.path.empty() && is_free(space, result.path);
  return result;
}

}  // namespace rovigo::planning
