#include "planning/footprint_planner.h"

#include <ompl/base/spaces/SE2StateSpace.h>

#include <algorithm>
#include <cmath>

#include "planning/seeded_planners.h"

namespace rovigo::planning {

namespace {

namespace ob = ompl::base;

using Poses = ob::SE2StateSpace;

constexpr double kMetersPerRadian = 0.3;  // the circumscribed radius: how far a turn moves a corner

TPose2D pose_of(const ob::State* state) {
  const auto* s = state->as<Poses::StateType>();
  return {s->getX(), s->getY(), s->getYaw()};
}

double heading(const TPoint2D& a, const TPoint2D& b) { return std::atan2(b.y - a.y, b.x - a.x); }

/// The heading or its opposite, whichever is nearer to `to`.
double facing(double heading_rad, double to) {
  const bool opposite = std::abs(maps::wrap_angle(heading_rad - to)) > 0.5 * maps::kPi;
  return opposite ? maps::wrap_angle(heading_rad + maps::kPi) : heading_rad;
}

/// Half of the samples lie near the guide, most of these facing along it: that finds gaps. The
/// others lie wherever the centre may be.
class PoseSampler final : public ob::StateSampler {
 public:
  PoseSampler(const ob::StateSpace* space, const FootprintProblem& problem, std::uint64_t seed)
      : ob::StateSampler(space),
        geometry_(problem.space.centers().geometry()),
        guide_(problem.guide.points),
        cells_(passable_cells(problem.space.centers().costmap())),
        random_(seed) {}

  void sampleUniform(ob::State* state) override {
    const bool near_guide = random_() % 2 == 0;
    const std::size_t i = near_guide ? random_() % guide_.size() : random_() % cells_.size();
    const TPoint2D middle = near_guide ? guide_[i] : geometry_.center_of(cells_[i]);
    const bool along = near_guide && random_() % 4 != 0;
    const double yaw = along ? direction_at(i) + normal(0.1) : between(-maps::kPi, maps::kPi);
    const double reach = (near_guide ? 1.0 : 0.5) * geometry_.resolution_m;
    set(state, {middle.x + between(-reach, reach), middle.y + between(-reach, reach), yaw});
  }
  void sampleUniformNear(ob::State* state, const ob::State* near, double distance) override {
    const TPose2D p = pose_of(near);
    const double turn = distance / kMetersPerRadian;
    set(state, {p.x + between(-distance, distance), p.y + between(-distance, distance),
                p.phi + between(-turn, turn)});
  }
  void sampleGaussian(ob::State* state, const ob::State* mean, double deviation) override {
    const TPose2D p = pose_of(mean);
    set(state, {p.x + normal(deviation), p.y + normal(deviation),
                p.phi + normal(deviation / kMetersPerRadian)});
  }

 private:
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  double normal(double deviation) {
    return std::normal_distribution<double>(0.0, deviation)(random_);
  }
  double direction_at(std::size_t i) const {
    constexpr std::size_t kReach = 3;
    const TPoint2D& before = guide_[i - std::min(i, kReach)];
    return heading(before, guide_[std::min(i + kReach, guide_.size() - 1)]);
  }
  void set(ob::State* state, const TPose2D& pose) {
    auto* s = state->as<Poses::StateType>();
    s->setXY(pose.x, pose.y);
    s->setYaw(maps::wrap_angle(pose.phi));
    space_->enforceBounds(state);
  }

  maps::GridGeometry geometry_;
  const std::vector<TPoint2D>& guide_;
  std::vector<maps::Cell> cells_;
  std::mt19937_64 random_;
};

/// Turn, drive, turn; headings count up to their opposite.
class TurnDriveTurn final : public WholeMotionValidator {
 public:
  using WholeMotionValidator::checkMotion;
  TurnDriveTurn(const ob::SpaceInformationPtr& info, const FootprintSpace& space)
      : WholeMotionValidator(info), space_(space) {}

  bool checkMotion(const ob::State* from, const ob::State* to) const override {
    const TPose2D a = pose_of(from), b = pose_of(to);
    const TPoint2D p = maps::position_of(a), q = maps::position_of(b);
    if (maps::distance(p, q) <= 1e-9) return space_.turn_is_free(p, a.phi, facing(b.phi, a.phi));
    const double along = heading(p, q);
    return space_.drive_is_free(p, q) && space_.turn_is_free(p, facing(a.phi, along), along) &&
           space_.turn_is_free(q, along, facing(b.phi, along));
  }

