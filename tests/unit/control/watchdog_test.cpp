#include "control/watchdog.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace rovigo::control {
namespace {

TEST(Watchdog, IsExpiredBeforeTheFirstFeed) {
  const Watchdog dog(0.2);
  EXPECT_TRUE(dog.expired(0.0));
  EXPECT_TRUE(std::isinf(dog.silence_s(0.0)));
}

TEST(Watchdog, ExpiresExactlyAtItsTimeout) {
  Watchdog dog(0.2);
  dog.feed(10.0);
  EXPECT_FALSE(dog.expired(10.0));
  EXPECT_FALSE(dog.expired(10.199));
  EXPECT_TRUE(dog.expired(10.2));  // 10.2 - 10.0 is a little less than 0.2 in doubles
  dog.feed(10.3);
  EXPECT_FALSE(dog.expired(10.4));
}

TEST(Watchdog, CountsClocksThatMakeNoSenseAsExpired) {
  Watchdog dog(0.2);
  dog.feed(10.0);
  EXPECT_TRUE(dog.expired(9.0));
  EXPECT_TRUE(dog.expired(std::numeric_limits<double>::quiet_NaN()));
  dog.feed(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(dog.expired(10.0));
}

}  // namespace
}  // namespace rovigo::control
