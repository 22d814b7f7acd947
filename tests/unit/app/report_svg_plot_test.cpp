#include "app/report/svg_plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace rovigo::app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

Plot sine(std::size_t points) {
  Plot plot;
  plot.title = "Error <of> all";
  plot.x_label = "time (s)";
  plot.y_label = "mm";
  PlotSeries s;
  s.name = "true";
  for (std::size_t i = 0; i < points; ++i) {
    s.x.push_back(0.01 * static_cast<double>(i));
    s.y.push_back(std::sin(0.05 * static_cast<double>(i)));
  }
  plot.series.push_back(s);
  return plot;
}

TEST(RoundTicks, AreRoundAndInside) {
  EXPECT_THAT(round_ticks(0, 10, 5), ElementsAre(0, 2, 4, 6, 8, 10));
  EXPECT_THAT(round_ticks(-0.9, 1.1, 5), ElementsAre(-0.5, 0, 0.5, 1));
  for (const double span : {1e-6, 0.03, 0.7, 1.0, 42.0, 9.99e5}) {
    const auto ticks = round_ticks(0.1 * span, 1.1 * span, 7);
    ASSERT_GE(ticks.size(), 2u) << span;
    ASSERT_LE(ticks.size(), 9u) << span;
    EXPECT_GE(ticks.front(), 0.1 * span * (1 - 1e-9));
    EXPECT_LE(ticks.back(), 1.1 * span * (1 + 1e-9));
  }
}

TEST(RoundTicks, GiveNothingForRangesThatMakeNoSense) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(round_ticks(1, 1, 5).empty());
  EXPECT_TRUE(round_ticks(2, 1, 5).empty());
  EXPECT_TRUE(round_ticks(0, kInf, 5).empty());
  EXPECT_TRUE(round_ticks(std::nan(""), 1, 5).empty());
}

TEST(RoundTicks, DecimalsTellNeighboursApart) {
  EXPECT_EQ(tick_decimals({0, 5, 10}), 0);
  EXPECT_EQ(tick_decimals({0, 0.5}), 1);
  EXPECT_EQ(tick_decimals({0, 0.002}), 3);
  EXPECT_EQ(tick_decimals({1}), 0);
}

TEST(SvgPlot, HoldsTitleLabelsLegendAndTheLine) {
  const std::string svg = plot_svg(sine(100));
  EXPECT_THAT(svg, HasSubstr("Error &lt;of&gt; all"));
  EXPECT_THAT(svg, HasSubstr("time (s)"));
  EXPECT_THAT(svg, HasSubstr(">true<"));
  EXPECT_EQ(count(svg, "<polyline"), 1u);
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(SvgPlot, LongDrivesStaySmallAndKeepTheirPeaks) {
  Plot plot = sine(200000);
  plot.series[0].y[123456] = 50.0;
  const std::string svg = plot_svg(plot);
  EXPECT_LT(svg.size(), 40000u);
  EXPECT_THAT(svg, HasSubstr(">50<"));  // the axis reaches the peak
}

TEST(SvgPlot, NumbersThatAreNotFiniteLeaveAGap) {
  Plot plot = sine(100);
  plot.series[0].y[50] = std::numeric_limits<double>::quiet_NaN();
  const std::string svg = plot_svg(plot);
  EXPECT_EQ(count(svg, "<polyline"), 2u);
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(SvgPlot, EmptyAndConstantSeriesAreDrawnToo) {
  Plot empty;
  empty.series.push_back({});
  EXPECT_THAT(plot_svg(empty), Not(HasSubstr("nan")));
  Plot flat = sine(10);
  for (double& y : flat.series[0].y) y = 0.0;
  EXPECT_THAT(plot_svg(flat), Not(HasSubstr("nan")));
}

TEST(SvgPlot, BandsAreShadedAndNamedOnce) {
  Plot plot = sine(100);
  plot.bands = {{0.1, 0.2, 1, "pose lost"}, {0.4, 0.5, 1, "pose lost"}};
  const std::string svg = plot_svg(plot);
  EXPECT_EQ(count(svg, ">pose lost<"), 1u);
  EXPECT_EQ(count(svg, "class=\"band b1\""), 3u);
}

TEST(SvgPlot, AFileOfItsOwnCarriesItsStyle) {
  const std::string file = plot_file(sine(10));
  EXPECT_THAT(file, HasSubstr("<?xml"));
  EXPECT_THAT(file, HasSubstr("prefers-color-scheme:dark"));
}

}  // namespace
}  // namespace rovigo::app
