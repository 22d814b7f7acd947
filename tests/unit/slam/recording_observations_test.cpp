#include "slam/recording/observations.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace rovigo::slam {
namespace {

TEST(Observations, TimesKeepTheirHundredNanoseconds) {
  for (const double time_s : {0.0, 1.0 / 30.0, 0.1234567, 12345.6789012, 1305031229.528748}) {
    mrpt::obs::CObservationIMU imu;
    imu.timestamp = timestamp_from_seconds(time_s);
    EXPECT_NEAR(seconds_of(imu), time_s, time_s > 1e9 ? 3e-7 : 5.1e-8);
    EXPECT_EQ(timestamp_from_seconds(seconds_of(imu)), imu.timestamp);
    EXPECT_NEAR(mrpt::Clock::toDouble(imu.timestamp), time_s, 1e-6);
  }
}

TEST(Observations, TimeTextIsExactToTheTick) {
  mrpt::obs::CObservationIMU imu;
  imu.timestamp = timestamp_from_seconds(0.0333333);
  EXPECT_EQ(time_text(imu), "0.0333333");
  imu.timestamp = timestamp_from_seconds(1305031229.0);
  imu.timestamp += mrpt::Clock::duration(5966001);
  EXPECT_EQ(time_text(imu), "1305031229.5966001");
}

TEST(Observations, AnImuSampleComesBackAsItWent) {
  const ImuSample sample{3.5, {0.1, -0.2, 0.3}, {1.0, -2.0, 9.81}};
  const auto back = imu_sample_of(*make_imu_observation(sample));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->angular_rate_rad_s, sample.angular_rate_rad_s);
  EXPECT_EQ(back->specific_force_m_s2, sample.specific_force_m_s2);
  EXPECT_DOUBLE_EQ(back->time_s, 3.5);
}

TEST(Observations, ATurnedImuIsTurnedIntoTheBase) {
  auto imu = make_imu_observation({0, {0.1, 0.2, 0.3}, {0, 0, 9.81}});
  imu->sensorPose = mrpt::poses::CPose3D(0, 0, 0, 0, 0, M_PI);  // upside down
  const auto sample = imu_sample_of(*imu);
  ASSERT_TRUE(sample);
  EXPECT_NEAR(sample->specific_force_m_s2.z(), -9.81, 1e-9);
  EXPECT_NEAR(sample->angular_rate_rad_s.x(), 0.1, 1e-9);
  EXPECT_NEAR(sample->angular_rate_rad_s.y(), -0.2, 1e-9);
}

TEST(Observations, AnImuWithoutForcesOrWithNanIsNoSample) {
  mrpt::obs::CObservationIMU rates_only;
  rates_only.set(mrpt::obs::IMU_WX, 0.1);
  EXPECT_FALSE(imu_sample_of(rates_only));
  auto broken = make_imu_observation({0, {0, 0, 0}, {0, 0, 9.81}});
  broken->set(mrpt::obs::IMU_WZ, std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(imu_sample_of(*broken));
}

TEST(Observations, OdometryCarriesTheSpeedOfTheArcSinceTheLast) {
  // A quarter turn of radius 2 m in 4 s: v = pi/4 m/s, the chord is 10% shorter than the arc.
  const WheelSample start{1.0, {1, 2, 0.3}};
  const TPose2D quarter{2, 2, M_PI / 2};
  const WheelSample end{5.0, maps::compose(start.odom_from_base, quarter)};
  const auto odometry = make_odometry_observation(end, start);
  ASSERT_TRUE(odometry->hasVelocities);
  EXPECT_NEAR(odometry->velocityLocal.omega, M_PI / 8, 1e-12);
  EXPECT_NEAR(odometry->velocityLocal.vy, 0.0, 1e-12);
  EXPECT_NEAR(odometry->velocityLocal.vx, 2 * std::sqrt(2.0) / 4, 1e-12);
}

TEST(Observations, OdometryWithoutAPredecessorOrTimeHasNoSpeed) {
  const WheelSample sample{1.0, {1, 2, 0.3}};
  EXPECT_FALSE(make_odometry_observation(sample, std::nullopt)->hasVelocities);
  EXPECT_FALSE(make_odometry_observation(sample, sample)->hasVelocities);
}

}  // namespace
}  // namespace rovigo::slam