 private:
  const FootprintSpace& space_;
};

ob::SpaceInformationPtr make_space(const FootprintProblem& problem, std::uint64_t seed) {
  auto poses = std::make_shared<Poses>();
  poses->setBounds(bounds_of(problem.space.centers().geometry()));
  poses->setSubspaceWeight(1, kMetersPerRadian);
  poses->setStateSamplerAllocator([&problem, seed](const ob::StateSpace* s) {
    return std::make_shared<PoseSampler>(s, problem, seed);
  });
  auto info = std::make_shared<ob::SpaceInformation>(poses);
  info->setStateValidityChecker(
      [&problem](const ob::State* s) { return problem.space.is_free(pose_of(s)); });
  info->setMotionValidator(std::make_shared<TurnDriveTurn>(info, problem.space));
  info->setup();
  return info;
}

/// The path as it is driven: forwards only, and from each leg straight to the next.
class DrivenPath {
 public:
  DrivenPath(const FootprintProblem& problem, std::vector<TPoint2D> points)
      : problem_(problem), points_(std::move(points)) {}

  bool is_free() const {
    for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
      if (!turn_is_free(i) || !problem_.space.drive_is_free(points_[i], points_[i + 1]))
        return false;
    }
    return turn_is_free(points_.size() - 1);
  }

  /// Leaves out points as long as one is found that need not be visited. That also mends turns that
  /// are free backwards only.
  void shorten() {
    for (bool again = true; again;) {
      again = false;
      for (std::size_t i = 1; i + 1 < points_.size();) {
        const TPoint2D left_out = points_[i];
        const int blocked = blocked_turns(i - 1, i + 1);
        points_.erase(points_.begin() + static_cast<std::ptrdiff_t>(i));
        const bool drives = problem_.space.drive_is_free(points_[i - 1], points_[i]);
        const int still_blocked = drives ? blocked_turns(i - 1, i) : 0;
        if (drives && (still_blocked == 0 || still_blocked < blocked)) {
          again = true;
        } else {
          points_.insert(points_.begin() + static_cast<std::ptrdiff_t>(i), left_out);
          ++i;
        }
      }
    }
  }

  Path take() { return {std::move(points_)}; }

 private:
  int blocked_turns(std::size_t first, std::size_t last) const {
    int count = 0;
    for (std::size_t i = first; i <= last; ++i) count += turn_is_free(i) ? 0 : 1;
    return count;
  }
  /// On the spot at point `i`, from the leg before to the leg after.
  bool turn_is_free(std::size_t i) const {
    const bool is_last = i + 1 == points_.size();
    const auto from = i == 0 ? problem_.start_heading_rad : heading(points_[i - 1], points_[i]);
    const auto to = is_last ? problem_.goal_heading_rad : heading(points_[i], points_[i + 1]);
    return !from || !to || problem_.space.turn_is_free(points_[i], *from, *to);
  }

  const FootprintProblem& problem_;
  std::vector<TPoint2D> points_;
};

}  // namespace

FootprintResult plan_with_footprint(const FootprintProblem& problem, PlannerKind kind,
                                    const OmplConfig& config, std::uint64_t seed) {
  const auto& guide = problem.guide.points;
  constexpr std::size_t kReach = 6;  // cells along the guide that tell its direction
  const double along_start = heading(problem.start, guide[std::min(kReach, guide.size() - 1)]);
  const double along_goal =
      heading(guide[guide.size() - 1 - std::min(kReach, guide.size() - 1)], problem.goal);
  const ob::SpaceInformationPtr info = make_space(problem, seed);
  ob::ScopedState<Poses> from(info), to(info);
  from->setXY(problem.start.x, problem.start.y);
  from->setYaw(maps::wrap_angle(problem.start_heading_rad.value_or(along_start)));
  to->setXY(problem.goal.x, problem.goal.y);
  to->setYaw(maps::wrap_angle(problem.goal_heading_rad.value_or(along_goal)));
  FootprintResult result;
  std::vector<TPoint2D> points;
  const SeededSolution solution = solve_seeded(info, from, to, kind, config, seed);
  result.states = solution.states;
  for (const ob::State* state : solution.path) {
    const TPoint2D p = maps::position_of(pose_of(state));
    if (points.empty() || maps::distance(points.back(), p) > 1e-6) points.push_back(p);
  }
  if (points.empty()) return result;
  DrivenPath driven(problem, std::move(points));
  driven.shorten();
  if (!driven.is_free()) return result;
  result.found = true;
  result.path = driven.take();
  return result;
}

}  // namespace rovigo::planning
