// The table of issue 4: planning against Boost.Graph's A*, interleaved on the same long queries.

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include "boost_astar.h"
#include "long_queries.h"
#include "maps/inflation.h"
#include "planning/astar.h"
#include "planning/jump_point_search.h"
#include "planning/planner.h"

namespace rovigo::benchmarks {

namespace {

using namespace planning;  // NOLINT

constexpr std::size_t kQueries = 100;
constexpr int kRounds = 3;

double cpu_ms() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0.0 : values[values.size() / 2];
}

/// One way to answer a query; its length in cells, to see that all agree.
struct Method {
  std::string name;
  double asked_ratio = 0.0;  ///< times faster than the first method; 0: no figure asked
  std::function<double(const CellPair&)> answer;
  std::vector<double> times_ms = {};
};

/// The methods take turns, round by round, so that the machine's moods hit all alike.
void race(std::vector<Method>& methods, const std::vector<CellPair>& queries) {
  std::vector<double> lengths(queries.size());
  for (int round = 0; round < kRounds; ++round) {
    for (Method& m : methods) {
      for (std::size_t i = 0; i < queries.size(); ++i) {
        const double begin = cpu_ms();
        const double length = m.answer(queries[i]);
        m.times_ms.push_back(cpu_ms() - begin);
        if (&m == &methods.front()) lengths[i] = length;
        if (m.asked_ratio > 0.0 && std::abs(length - lengths[i]) > 1e-3 * length) {
          std::printf("  %s disagrees: %.4f, not %.4f cells\n", m.name.c_str(), length, lengths[i]);
        }
      }
    }
  }
}

void print(const std::string& map, const std::vector<Method>& methods) {
  const double yardstick = median(methods.front().times_ms);
  for (const Method& m : methods) {
    const double ms = median(m.times_ms);
    char asked[40] = "-";
    if (m.asked_ratio > 0.0) {
      std::snprintf(asked, sizeof asked, "%.0f%s", m.asked_ratio,
                    yardstick / ms >= m.asked_ratio ? "" : " MISSED");
    }
    std::printf("| %-20s | %-28s | %9.4f | %8.1f | %s |\n", map.c_str(), m.name.c_str(), ms,
                yardstick / ms, asked);
  }
  std::fflush(stdout);
}

void searches(const char* file, const std::string& name, double asked_astar, double asked_jumps) {
  const maps::OccupancyGrid grid = load_map(file);
  if (grid.cells.empty()) {
    std::printf("| %s | the map is not here |\n", name.c_str());
    return;
  }
  const SearchGrid raw(grid, maps::MapMode::kKnownFree, 8);
  const double cell = grid.geometry.resolution_m;
  BoostAStar boost(raw);
  GridSearch astar;
  JumpPointSearch jumps(raw);
  std::vector<Method> methods;
  methods.push_back(
      {"Boost.Graph A*", 0.0, [&](const CellPair& q) { return boost.find(q.first, q.second); }});
  methods.push_back({"A*, soft costs at zero", asked_astar, [&](const CellPair& q) {
                       return astar.find(raw, q.first, q.second, {.soft_cost = 3.0}).length_m /
                              cell;
                     }});
  methods.push_back({"jump point search", asked_jumps, [&](const CellPair& q) {
                       return jumps.find(q.first, q.second).length_m / cell;
                     }});
  race(methods, long_queries(raw, kQueries));
  print(name, methods);
  std::printf(
      "  memory of jump point search: %.2f bytes a cell\n",
      static_cast<double>(jumps.memory_bytes()) / static_cast<double>(grid.geometry.size()));
}

}  // namespace

}  // namespace rovigo::benchmarks

int main() {
  using namespace rovigo::benchmarks;  // NOLINT
  std::printf(
      "| map                  | search                       |  CPU ms   | times    | asked |\n");
  std::printf("|---|---|---|---|---|\n");
  searches(kWillow, "willow-full 0.05 m", 6, 30);
  searches(kParis, "Paris_1_1024", 8, 250);
  searches(kBlocks, "100by100_15", 80, 1000);
}
