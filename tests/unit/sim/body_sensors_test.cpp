// Gyro, accelerometer and encoders against the figures of the scenario.

#include "sim/body_sensors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "test_worlds.h"

namespace rovigo::sim {
namespace {

using mrpt::obs::CObservationIMU;
using mrpt::obs::CObservationOdometry;

double mean_of(const std::vector<CObservationIMU::Ptr>& samples, mrpt::obs::TIMUDataIndex what) {
  double sum = 0.0;
  for (const auto& s : samples) sum += s->get(what);
  return sum / static_cast<double>(samples.size());
}

double sigma_of(const std::vector<CObservationIMU::Ptr>& samples, mrpt::obs::TIMUDataIndex what) {
  const double mean = mean_of(samples, what);
  double sum = 0.0;
  for (const auto& s : samples) sum += std::pow(s->get(what) - mean, 2);
  return std::sqrt(sum / static_cast<double>(samples.size() - 1));
}

std::vector<CObservationIMU::Ptr> imu_at_rest(const Scenario& scenario, std::uint64_t seed,
                                              double seconds) {
  SimulatorOptions options = blind_options(scenario);
  options.seed = seed;
  Simulator simulator(World(bare_floor()), options);
  drive(simulator, {}, seconds);
  return only<CObservationIMU>(simulator.take_observations());
}

TEST(Imu, AtRestAPerfectOneReadsGravityUpAndNoTurn) {
  const auto samples = imu_at_rest(ideal_scenario(), 1, 2.0);
  EXPECT_NEAR(mean_of(samples, mrpt::obs::IMU_Z_ACC), 9.81, 0.005);
  EXPECT_NEAR(mean_of(samples, mrpt::obs::IMU_X_ACC), 0.0, 0.01);
  EXPECT_NEAR(mean_of(samples, mrpt::obs::IMU_Y_ACC), 0.0, 0.01);
  EXPECT_NEAR(mean_of(samples, mrpt::obs::IMU_WZ), 0.0, 1e-4);
}

TEST(Imu, NoiseAndBiasesKeepToTheirFigures) {
  const ImuNoise figures;
  std::set<double> biases;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const auto samples = imu_at_rest(Scenario{}, seed, 10.0);
    const double gyro_bias = mean_of(samples, mrpt::obs::IMU_WZ);
    EXPECT_LE(std::abs(gyro_bias), figures.gyro_bias_max_rad_s + 0.001);
    biases.insert(gyro_bias);
    EXPECT_NEAR(sigma_of(samples, mrpt::obs::IMU_WZ), figures.gyro_sigma_rad_s,
                0.1 * figures.gyro_sigma_rad_s);
    EXPECT_NEAR(sigma_of(samples, mrpt::obs::IMU_Z_ACC), figures.accelerometer_sigma_m_s2,
                0.15 * figures.accelerometer_sigma_m_s2);
    EXPECT_LE(std::abs(mean_of(samples, mrpt::obs::IMU_Z_ACC) - 9.81),
              figures.accelerometer_bias_max_m_s2 + 0.005);
  }
  EXPECT_EQ(biases.size(), 6U) << "the bias is drawn by seed";
}

TEST(Imu, ReadsTheTurnRateAndTheCentripetalAcceleration) {
  Simulator simulator(World(bare_floor()), blind_options());
  drive(simulator, {0.4, 0.0, 0.8}, 2.0);
  simulator.take_observations();
  drive(simulator, {0.4, 0.0, 0.8}, 3.0);
  const auto samples = only<CObservationIMU>(simulator.take_observations());
  EXPECT_NEAR(mean_of(samples, mrpt::obs::IMU_WZ), 0.8, 0.01);
  EXPECT_NEAR(mean_of(samples, mrpt::obs::IMU_Y_ACC), 0.4 * 0.8, 0.02);
  EXPECT_NEAR(mean_of(samples, mrpt::obs::IMU_X_ACC), 0.0, 0.02);
}

TEST(Imu, ComesAHundredTimesASecondInTimeOrder) {
  Simulator simulator(World(bare_floor()), blind_options());
  drive(simulator, {}, 2.0);
  const auto all = simulator.take_observations();
  EXPECT_NEAR(static_cast<double>(only<CObservationIMU>(all).size()), 200.0, 1.0);
  for (std::size_t i = 1; i < all.size(); ++i) {
    EXPECT_LE(all[i - 1]->timestamp, all[i]->timestamp);
  }
  EXPECT_NEAR(mrpt::Clock::toDouble(all.front()->timestamp), 1.0, 1e-6);
}

TEST(Wheels, PerfectOnesFollowTheTruth) {
  Simulator simulator(World(bare_floor()), blind_options());
  drive(simulator, {0.4, 0.0, 0.3}, 4.0);
  const auto last = only<CObservationOdometry>(simulator.take_observations()).back();
  const TPose2D truth = true_pose(simulator);
  EXPECT_NEAR(last->odometry.x(), truth.x, 0.02);
  EXPECT_NEAR(last->odometry.y(), truth.y, 0.02);
  EXPECT_NEAR(last->odometry.phi(), truth.phi, 0.02);
  EXPECT_TRUE(last->hasVelocities);
  EXPECT_NEAR(last->velocityLocal.vx, 0.4, 0.03);
}

TEST(Wheels, ScaleErrorsStayWithinTheirFiguresAndDifferBySeed) {
  const WheelNoise figures;
  Scenario scenario;
  scenario.wheels.slip_events_per_minute = 0.0;
  std::set<double> lengths;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SimulatorOptions options = blind_options(scenario);
    options.seed = seed;
    Simulator straight(World(bare_floor()), options);
    drive(straight, {0.5, 0.0, 0.0}, 8.0);
    const auto last = only<CObservationOdometry>(straight.take_observations()).back();
    const double ratio = last->odometry.x() / true_pose(straight).x;
    EXPECT_NEAR(ratio, 1.0, figures.scale_error_max + 0.003);
    lengths.insert(ratio);
    Simulator turn(World(bare_floor()), options);
    drive(turn, {0.0, 0.0, 0.6}, 5.0);
    const auto turned = only<CObservationOdometry>(turn.take_observations()).back();
    EXPECT_NEAR(turned->odometry.phi() / true_pose(turn).phi, 1.0, figures.track_error_max + 0.006);
  }
  EXPECT_EQ(lengths.size(), 8U);
}

TEST(Wheels, CountWholeTicks) {
  Simulator simulator(World(bare_floor()), blind_options());
  drive(simulator, {0.3, 0.0, 0.0}, 3.0);
  const auto samples = only<CObservationOdometry>(simulator.take_observations());
  const double m_per_tick = 2.0 * maps::kPi * 0.0625 / WheelNoise{}.ticks_per_turn;
  const auto& last = samples.back();
  EXPECT_TRUE(last->hasEncodersInfo);
  EXPECT_NEAR(last->odometry.x(),
              0.5 * (last->encoderLeftTicks + last->encoderRightTicks) * m_per_tick, 1e-3);
}

}  // namespace
}  // namespace rovigo::sim
