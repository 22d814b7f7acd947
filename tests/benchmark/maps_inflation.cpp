// Inflation and distances at full-map size, on the maps people use where they are at hand, else on
// a made-up one.

#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>
#include <random>

#include "maps/distance_field.h"
#include "maps/inflation.h"
#include "maps/ros_map.h"

namespace rovigo::maps {
namespace {

/// Rooms of 4 m with doors, and scattered poles, at 0.05 m.
OccupancyGrid made_up(int side) {
  OccupancyGrid grid({0.05, {0.0, 0.0}, side, side}, OccupancyGrid::kFree);
  std::mt19937_64 rng(1);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const bool wall = (x % 80 == 0 && y % 80 > 20) || (y % 80 == 0 && x % 80 > 20);
      if (wall || rng() % 400 == 0) grid.at({x, y}) = OccupancyGrid::kOccupied;
    }
  }
  return grid;
}

OccupancyGrid grid_for(benchmark::State& state) {
  const char* data = std::getenv("ROVIGO_TEST_DATA");
  const std::filesystem::path folder =
      data ? data : std::filesystem::path(__FILE__).parent_path() / "../../../shared/data";
  const auto file = folder / "maps/ros/willow-full-0.05.yaml";
  std::vector<std::string> warnings;
  const bool real = std::filesystem::exists(file);
  state.SetLabel(real ? "willow-full-0.05" : "made-up 1000 x 1000");
  return real ? load_ros_map(file, warnings) : made_up(1000);
}

void inflate_safe_full_map(benchmark::State& state) {
  const OccupancyGrid grid = grid_for(state);
  for (auto _ : state) benchmark::DoNotOptimize(inflate_safe(grid, {}));
}
BENCHMARK(inflate_safe_full_map)->Unit(benchmark::kMillisecond);

void inflate_reference_full_map(benchmark::State& state) {
  const OccupancyGrid grid = grid_for(state);
  const auto sigma = static_cast<double>(state.range(0));
  for (auto _ : state) {
    benchmark::DoNotOptimize(inflate_reference(grid, sigma, MapMode::kKnownFree));
  }
}
BENCHMARK(inflate_reference_full_map)->DenseRange(1, 4)->Unit(benchmark::kMillisecond);

void distance_field_full_map(benchmark::State& state) {
  const OccupancyGrid grid = grid_for(state);
  for (auto _ : state) benchmark::DoNotOptimize(distance_to_occupied(grid));
}
BENCHMARK(distance_field_full_map)->Unit(benchmark::kMillisecond);

void clearance_at_random_points(benchmark::State& state) {
  const OccupancyGrid grid = grid_for(state);
  const DistanceField field = distance_to_occupied(grid);
  const GridGeometry& g = grid.geometry;
  std::mt19937_64 rng(1);
  std::uniform_real_distribution<double> x(0.0, g.width * g.resolution_m);
  std::uniform_real_distribution<double> y(0.0, g.height * g.resolution_m);
  for (auto _ : state) {
    const TPoint2D p{g.origin.x + x(rng), g.origin.y + y(rng)};
    benchmark::DoNotOptimize(clearance_at(grid, field, p, 2.0));
  }
}
BENCHMARK(clearance_at_random_points);

}  // namespace
}  // namespace rovigo::maps
