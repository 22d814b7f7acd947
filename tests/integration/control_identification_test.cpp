// Identification on logs of the simulated rover: it finds the lag that the motors were given.
#include <gtest/gtest.h>

#include "app/report/drive_tables.h"
#include "app/signal_log.h"
#include "control/identification.h"
#include "tests/support/run_rovigo.h"
#include "tests/unit/control/plant.h"
#include "tests/unit/control/simulated_drive.h"

namespace rovigo::control {
namespace {

/// Drives a slalom, writes drive.csv as `rovigo drive --report` does, and identifies that file.
std::vector<IdentificationResult> identify_drive(double motor_lag_s, double latency_s) {
  testing::SimulatedDrive setup;
  setup.scenario.motor.lag_s = motor_lag_s;
  setup.scenario.commands.latency_s = latency_s;
  const DriveLog log = testing::drive_in_hall(testing::slalom(setup.robot), setup);
  EXPECT_EQ(log.status, TrackStatus::kReached);
  const test::TemporaryFolder folder;
  test::write_text(folder / "drive.csv", app::drive_csv(log));
  std::vector<IdentificationResult> out;
  for (const auto& signal : app::read_signal_logs(folder / "drive.csv", {})) {
    out.push_back(identify_first_order(signal.samples));
  }
  return out;
}

TEST(IdentificationOnSimulator, FindsTheMotorsLagAndTheCommandsLatency) {
  for (const double lag : {0.04, 0.12}) {
    for (const double latency : {0.0, 0.1}) {
      const auto models = identify_drive(lag, latency);
      ASSERT_EQ(models.size(), 2U) << "forward speed and turn rate";
      for (const IdentificationResult& r : models) {
        ASSERT_EQ(r.status, IdentificationStatus::kOk) << lag << " " << latency;
        EXPECT_NEAR(r.model.gain, 1.0, 0.02);
        EXPECT_NEAR(r.model.time_constant_s + r.model.dead_time_s, lag + latency, 0.01 + 0.05 * lag)
            << lag << " " << latency;
        EXPECT_GT(r.fit_share, 0.9) << lag << " " << latency;
      }
    }
  }
}

}  // namespace
}  // namespace rovigo::control
