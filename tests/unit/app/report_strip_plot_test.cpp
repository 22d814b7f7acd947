#include "app/report/strip_plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace rovigo::app {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(StripPlot, EachFiniteValueIsADotAndTheMedianABar) {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  const std::string svg = strip_plot_svg("t", "mm", {{"a <b>", {1.0, 10.0, nothing}, 0}});
  std::size_t dots = 0;
  for (std::size_t at = 0; (at = svg.find("<circle", at)) != std::string::npos; ++at) ++dots;
  EXPECT_EQ(dots, 2U);
  EXPECT_THAT(svg, HasSubstr("a &lt;b&gt;"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(StripPlot, ZeroAndNothingAtAllAreDrawnToo) {
  EXPECT_THAT(strip_plot_svg("t", "mm", {{"a", {0.0}, 0}, {"b", {}, 1}}), Not(HasSubstr("inf")));
  EXPECT_THAT(strip_plot_svg("t", "mm", {}), Not(HasSubstr("nan")));
}

TEST(PathPlot, BothAxesHaveTheSameScale) {
  const std::string svg = path_plot_svg("t", {{"line", {{0, 0}, {1, 0}, {1, 0.5}}, 0, false}});
  // 602 px for the metre along x, so 301 px for the half along y.
  EXPECT_THAT(svg, HasSubstr("20.0,359.0 622.0,359.0 622.0,58.0"));
  EXPECT_THAT(path_plot_svg("t", {}), Not(HasSubstr("inf")));
}

}  // namespace
}  // namespace rovigo::app
