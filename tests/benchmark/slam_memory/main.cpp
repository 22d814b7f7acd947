// How memory and CPU per frame develop while a recording is mapped, and how long the first pose
// takes.

#include <cstdio>
#include <exception>
#include <vector>

#include "tests/support/slam_run.h"

namespace rovigo::test {

namespace {

double cpu_ms_per_frame(const SlamRun::Sample& from, const SlamRun::Sample& to) {
  return 1e3 * (to.cpu_s - from.cpu_s) / (to.frames - from.frames);
}

void print_curve(const std::vector<SlamRun::Sample>& samples) {
  std::printf("%8s %10s %12s %13s\n", "frames", "keyframes", "resident MB", "CPU ms/frame");
  SlamRun::Sample before;
  for (const SlamRun::Sample& s : samples) {
    std::printf("%8d %10d %12.1f %13.1f\n", s.frames, s.keyframes, s.resident_mb,
                cpu_ms_per_frame(before, s));
    before = s;
  }
}

/// Flat: what the last quarter takes against the second.
void print_quarters(const std::vector<SlamRun::Sample>& samples) {
  if (samples.size() < 4) return;
  const auto at = [&](std::size_t quarter) { return samples[quarter * (samples.size() - 1) / 4]; };
  std::printf("second quarter: %.1f MB, %.1f ms; last quarter: %.1f MB, %.1f ms\n",
              at(2).resident_mb, cpu_ms_per_frame(at(1), at(2)), at(4).resident_mb,
              cpu_ms_per_frame(at(3), at(4)));
}

}  // namespace

}  // namespace rovigo::test

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: slam_memory RECORDING\n");
    return 2;
  }
  try {
    const auto run = rovigo::test::run_slam(argv[1]);
    rovigo::test::print_curve(run.samples);
    rovigo::test::print_quarters(run.samples);
    std::printf(
        "first pose after %.1f ms; with the final adjustment %.1f ms CPU/frame, %.0f MB at "
        "most\n",
        run.first_pose_ms, run.cpu_ms_per_frame, run.peak_mb);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "slam_memory: %s\n", e.what());
    return 2;
  }
  return 0;
}
