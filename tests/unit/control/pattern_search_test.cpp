#include "control/pattern_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

namespace rovigo::control {
namespace {

using Point = std::vector<double>;

BatchCost each(const std::function<double(const Point&)>& cost) {
  return [cost](const std::vector<Point>& points) {
    std::vector<double> out;
    for (const auto& p : points) out.push_back(cost(p));
    return out;
  };
}

/// A narrow valley across the axes with its bottom at (3, 0.5).
double valley(const Point& p) {
  const double a = std::log(p[0] / 3.0), b = std::log(p[1] / 0.5);
  return 1.0 + 20.0 * (a + b) * (a + b) + (a - b) * (a - b);
}

TEST(PatternSearch, FindsTheBottomOfAValleyThatLiesAcrossTheAxes) {
  const auto r = pattern_search({{1.0, 0.1, 10.0}, {1.0, 0.1, 10.0}}, each(valley),
                                {.last_factor = 1.001, .max_evaluations = 1000});
  EXPECT_TRUE(r.converged);
  EXPECT_NEAR(r.best[0], 3.0, 0.03);
  EXPECT_NEAR(r.best[1], 0.5, 0.005);
  EXPECT_DOUBLE_EQ(r.cost, valley(r.best));
}

TEST(PatternSearch, NeverReturnsWorseThanItsStartWhateverTheCostsAre) {
  std::mt19937_64 random(11);
  for (int run = 0; run < 50; ++run) {
    const double start_cost = static_cast<double>(random() % 1000);
    bool first = true;
    const auto cost = each([&](const Point&) {
      if (std::exchange(first, false)) return start_cost;
      return random() % 3 == 0 ? std::nan("") : static_cast<double>(random() % 1000);
    });
    const auto r =
        pattern_search({{1.0, 0.5, 2.0}, {2.0, 1.0, 2.0}}, cost, {.max_evaluations = 40});
    EXPECT_LE(r.cost, start_cost);
    EXPECT_LE(r.evaluations, 40);
    EXPECT_GE(r.best[0], 0.5 - 1e-12);
    EXPECT_LE(r.best[1], 2.0 + 1e-12);
  }
}

TEST(PatternSearch, KeepsTheStartWhereNothingIsBetter) {
  const auto r = pattern_search({{3.0, 0.1, 10.0}, {0.5, 0.1, 10.0}}, each(valley), {});
  EXPECT_EQ(r.best, (Point{3.0, 0.5}));
  EXPECT_EQ(r.cost, r.start_cost);
}

TEST(PatternSearch, IsTheSameForTheSameSeedAndAsksNoMoreThanItMay) {
  int asked = 0;
  const auto cost = each([&](const Point& p) {
    ++asked;
    return valley(p);
  });
  const PatternSearchConfig config{.last_factor = 1.0001, .max_evaluations = 37, .seed = 4};
  const auto a = pattern_search({{1.0, 0.1, 10.0}, {1.0, 0.1, 10.0}}, cost, config);
  EXPECT_EQ(asked, 37);
  EXPECT_EQ(a.evaluations, 37);
  const auto b = pattern_search({{1.0, 0.1, 10.0}, {1.0, 0.1, 10.0}}, cost, config);
  EXPECT_EQ(a.best, b.best);
  EXPECT_EQ(a.cost, b.cost);
}

}  // namespace
}  // namespace rovigo::control
