// Any small grid and any query: planning neither crashes nor hands out an unsound trajectory.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "planning/check.h"
#include "planning/planner.h"

namespace {

/// Takes values off the input until it is used up; then zeros.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}
  std::uint8_t byte() {
    if (left_ == 0) return 0;
    --left_;
    return *data_++;
  }
  double real() {
    double value = 0.0;
    if (left_ < sizeof value) return byte() * 0.03;
    std::memcpy(&value, data_, sizeof value);
    data_ += sizeof value;
    left_ -= sizeof value;
    return value;
  }
  /// Mostly inside a few metres, sometimes anything.
  double coordinate() { return byte() % 8 == 0 ? real() : byte() * 0.02 - 0.5; }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rovigo;  // NOLINT
  Bytes in(data, size);
  maps::GridGeometry g;
  g.width = in.byte() % 48;
  g.height = in.byte() % 48;
  g.resolution_m = 0.05 + 0.05 * (in.byte() % 3);
  maps::RobotModel robot;
  robot.robot_radius_m = 0.05 * (in.byte() % 8);
  maps::InflationConfig inflation;
  inflation.robot_radius_m = robot.robot_radius_m;
  inflation.map_mode = static_cast<maps::MapMode>(in.byte() % 3);
  planning::PlannerConfig config;
  config.astar.connectivity = in.byte() % 2 == 0 ? 8 : 4;
  planning::PlanRequest request;
  request.start = {in.coordinate(), in.coordinate(), in.coordinate()};
  request.goal = {in.coordinate(), in.coordinate(), in.coordinate()};
  request.start_heading_given = in.byte() % 2 == 0;
  request.goal_heading_given = in.byte() % 2 == 0;
  if (in.byte() % 4 == 0) request.via.push_back({in.coordinate(), in.coordinate()});
  maps::OccupancyGrid grid(g, maps::OccupancyGrid::kFree);
  for (auto& cell : grid.cells) {
    const std::uint8_t value = in.byte();
    cell = value < 8     ? maps::OccupancyGrid::kUnknown
           : value > 235 ? maps::OccupancyGrid::kOccupied
                         : maps::OccupancyGrid::kFree;
  }
  const planning::Planner planner(grid, robot, inflation, config);
  const planning::PlanResult result = planner.plan(request);
  if (result.status != planning::PlanStatus::kOk) return 0;
  if (inflation.map_mode == maps::MapMode::kEverything) return 0;  // obstacles do not count
  planning::CheckOptions options;
  options.robot_radius_m = robot.robot_radius_m;
  options.limits = limits_of(robot, config.timing);
  options.escape_allowed = result.escape;
  options.unknown_is_blocked = inflation.map_mode == maps::MapMode::kKnownFree;
  const auto report = check(result.trajectory, grid, options);
  for (const auto& problem : report.problems) std::fprintf(stderr, "%s\n", problem.c_str());
  if (!report.problems.empty()) std::abort();
  return 0;
}
