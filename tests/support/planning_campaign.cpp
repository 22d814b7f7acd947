#include "tests/support/planning_campaign.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <exception>
#include <filesystem>
#include <optional>
#include <random>

#include "app/parallel.h"
#include "maps/movingai.h"
#include "maps/ros_map.h"
#include "planning/check.h"
#include "planning/planner.h"
#include "sim/simulator.h"
#include "tests/support/run_rovigo.h"

namespace rovigo::test {

namespace {

using maps::Cell;
using maps::Costmap;
using maps::OccupancyGrid;
using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using planning::PlanRequest;
using planning::PlanResult;
using planning::PlanStatus;

/// Which cells can be reached from each other, by flooding; 0 where the rover cannot be.
std::vector<int> components(const Costmap& costmap) {
  std::vector<int> label(costmap.cells.size(), 0);
  int next_label = 0;
  std::deque<Cell> queue;
  for (std::size_t i = 0; i < label.size(); ++i) {
    const Cell seed = costmap.geometry.cell_of(i);
    if (label[i] != 0 || !costmap.is_passable(seed)) continue;
    label[i] = ++next_label;
    queue.push_back(seed);
    while (!queue.empty()) {
      const Cell cell = queue.front();
      queue.pop_front();
      // Where a diagonal move is open, so are the two straight ones round it.
      for (const Cell next : {Cell{cell.x + 1, cell.y}, Cell{cell.x - 1, cell.y},
                              Cell{cell.x, cell.y + 1}, Cell{cell.x, cell.y - 1}}) {
        if (!costmap.is_passable(next)) continue;
        int& l = label[costmap.geometry.index_of(next)];
        if (l != 0) continue;
        l = next_label;
        queue.push_back(next);
      }
    }
  }
  return label;
}

class Campaign {
 public:
  Campaign(const OccupancyGrid& grid, const CampaignOptions& options)
      : options_(options),
        grid_(grid),
        planner_(grid, robot_, options.inflation, options.planner),
        labels_(components(planner_.costmap())) {
    for (std::size_t i = 0; i < labels_.size(); ++i) {
      if (labels_[i] != 0) passable_.push_back(grid.geometry.cell_of(i));
    }
  }

  CampaignReport run() {
    std::vector<CampaignReport> reports(options_.queries);
    app::run_parallel(reports.size(), options_.threads,
                      [&](std::size_t i) { reports[i] = query(i); });
    CampaignReport sum;
    for (const CampaignReport& report : reports) sum.add(report);
    return sum;
  }

 private:
  CampaignReport query(std::size_t index) const {
    CampaignReport report;
    report.queries = 1;
    const PlanRequest request = random_request(index);
    const auto trouble = [&](std::size_t& count, const std::string& what) {
      ++count;
      report.troubles.push_back("query " + std::to_string(index) + ": " + what);
    };
    try {
      const PlanResult result = planner_.plan(request);
      const auto want = expected(request);
      if (want && *want != result.status) {
        trouble(report.wrong_verdicts, std::string(to_string(result.status)) + " instead of " +
                                           to_string(*want) + ": " + result.message);
      }
      if (result.status == PlanStatus::kOk) {
        judge_plan(request, result, report, trouble);
      } else {
        judge_refusal(result, report, trouble);
      }
    } catch (const std::exception& error) {
      trouble(report.exceptions, error.what());
    }
    return report;
  }

  PlanRequest random_request(std::size_t index) const {
    std::seed_seq seeds{options_.seed, std::uint64_t{index}};
    std::mt19937_64 random(seeds);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const bool anywhere = index % 4 == 3 || passable_.empty();
    const auto& g = grid_.geometry;
    const auto point = [&]() -> TPoint2D {
      if (anywhere) {
        const double across = 1.1 * unit(random) - 0.05, up = 1.1 * unit(random) - 0.05;
        return {g.origin.x + across * g.width * g.resolution_m,
                g.origin.y + up * g.height * g.resolution_m};
      }
      const TPoint2D center = g.center_of(passable_[random() % passable_.size()]);
      const double right = unit(random) - 0.5, up = unit(random) - 0.5;
      return {center.x + right * g.resolution_m, center.y + up * g.resolution_m};
    };
    const auto pose = [&]() -> TPose2D {
      const TPoint2D p = point();
      return {p.x, p.y, maps::kPi * (2.0 * unit(random) - 1.0)};
    };
    PlanRequest request;
    request.start = pose();
    request.goal = pose();
    request.start_heading_given = index % 2 == 0;
    request.goal_heading_given = index % 3 == 0;
    if (index % 10 == 0) request.via = {point(), point()};
    if (index % 20 == 0) request.via_order = planning::ViaOrder::kShortest;
    request.seed = index;
    return request;
  }

  /// What the answer must be, from the costmap alone; nullopt where an escape may or may not exist.
  std::optional<PlanStatus> expected(const PlanRequest& request) const {
    const auto& g = grid_.geometry;
    const TPoint2D start = maps::position_of(request.start);
    if (!g.contains(start)) return PlanStatus::kStartOutsideMap;
    const Cell from = g.cell_at(start);
    if (OccupancyGrid::is_occupied(grid_.at(from))) return PlanStatus::kStartOccupied;
    if (!planner_.costmap().is_passable(from)) return std::nullopt;
    std::vector<TPoint2D> targets = request.via;
    targets.push_back(maps::position_of(request.goal));
    bool connected = true;
    for (const TPoint2D& target : targets) {
      if (!g.contains(target)) return PlanStatus::kGoalOutsideMap;
      const Cell to = g.cell_at(target);
      if (!planner_.costmap().is_passable(to)) return PlanStatus::kGoalOccupied;
      connected = connected && labels_[g.index_of(from)] == labels_[g.index_of(to)];
    }
    return connected ? PlanStatus::kOk : PlanStatus::kNoPath;
  }

