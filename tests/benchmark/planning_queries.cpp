// Long planning queries on maps people use; `./run bench planning` picks them by their names. Times
// are CPU time a query; `Time` counts all queries of one round.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "maps/movingai.h"
#include "maps/ros_map.h"
#include "planning/astar.h"
#include "planning/planner.h"

namespace {

using namespace rovigo;            // NOLINT
using namespace rovigo::planning;  // NOLINT

constexpr std::size_t kQueries = 100;

/// The grid of a data file; empty where the data is not here.
maps::OccupancyGrid load(const std::string& file) {
  const char* named = std::getenv("ROVIGO_TEST_DATA");
  const std::filesystem::path data =
      named ? named : std::filesystem::path(ROVIGO_SOURCE_DIR) / ".." / "shared" / "data";
  const auto path = data / "maps" / file;
  if (!std::filesystem::exists(path)) return {};
  std::vector<std::string> warnings;
  return path.extension() == ".map" ? maps::load_movingai_map(path)
                                    : maps::load_ros_map(path, warnings);
}

using CellPair = std::pair<maps::Cell, maps::Cell>;

/// From random starts to goals at least 0.6 times as far along the grid as the farthest reachable
/// cell, by a fixed seed.
std::vector<CellPair> long_queries(const SearchGrid& grid) {
  std::mt19937_64 random(2024);
  const auto& g = grid.geometry();
  std::vector<maps::Cell> passable;
  for (std::size_t i = 0; i < g.size(); ++i) {
    if (grid.is_passable(g.cell_of(i))) passable.push_back(g.cell_of(i));
  }
  std::vector<CellPair> out;
  const auto offsets = grid.offsets();
  while (out.size() < kQueries && !passable.empty()) {
    const maps::Cell start = passable[random() % passable.size()];
    // Steps of a flood stand in for the distance along the grid.
    std::vector<int> steps(grid.padded_size(), -1);
    std::vector<std::uint32_t> queue{grid.index_of(start)};
    steps[queue.front()] = 0;
    for (std::size_t i = 0; i < queue.size(); ++i) {
      for (std::size_t move = 0; move < 8; ++move) {
        if ((grid.moves()[queue[i]] >> move & 1U) == 0) continue;
        const auto next = static_cast<std::uint32_t>(static_cast<int>(queue[i]) + offsets[move]);
        if (steps[next] >= 0) continue;
        steps[next] = steps[queue[i]] + 1;
        queue.push_back(next);
      }
    }
    const int farthest = steps[queue.back()];
    if (queue.size() < passable.size() / 4) continue;  // a pocket
    for (int k = 0; k < 4 && out.size() < kQueries;) {
      const std::uint32_t goal = queue[random() % queue.size()];
      if (steps[goal] < 0.6 * farthest) continue;
      out.emplace_back(start, grid.cell_of(goal));
      ++k;
    }
  }
  return out;
}

void report(benchmark::State& state, std::vector<double>& milliseconds, std::size_t expanded) {
  if (milliseconds.empty()) return;
  std::sort(milliseconds.begin(), milliseconds.end());
  state.counters["median_ms"] = milliseconds[milliseconds.size() / 2];
  state.counters["worst_ms"] = milliseconds.back();
  state.counters["expanded"] =
      static_cast<double>(expanded) / static_cast<double>(milliseconds.size());
}

double cpu_ms() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

void search(benchmark::State& state, const SearchGrid& grid, const SearchWeights& weights) {
  const auto queries = long_queries(grid);
  GridSearch workspace;
  std::vector<double> times;
  std::size_t expanded = 0;
  for (auto _ : state) {
    for (const auto& [start, goal] : queries) {
      const double begin = cpu_ms();
      const auto result = workspace.find(grid, start, goal, weights);
      times.push_back(cpu_ms() - begin);
      expanded += result.expanded_cells;
      benchmark::DoNotOptimize(result.cost_m);
    }
  }
  report(state, times, expanded);
}

void point_query(benchmark::State& state, const char* file) {
  const auto grid = load(file);
  if (grid.cells.empty()) return state.SkipWithError("the map is not here");
  search(state, SearchGrid(grid, maps::MapMode::kKnownFree, 8), {});
}

void soft_query(benchmark::State& state, const char* file, double soft_cost) {
  const auto grid = load(file);
  if (grid.cells.empty()) return state.SkipWithError("the map is not here");
  search(state, SearchGrid(maps::inflate_safe(grid, {}), 8), {.soft_cost = soft_cost});
}

/// The whole way from two points to a timed trajectory; the map is inflated once before.
void whole_plan(benchmark::State& state, const char* file) {
  const auto grid = load(file);
  if (grid.cells.empty()) return state.SkipWithError("the map is not here");
  const Planner planner(grid, {}, {}, {});
  const auto queries = long_queries(SearchGrid(planner.costmap(), 8));
  std::vector<double> times;
  std::size_t expanded = 0;
  double driven = 0.0;
  double searched = 0.0;
  for (auto _ : state) {
    for (const auto& [start, goal] : queries) {
      const TPoint2D a = grid.geometry.center_of(start);
      const TPoint2D b = grid.geometry.center_of(goal);
      PlanRequest request;
      request.start = {a.x, a.y, 0.0};
      request.goal = {b.x, b.y, 0.0};
      const double begin = cpu_ms();
      const auto result = planner.plan(request);
      times.push_back(cpu_ms() - begin);
      expanded += result.expanded_cells;
      driven += result.path_length_m;
      searched += result.search_length_m;
    }
  }
  report(state, times, expanded);
  state.counters["driven_per_searched"] = searched > 0.0 ? driven / searched : 0.0;
}

void prepare(benchmark::State& state, const char* file) {
  const auto grid = load(file);
  if (grid.cells.empty()) return state.SkipWithError("the map is not here");
  for (auto _ : state) benchmark::DoNotOptimize(Planner(grid, {}, {}, {}));
}

constexpr const char* kWillow = "ros/willow-full-0.05.yaml";
constexpr const char* kBlocks = "ros/100by100_15.yaml";
constexpr const char* kParis = "movingai/Paris_1_1024.map";

BENCHMARK_CAPTURE(point_query, willow, kWillow)
    ->Name("Point/willow-full-0.05")
    ->Unit(benchmark::kMillisecond)
    ->Iterations(3);
BENCHMARK_CAPTURE(point_query, paris, kParis)
    ->Name("Point/Paris_1_1024")
    ->Unit(benchmark::kMillisecond)
    ->Iterations(3);
BENCHMARK_CAPTURE(point_query, blocks, kBlocks)
    ->Name("Point/100by100_15")
    ->Unit(benchmark::kMillisecond)
    ->Iterations(3);
BENCHMARK_CAPTURE(soft_query, zero, kWillow, 0.0)
    ->Name("AStar/willow-full-0.05/soft_cost_0")
    ->Unit(benchmark::kMillisecond)
    ->Iterations(3);
BENCHMARK_CAPTURE(soft_query, three, kWillow, 3.0)
    ->Name("AStar/willow-full-0.05/soft_cost_3")
    ->Unit(benchmark::kMillisecond)
    ->Iterations(3);
BENCHMARK_CAPTURE(whole_plan, willow, kWillow)
    ->Name("Plan/willow-full-0.05")
    ->Unit(benchmark::kMillisecond)
    ->Iterations(3);
BENCHMARK_CAPTURE(prepare, willow, kWillow)
    ->Name("Plan/prepare/willow-full-0.05")
    ->Unit(benchmark::kMillisecond);

}  // namespace
