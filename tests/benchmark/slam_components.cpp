// What a camera frame costs, part by part (640x480). CPU times; the sum has to stay far below 24
// ms.

#include <benchmark/benchmark.h>

#include <opencv2/imgproc.hpp>
#include <random>

#include "slam/depth_scan.h"
#include "slam/features.h"
#include "slam/pose_optimizer.h"
#include "slam/ray_voter.h"
#include "tests/support/pinhole.h"

namespace rovigo::slam {
namespace {

CameraModel camera() { return CameraModel(test::pinhole()); }

Se3 forward_camera() { return test::looking_ahead(0.25, 0.1); }

/// Blocks of random brightness with sensor noise: corners everywhere.
CameraFrame busy_frame() {
  std::mt19937_64 random(1);
  cv::Mat blocks(30, 40, CV_8UC1);
  for (int i = 0; i < 30 * 40; ++i) blocks.data[i] = static_cast<std::uint8_t>(random() % 256);
  CameraFrame frame;
  cv::resize(blocks, frame.gray, {640, 480}, 0, 0, cv::INTER_NEAREST);
  for (int i = 0; i < 640 * 480; ++i) {
    frame.gray.data[i] =
        cv::saturate_cast<std::uint8_t>(frame.gray.data[i] + int(random() % 11) - 5);
  }
  frame.depth = cv::Mat(480, 640, CV_16UC1, cv::Scalar(2500));
  return frame;
}

void ExtractFeatures(benchmark::State& state) {
  const CameraModel model = camera();
  const CameraFrame frame = busy_frame();
  for (auto _ : state) {
    benchmark::DoNotOptimize(extract_features(frame, model, FeatureConfig{}, DepthConfig{}));
  }
}
BENCHMARK(ExtractFeatures)->Unit(benchmark::kMillisecond);

void OptimizePose(benchmark::State& state) {
  const CameraModel model = camera();
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  std::vector<PointObservation> observations;
  for (int i = 0; i < state.range(0); ++i) {
    PointObservation o;
    o.pixel = {640 * u(random), 480 * u(random)};
    o.depth_m = 1.0 + 3.0 * u(random);
    o.depth_sigma_m = 0.01;
    o.point_map = forward_camera() * model.unproject(o.pixel, o.depth_m);
    if (i % 5 == 0) o.pixel.x() += 25.0;
    observations.push_back(o);
  }
  const Se3 start = from_planar({0.02, -0.02, 0.01});
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        optimize_pose(observations, start, std::nullopt, model, forward_camera()));
  }
}
BENCHMARK(OptimizePose)->Arg(200)->Arg(600)->Unit(benchmark::kMillisecond);

void MatchThousandAgainstThousand(benchmark::State& state) {
  std::mt19937_64 random(3);
  std::vector<Descriptor> all(1000);
  for (Descriptor& d : all) d = {random(), random(), random(), random()};
  for (auto _ : state) {
    for (const Descriptor& d : all) {
      benchmark::DoNotOptimize(nearest_two(d, all.data(), all.size()));
    }
  }
}
BENCHMARK(MatchThousandAgainstThousand)->Unit(benchmark::kMillisecond);

void GridEvidenceOfAFrame(benchmark::State& state) {
  const CameraModel model = camera();
  DepthScanner scanner(model, DepthConfig{});
  RayVoter voter(GridConfig{}, DepthConfig{});
  EvidencePatch patch;
  const CameraFrame frame = busy_frame();
  for (auto _ : state) {
    voter.vote(scanner.scan(frame.depth, 0.001, forward_camera()), {0, 0, 0}, patch);
  }
}
BENCHMARK(GridEvidenceOfAFrame)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace rovigo::slam
