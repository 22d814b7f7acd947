#include "app/simulated_drive.h"

#include <gtest/gtest.h>

#include <cmath>

namespace rovigo::app {
namespace {

control::DriveLog log_of(std::initializer_list<double> xs) {
  control::DriveLog log;
  for (const double x : xs) {
    control::DriveStep step;
    step.true_pose = {x, 0.0, 0.0};
    log.steps.push_back(step);
  }
  return log;
}

TEST(LogHash, AnEmptyLogHashesToTheHashOfNothing) {
  EXPECT_EQ(log_hash({}), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST(LogHash, EveryStepAndEveryBitCounts) {
  EXPECT_EQ(log_hash(log_of({1.0, 2.0})), log_hash(log_of({1.0, 2.0})));
  EXPECT_NE(log_hash(log_of({1.0, 2.0})), log_hash(log_of({2.0, 1.0})));
  EXPECT_NE(log_hash(log_of({1.0})), log_hash(log_of({std::nextafter(1.0, 2.0)})));
  EXPECT_NE(log_hash(log_of({1.0})), log_hash(log_of({1.0, 1.0})));
}

TEST(LogHash, TimesStandOutsideTheHash) {
  auto late = log_of({1.0});
  late.steps[0].time_s = 99.0;
  EXPECT_EQ(log_hash(late), log_hash(log_of({1.0})));
}

}  // namespace
}  // namespace rovigo::app
