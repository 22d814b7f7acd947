// The reference spline through a thousand cells of a winding way.

#include <benchmark/benchmark.h>

#include <cmath>

#include "planning/reference_spline.h"

namespace rovigo::planning {
namespace {

void BM_ReferenceSpline(benchmark::State& state) {
  std::vector<TPoint2D> points;
  for (int i = 0; i < 1000; ++i) {
    const double a = 0.02 * i;
    points.push_back(
        {std::round(20.0 * std::sin(a) + 2.0 * i), std::round(50.0 * std::cos(2.0 * a))});
  }
  const auto s = static_cast<double>(state.range(0));
  std::size_t knots = 0;
  for (auto _ : state) {
    const ReferenceSpline spline = reference_spline(points, s);
    knots = spline.curve.knots().size();
    benchmark::DoNotOptimize(spline.residual);
  }
  state.counters["knots"] = static_cast<double>(knots);
}
BENCHMARK(BM_ReferenceSpline)
    ->ArgName("smoothing")
    ->Arg(0)
    ->Arg(2)
    ->Arg(4)
    ->Arg(6)
    ->Arg(955)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace rovigo::planning
