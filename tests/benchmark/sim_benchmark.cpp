// How long a camera frame takes, and how much faster than real time the physics runs.

#include <benchmark/benchmark.h>

#include "sim/simulator.h"

namespace rovigo::sim {
namespace {

World lab() { return World::load(ROVIGO_SOURCE_DIR "/sim/worlds/lab.sdf"); }

/// One frame of the RGB-D camera, rendering and noise, while the rover turns in the corridor.
void sim_camera_frame(benchmark::State& state) {
  const World world = lab();
  SimulatorOptions options;
  options.world_from_base = world.start();
  Simulator simulator(world, options);
  simulator.take_observations();
  for (auto _ : state) {
    state.PauseTiming();
    for (int i = 0; i < 8; ++i) simulator.step({0.1, 0.0, 0.6});
    state.ResumeTiming();
    benchmark::DoNotOptimize(simulator.take_observations());
  }
}
BENCHMARK(sim_camera_frame)->Unit(benchmark::kMillisecond);

/// A second of physics, IMU and encoders without the camera.
void sim_physics_second(benchmark::State& state) {
  const World world = lab();
  SimulatorOptions options;
  options.world_from_base = world.start();
  options.camera_enabled = false;
  Simulator simulator(world, options);
  for (auto _ : state) {
    for (int i = 0; i < 240; ++i) simulator.step({0.15, 0.0, 0.6});
    benchmark::DoNotOptimize(simulator.take_observations());
  }
  state.counters["times_real_time"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(sim_physics_second)->Unit(benchmark::kMillisecond);

void sim_load_lab(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(lab());
}
BENCHMARK(sim_load_lab)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace rovigo::sim
