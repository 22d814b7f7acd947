// What one control step costs.
#include <benchmark/benchmark.h>

#include "control/tracker.h"
#include "tests/unit/control/plant.h"

namespace rovigo::control {
namespace {

/// A drive of a length in metres, poses 30 times a second, commands 100 times.
void tracker_step(benchmark::State& state) {
  const maps::RobotModel robot;
  const auto plan = testing::TrajectoryBuilder(robot, {})
                        .drive(static_cast<double>(state.range(0)),
                               [](double s) { return 1.2 * std::sin(2.0 * s); })
                        .get();
  constexpr double kStepS = 0.01;
  double now = 0.0;
  PoseInput pose;
  auto tracker = std::make_unique<TrajectoryTracker>(ControlConfig(), robot, plan);
  for (auto _ : state) {
    if (now > plan.duration_s()) {
      state.PauseTiming();
      tracker = std::make_unique<TrajectoryTracker>(ControlConfig(), robot, plan);
      now = 0.0;
      pose = {};
      state.ResumeTiming();
    }
    if (now - pose.time_s >= 1.0 / 30 || now == 0.0) {
      pose.time_s = now;
      pose.map_from_base = planning::sample(plan, now).pose;
      pose.quality = PoseQuality::kGood;
    }
    benchmark::DoNotOptimize(tracker->step(now, pose));
    now += kStepS;
  }
}
BENCHMARK(tracker_step)->Arg(5)->Arg(100)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace rovigo::control