  template <typename Trouble>
  void judge_plan(const PlanRequest& request, const PlanResult& result, CampaignReport& report,
                  const Trouble& trouble) const {
    planning::CheckOptions options;
    options.limits = limits_of(robot_, options_.planner.timing);
    options.robot_radius_m = robot_.robot_radius_m;
    options.escape_allowed = result.escape;
    options.clearance_looked_m = robot_.robot_radius_m + 0.01;
    const planning::TrajectoryReport checked = check(result.trajectory, grid_, options);
    report.planned = 1;
    report.escapes = result.escape ? 1 : 0;
    report.samples = checked.samples;
    report.length_m = result.path_length_m;
    report.unsafe_samples = checked.unsafe_samples;
    for (const std::string& problem : checked.problems) trouble(report.bad_trajectories, problem);
    if (result.trajectory.points.empty()) return;
    const TPose2D& first = result.trajectory.points.front().pose;
    const TPose2D& last = result.trajectory.points.back().pose;
    const auto apart = [](const TPose2D& a, const TPose2D& b) {
      return maps::distance(maps::position_of(a), maps::position_of(b));
    };
    const auto turned = [](bool given, const TPose2D& a, const TPose2D& b) {
      return given ? std::abs(maps::wrap_angle(a.phi - b.phi)) : 0.0;
    };
    if (apart(first, request.start) > 1e-9 ||
        turned(request.start_heading_given, first, request.start) > 1e-9) {
      trouble(report.bad_trajectories, "does not begin at the start");
    }
    // A goal in a free cell may be moved to the cell's middle.
    if (apart(last, request.goal) > 0.75 * grid_.geometry.resolution_m ||
        turned(request.goal_heading_given, last, request.goal) > 2e-3) {
      trouble(report.bad_trajectories, "does not end at the goal");
    }
  }

  template <typename Trouble>
  void judge_refusal(const PlanResult& result, CampaignReport& report,
                     const Trouble& trouble) const {
    report.refused[to_string(result.status)] = 1;
    if (refusal_code(result.status) == 0 || result.message.empty() || !result.offending_point ||
        !result.trajectory.points.empty()) {
      trouble(report.bad_refusals, "a refusal without code, words or place");
    }
    if (const auto& near = result.nearest_reachable_goal) {
      if (!planner_.costmap().is_passable(grid_.geometry.cell_at(*near))) {
        trouble(report.bad_refusals, "the nearest reachable goal is not free");
      }
    }
  }

  CampaignOptions options_;
  const OccupancyGrid& grid_;
  maps::RobotModel robot_;
  planning::Planner planner_;
  std::vector<int> labels_;
  std::vector<Cell> passable_;
};

}  // namespace

void CampaignReport::add(const CampaignReport& other) {
  queries += other.queries;
  planned += other.planned;
  escapes += other.escapes;
  for (const auto& [status, count] : other.refused) refused[status] += count;
  samples += other.samples;
  length_m += other.length_m;
  unsafe_samples += other.unsafe_samples;
  bad_trajectories += other.bad_trajectories;
  bad_refusals += other.bad_refusals;
  wrong_verdicts += other.wrong_verdicts;
  exceptions += other.exceptions;
  troubles.insert(troubles.end(), other.troubles.begin(), other.troubles.end());
}

CampaignReport run_campaign(const OccupancyGrid& grid, const CampaignOptions& options) {
  return Campaign(grid, options).run();
}

OccupancyGrid random_world_grid(std::uint64_t seed) {
  return sim::true_grid(sim::World::random_office(seed), 0.05, 0.05, 0.50);
}

OccupancyGrid speckled(OccupancyGrid grid, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  for (auto& cell : grid.cells) {
    const std::uint64_t pick = random() % 10000;
    if (pick < 5) cell = OccupancyGrid::kOccupied;
    if (pick >= 5 && pick < 40) cell = OccupancyGrid::kUnknown;
  }
  return grid;
}

std::vector<std::pair<std::string, OccupancyGrid>> campaign_maps(std::size_t random_worlds) {
  std::vector<std::pair<std::string, OccupancyGrid>> out;
  const auto files = [](const char* folder, const char* extension) {
    std::vector<std::filesystem::path> found;
    std::error_code ignored;
    for (const auto& entry :
         std::filesystem::directory_iterator(test_data() / "maps" / folder, ignored)) {
      if (entry.path().extension() == extension) found.push_back(entry.path());
    }
    std::sort(found.begin(), found.end());
    return found;
  };
  for (const auto& file : files("movingai", ".map")) {
    out.emplace_back(file.stem().string(), maps::load_movingai_map(file));
  }
  std::vector<std::string> warnings;
  for (const auto& file : files("ros", ".yaml")) {
    out.emplace_back(file.stem().string(), maps::load_ros_map(file, warnings));
  }
  for (std::size_t seed = 1; seed <= random_worlds; ++seed) {
    const bool specks = seed % 2 == 0;
    OccupancyGrid grid = random_world_grid(seed);
    out.emplace_back("random:" + std::to_string(seed) + (specks ? " with specks" : ""),
                     specks ? speckled(std::move(grid), seed) : std::move(grid));
  }
  return out;
}

}  // namespace rovigo::test
