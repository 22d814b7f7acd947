#include "app/report/number_text.h"

#include <gtest/gtest.h>

#include <limits>

namespace rovigo::app {
namespace {

TEST(NumberText, FixedRoundsAndHasNoNegativeZero) {
  EXPECT_EQ(fixed(1.23456, 3), "1.235");
  EXPECT_EQ(fixed(-0.0001, 2), "0.00");
  EXPECT_EQ(fixed(-0.5, 1), "-0.5");
  EXPECT_EQ(fixed(0.0, 0), "0");
  EXPECT_EQ(fixed(std::numeric_limits<double>::quiet_NaN(), 2), "nan");
  EXPECT_EQ(fixed(-std::numeric_limits<double>::infinity(), 2), "-inf");
  EXPECT_EQ(fixed(1e300, 0).size(), 301u);
}

TEST(NumberText, QuantitiesReadWell) {
  EXPECT_EQ(quantity(0.0123, "m"), "12.3 mm");
  EXPECT_EQ(quantity(4.2, "m"), "4.20 m");
  EXPECT_EQ(quantity(0.5, "rad"), "28.65° (0.5000 rad)");
  EXPECT_EQ(quantity(0.256, "%"), "25.6 %");
  EXPECT_EQ(quantity(12.34, "s"), "12.3 s");
  EXPECT_EQ(quantity(0, ""), "0");
  EXPECT_EQ(quantity(std::numeric_limits<double>::quiet_NaN(), "m"), "–");
}

TEST(NumberText, EscapesMarkupAndDropsControlCharacters) {
  EXPECT_EQ(escaped("a<b> & \"c\"\x01"), "a&lt;b&gt; &amp; &quot;c&quot;");
  EXPECT_EQ(escaped("Röhre"), "Röhre");
}

}  // namespace
}  // namespace rovigo::app
