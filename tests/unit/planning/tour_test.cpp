#include "planning/tour.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace rovigo::planning {
namespace {

using Matrix = std::vector<std::vector<double>>;

Matrix random_places(std::mt19937_64& random, std::size_t stops) {
  std::uniform_real_distribution<double> unit(0.0, 10.0);
  std::vector<std::pair<double, double>> places;
  for (std::size_t i = 0; i < stops + 2; ++i) places.emplace_back(unit(random), unit(random));
  Matrix cost(places.size(), std::vector<double>(places.size()));
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (std::size_t j = 0; j < places.size(); ++j) {
      cost[i][j] =
          std::hypot(places[i].first - places[j].first, places[i].second - places[j].second);
    }
  }
  return cost;
}

double cheapest_of_all(const Matrix& cost) {
  std::vector<std::size_t> order;
  for (std::size_t i = 1; i + 1 < cost.size(); ++i) order.push_back(i);
  double best = std::numeric_limits<double>::infinity();
  do {
    best = std::min(best, tour_cost(cost, order));
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

TEST(Tour, IsTheCheapestOfAllOrdersForFewStops) {
  std::mt19937_64 random(8);
  for (std::size_t stops = 0; stops <= 7; ++stops) {
    const Matrix cost = random_places(random, stops);
    EXPECT_NEAR(tour_cost(cost, shortest_order(cost)), cheapest_of_all(cost), 1e-9) << stops;
  }
}

TEST(Tour, DirectionsMayCostDifferently) {
  // Place 0 start, 3 goal: 1 before 2 is dear one way and cheap the other.
  const Matrix cost{{0, 1, 1, 9}, {9, 0, 9, 1}, {9, 1, 0, 9}, {9, 9, 9, 0}};
  EXPECT_EQ(shortest_order(cost), (std::vector<std::size_t>{2, 1}));
}

TEST(Tour, ManyStopsAreEachVisitedOnceAndNeverWorseThanNearestNeighbour) {
  std::mt19937_64 random(9);
  for (const std::size_t stops : {11U, 20U, 40U}) {
    const Matrix cost = random_places(random, stops);
    const auto order = shortest_order(cost);
    auto sorted = order;
    std::sort(sorted.begin(), sorted.end());
    ASSERT_EQ(sorted.size(), stops);
    for (std::size_t i = 0; i < stops; ++i) ASSERT_EQ(sorted[i], i + 1);
    std::vector<std::size_t> greedy;
    for (std::size_t at = 0; greedy.size() < stops;) {
      std::size_t next = 0;
      for (std::size_t s = 1; s <= stops; ++s) {
        if (std::find(greedy.begin(), greedy.end(), s) != greedy.end()) continue;
        if (next == 0 || cost[at][s] < cost[at][next]) next = s;
      }
      greedy.push_back(next);
      at = next;
    }
    EXPECT_LE(tour_cost(cost, order), tour_cost(cost, greedy) + 1e-9);
  }
}

TEST(Tour, UnreachableStopsLeaveTheGivenOrder) {
  const double inf = std::numeric_limits<double>::infinity();
  const Matrix cost{{0, inf, 1, 1}, {inf, 0, inf, inf}, {1, inf, 0, 1}, {1, inf, 1, 0}};
  EXPECT_EQ(shortest_order(cost), (std::vector<std::size_t>{1, 2}));
}

}  // namespace
}  // namespace rovigo::planning
