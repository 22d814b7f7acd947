// The simulator as a whole: its clock, and that it repeats itself bit for bit.

#include "sim/simulator.h"

#include <gtest/gtest.h>

#include <cstring>

#include "test_worlds.h"

namespace rovigo::sim {
namespace {

TEST(Simulator, TimeStartsAtOneSecondAndGrowsByOneStep) {
  Simulator simulator(World(bare_floor()), blind_options());
  EXPECT_DOUBLE_EQ(simulator.time_s(), 1.0);
  simulator.step({});
  EXPECT_DOUBLE_EQ(simulator.time_s(), 1.0 + Simulator::kStepS);
}

TEST(Simulator, CameraFramesComeAtTheirRateOnExactSteps) {
  SimulatorOptions options;
  options.camera_rate_hz = 15.0;
  Simulator simulator(World(bare_floor()), options);
  drive(simulator, {}, 1.0);
  const auto frames = only<mrpt::obs::CObservation3DRangeScan>(simulator.take_observations());
  ASSERT_EQ(frames.size(), 16U);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_NEAR(mrpt::Clock::toDouble(frames[i]->timestamp), 1.0 + static_cast<double>(i) / 15.0,
                1e-6);
  }
}

TEST(Simulator, TheOpticalFrameLooksAheadWithXToTheRight) {
  Simulator simulator(World(bare_floor()), blind_options());
  const auto& base_from_camera = simulator.rig().base_from_camera;
  const auto ahead = base_from_camera.composePoint(mrpt::math::TPoint3D(0, 0, 1));
  EXPECT_NEAR(ahead.x, 1.12, 1e-9);
  EXPECT_NEAR(ahead.y, 0.0, 1e-9);
  EXPECT_NEAR(ahead.z, 0.25, 1e-9);
  const auto right = base_from_camera.composePoint(mrpt::math::TPoint3D(1, 0, 0));
  EXPECT_NEAR(right.y, -1.0, 1e-9);
}

/// A varied drive in a world with things to bump into; the trace of true poses and the readings.
std::vector<double> trace_of(const SimulatorOptions& options) {
  WorldModel model = wall_ahead(2.5);
  model.solids.push_back(box_at(0.8, 1.2, 0.0, {0.5, 0.5, 0.5}));
  Simulator simulator((World(model)), options);
  std::vector<double> trace;
  for (int i = 0; i < 240 * 8; ++i) {
    const double t = i * Simulator::kStepS;
    simulator.step({0.35, 0.0, t < 3 ? 0.4 : t < 5 ? -0.7 : 0.05});
    const auto& p = simulator.truth().world_from_base;
    for (const double v :
         {p.x(), p.y(), p.z(), p.yaw(), p.pitch(), p.roll(), simulator.truth().twist.vx,
          simulator.truth().twist.omega, double(simulator.truth().contact_events)}) {
      trace.push_back(v);
    }
  }
  for (const auto& o : only<mrpt::obs::CObservationIMU>(simulator.take_observations())) {
    trace.insert(trace.end(), o->rawMeasurements.begin(), o->rawMeasurements.end());
  }
  return trace;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

TEST(Simulator, RepeatsItselfBitForBitInOneProcess) {
  SimulatorOptions options = blind_options(Scenario{});
  options.seed = 42;
  const auto first = trace_of(options);
  const auto second = trace_of(options);
  EXPECT_TRUE(same_bits(first, second));
  options.seed = 43;
  EXPECT_FALSE(same_bits(first, trace_of(options))) << "another seed is another run";
}

TEST(Simulator, TheCameraDoesNotDisturbThePhysics) {
  SimulatorOptions options = blind_options(Scenario{});
  const auto blind = trace_of(options);
  options.camera_enabled = true;
  options.camera_rate_hz = 2.0;
  EXPECT_TRUE(same_bits(blind, trace_of(options)));
}

TEST(Simulator, ObservationsAreTheSameHoweverOftenTheyAreTaken) {
  SimulatorOptions options;
  options.camera_rate_hz = 10.0;
  const World world(wall_ahead(2.0));
  Simulator often(world, options);
  Simulator once(world, options);
  std::vector<mrpt::obs::CObservation::Ptr> a;
  for (int i = 0; i < 120; ++i) {
    often.step({0.3, 0.0, 0.2});
    once.step({0.3, 0.0, 0.2});
    for (auto& o : often.take_observations()) a.push_back(o);
  }
  const auto b = once.take_observations();
  ASSERT_EQ(a.size(), b.size());
  const auto frames_a = only<mrpt::obs::CObservation3DRangeScan>(a);
  const auto frames_b = only<mrpt::obs::CObservation3DRangeScan>(b);
  ASSERT_EQ(frames_a.size(), frames_b.size());
  for (std::size_t i = 0; i < frames_a.size(); ++i) {
    EXPECT_EQ(frames_a[i]->rangeImage, frames_b[i]->rangeImage);
  }
}

}  // namespace
}  // namespace rovigo::sim
