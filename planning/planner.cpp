#include "planning/planner.h"

#include <mutex>

#include "planning/plan_query.h"

namespace rovigo::planning {

namespace {

/// Workspaces for searches, one per query in flight, so that queries may run side by side.
class SearchPool {
 public:
  std::unique_ptr<SearchWorkspace> take() {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return std::make_unique<SearchWorkspace>();
    auto search = std::move(idle_.back());
    idle_.pop_back();
    return search;
  }
  void give_back(std::unique_ptr<SearchWorkspace> search) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(search));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<SearchWorkspace>> idle_;
};

}  // namespace

struct Planner::Impl {
  PlanningContext context;
  mutable SearchPool pool;
};

Planner::Planner(const maps::OccupancyGrid& grid, const maps::RobotModel& robot,
                 const maps::InflationConfig& inflation, const PlannerConfig& config)
    : impl_(new Impl{.context{grid, robot, inflation, config}, .pool{}}) {}
Planner::Planner(const maps::OccupancyGrid& grid, const maps::Costmap& costmap,
                 const maps::RobotModel& robot, const maps::InflationConfig& inflation,
                 const PlannerConfig& config)
    : impl_(new Impl{.context{grid, robot, inflation, config, &costmap}, .pool{}}) {}
Planner::~Planner() = default;
Planner::Planner(Planner&&) noexcept = default;
Planner& Planner::operator=(Planner&&) noexcept = default;

PlanResult Planner::plan(const PlanRequest& request) const {
  auto search = impl_->pool.take();
  PlanResult result = PlanQuery(impl_->context, *search, request).run();
  impl_->pool.give_back(std::move(search));
  return result;
}

const maps::Costmap& Planner::costmap() const { return impl_->context.costmap; }
const maps::OccupancyGrid& Planner::grid() const { return impl_->context.grid; }

}  // namespace rovigo::planning
