// The table of issue 4: planning against Boost.Graph's A*, interleaved on the same long queries,
// and every other figure that was asked for. CPU times; `./run bench planning`.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "boost_astar.h"
#include "maps/inflation.h"
#include "planning/any_angle_search.h"
#include "planning/astar.h"
#include "planning/jump_point_search.h"
#include "planning/planner.h"
#include "race.h"

namespace rovigo::benchmarks {

namespace {

using namespace planning;  // NOLINT

constexpr std::size_t kQueries = 100;
const double kSoftCost = AStarConfig{}.soft_cost_weight;  // what users get

struct Map {
  std::string name;
  const char* file;
  double asked_astar;  ///< times faster than Boost.Graph
  double asked_jumps;
};

const std::vector<Map> kMaps{{"willow-full 0.05 m", kWillow, 6, 30},
                             {"Paris_1_1024", kParis, 8, 250},
                             {"100by100_15", kBlocks, 80, 1000}};

/// Nothing, and a line that says so, where the data is not here.
std::optional<maps::OccupancyGrid> grid_of(const Map& map) {
  maps::OccupancyGrid grid = load_map(map.file);
  if (!grid.cells.empty()) return grid;
  std::printf("| %s | the map is not here |\n", map.name.c_str());
  return std::nullopt;
}

/// A GridSearch by weights, its length in cells.
std::function<double(const CellPair&)> answered_by(GridSearch& search, const SearchGrid& grid,
                                                   SearchWeights weights, bool by_cost = false) {
  return [&search, &grid, weights, by_cost](const CellPair& q) {
    const auto found = search.find(grid, q.first, q.second, weights);
    return (by_cost ? found.cost_m : found.length_m) / grid.geometry().resolution_m;
  };
}

std::function<double(const CellPair&)> answered_by(AnyAngleSearch& search, const SearchGrid& grid) {
  return [&](const CellPair& q) {
    return search.find(grid, q.first, q.second).length_m / grid.geometry().resolution_m;
  };
}

void print_memory(const Map& map, const char* what, std::size_t bytes,
                  const maps::OccupancyGrid& grid) {
  print_figure(map.name, std::string("memory of ") + what + ", bytes a cell",
               static_cast<double>(bytes) / static_cast<double>(grid.geometry.size()), 12);
}

/// The raw grid, against Boost.Graph.
void raw_searches(const Map& map, const maps::OccupancyGrid& grid) {
  const SearchGrid raw(grid, maps::MapMode::kKnownFree, 8);
  BoostAStar boost(raw);
  GridSearch astar;
  JumpPointSearch jumps(raw);
  AnyAngleSearch any_angle;
  std::vector<Method> methods;
  methods.push_back({.name = "Boost.Graph A*",
                     .answer = [&](const CellPair& q) { return boost.find(q.first, q.second); }});
  methods.push_back({.name = "A*, soft costs at zero",
                     .asked_ratio = map.asked_astar,
                     .answer = answered_by(astar, raw, {.soft_cost = kSoftCost})});
  methods.push_back({.name = "jump point search",
                     .asked_ratio = map.asked_jumps,
                     .answer = [&](const CellPair& q) {
                       return jumps.find(q.first, q.second).length_m / raw.geometry().resolution_m;
                     }});
  methods.push_back({.name = "weighted A* 1.5",
                     .exact = false,
                     .answer = answered_by(astar, raw, {.heuristic = 1.5})});
  methods.push_back({.name = "Theta*", .exact = false, .answer = answered_by(any_angle, raw)});
  race(methods, long_queries(raw, kQueries));
  print(map.name, methods);
  print_memory(map, "A*", astar.memory_bytes(), grid);
  print_memory(map, "jump point search", jumps.memory_bytes(), grid);
  print_memory(map, "Theta*", any_angle.memory_bytes(), grid);
}

/// The map as the rover sees it: soft costs or none; `length` is the cost here.
void inflated_searches(const Map& map, const maps::OccupancyGrid& grid) {
  const SearchGrid inflated(maps::inflate_safe(grid, {}), 8);
  GridSearch astar;
  AnyAngleSearch any_angle;
  std::vector<Method> plain, soft;
  plain.push_back(
      {.name = "inflated: A*, soft cost 0", .answer = answered_by(astar, inflated, {})});
  plain.push_back(
      {.name = "inflated: Theta*", .exact = false, .answer = answered_by(any_angle, inflated)});
  soft.push_back({.name = "inflated: A*, soft costs",
                  .answer = answered_by(astar, inflated, {.soft_cost = kSoftCost}, true)});
  soft.push_back(
      {.name = "inflated: weighted 1.5, soft",
       .exact = false,
       .answer = answered_by(astar, inflated, {.soft_cost = kSoftCost, .heuristic = 1.5}, true)});
  const auto queries = long_queries(inflated, kQueries);
  if (queries.empty()) return;
  race(plain, queries);
  print(map.name, plain);
  race(soft, queries);
  print(map.name, soft);
  print_figure(
      map.name, "worst cost of weighted A* 1.5 over the best",
      [&] {
        double worst = 1.0;
        for (std::size_t i = 0; i < queries.size(); ++i) {
          worst = std::max(worst, soft[1].lengths[i] / soft[0].lengths[i]);
        }
        return worst;
      }(),
      1.5);
}

void large_map(const maps::OccupancyGrid& grid) {
  const maps::OccupancyGrid large = tiled(grid, 4096);
  const SearchGrid raw(large, maps::MapMode::kKnownFree, 8);
  GridSearch astar;
  JumpPointSearch jumps(raw);
  std::vector<Method> methods;
  methods.push_back(
      {.name = "A*, soft costs at zero", .asked_ms = 125, .answer = answered_by(astar, raw, {})});
  methods.push_back(
      {.name = "jump point search", .asked_ms = 125, .answer = [&](const CellPair& q) {
         return jumps.find(q.first, q.second).length_m / raw.geometry().resolution_m;
       }});
  race(methods, long_queries(raw, kQueries / 4));
  print("Paris, 4096 x 4096", methods);
}

void cost_to_go(const Map& map, const maps::OccupancyGrid& grid) {
  const auto figure = [&](const std::string& what, const SearchGrid& cells, double soft_cost) {
    const std::vector<maps::Cell> passable = passable_cells(cells);
    const auto queries = long_queries(cells, 1);
    if (queries.empty()) return;
    CostToGo to_go;
    const double ms =
        fastest_ms(5, [&] { to_go.compute(cells, {queries.front().first}, soft_cost); });
    const auto reached = std::count_if(passable.begin(), passable.end(), [&](maps::Cell cell) {
      return std::isfinite(to_go.cost_m(cell));
    });
    print_figure(map.name, "cost-to-go, " + what + ", ns a free cell",
                 1e6 * ms / static_cast<double>(reached), 25);
    print_memory(map, ("cost-to-go, " + what).c_str(), to_go.memory_bytes(), grid);
  };
  figure("raw grid", SearchGrid(grid, maps::MapMode::kKnownFree, 8), 0.0);
  figure("soft costs", SearchGrid(maps::inflate_safe(grid, {}), 8), kSoftCost);
}

void inflation(const Map& map, maps::OccupancyGrid grid) {
  const maps::InflationConfig config;
  constexpr double kSigma = 2.0;
  maps::Costmap safe, reference;
  print_figure(map.name, "safe inflation, ms",
               fastest_ms(5, [&] { safe = maps::inflate_safe(grid, config); }), 0);
  print_figure(
      map.name, "reference inflation, sigma 2, ms",
      fastest_ms(5, [&] { reference = maps::inflate_reference(grid, kSigma, config.map_mode); }),
      0);
  // One square metre, or what that is in cells of 0.05 m, turns into an obstacle.
  const int x = grid.geometry.width / 2, y = grid.geometry.height / 2;
  const maps::CellRect changed{{x, y}, {x + 20, y + 20}};
  for (int row = changed.lower.y; row < changed.upper.y; ++row) {
    for (int column = changed.lower.x; column < changed.upper.x; ++column) {
      grid.at({column, row}) = maps::OccupancyGrid::kOccupied;
    }
  }
  print_figure(map.name, "safe inflation of 20 x 20 changed cells, ms",
               fastest_ms(20, [&] { maps::update_safe(grid, changed, config, safe); }), 0);
  print_figure(
      map.name, "reference inflation of 20 x 20 changed cells, ms",
      fastest_ms(
          20, [&] { maps::update_reference(grid, changed, kSigma, config.map_mode, reference); }),
      0);
}

/// From two points to a timed trajectory; the map is inflated once before.
void whole_plans(const Map& map, const maps::OccupancyGrid& grid, double soft_cost_weight) {
  PlannerConfig config;
  config.astar.soft_cost_weight = soft_cost_weight;
  const Planner planner(grid, {}, {}, config);
  const SearchGrid cells(planner.costmap(), 8);
  GridSearch search;
  std::vector<double> times, ratios;
  int refused = 0;
  for (const auto& [from, to] : long_queries(cells, kQueries)) {
    const TPoint2D a = grid.geometry.center_of(from), b = grid.geometry.center_of(to);
    PlanRequest request;
    request.start = {a.x, a.y, 0.0};
    request.goal = {b.x, b.y, 0.0};
    const double begin = cpu_ms();
    const auto result = planner.plan(request);
    times.push_back(cpu_ms() - begin);
    if (result.status != PlanStatus::kOk) {
      ++refused;
      continue;
    }
    ratios.push_back(result.path_length_m / search.find(cells, from, to, {}).length_m);
  }
  const std::string with = soft_cost_weight > 0.0 ? ", default settings" : ", soft costs at zero";
  print_figure(map.name, "whole plan" + with + ", median ms", median(times), 10);
  print_figure(map.name, "driven length over the 8-connected optimum" + with, median(ratios),
               0.965);
  print_figure(map.name, "long queries refused" + with, refused, 0);
}

}  // namespace

}  // namespace rovigo::benchmarks

/// `planning_table [WORD...]`: maps whose name holds one of the words; all without.
int main(int argc, char** argv) {
  using namespace rovigo::benchmarks;  // NOLINT
  print_head();
  for (const Map& map : kMaps) {
    const auto names_it = [&](const char* word) {
      return map.name.find(word) != std::string::npos;
    };
    if (argc > 1 && std::none_of(argv + 1, argv + argc, names_it)) continue;
    const auto grid = grid_of(map);
    if (!grid) continue;
    raw_searches(map, *grid);
    cost_to_go(map, *grid);
    if (map.file == kParis) {
      large_map(*grid);
    } else {
      inflated_searches(map, *grid);
      inflation(map, *grid);
    }
    if (map.file != kWillow) continue;
    for (const double soft_cost_weight : {kSoftCost, 0.0})
      whole_plans(map, *grid, soft_cost_weight);
  }
}
