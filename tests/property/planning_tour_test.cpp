// Random places and random, even lopsided, costs: the order found is never worse than what nearest
// neighbour and 2-opt find.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "planning/tour.h"

namespace rovigo::planning {
namespace {

using Matrix = std::vector<std::vector<double>>;
using Order = std::vector<std::size_t>;

Matrix random_costs(std::mt19937_64& random, std::size_t stops, bool is_plane) {
  std::uniform_real_distribution<double> unit(0.0, 10.0);
  std::vector<std::pair<double, double>> places(stops + 2);
  for (auto& place : places) place = {unit(random), unit(random)};
  Matrix cost(places.size(), std::vector<double>(places.size(), 0.0));
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (std::size_t j = 0; j < places.size(); ++j) {
      if (i == j) continue;
      cost[i][j] = is_plane ? std::hypot(places[i].first - places[j].first,
                                         places[i].second - places[j].second)
                            : unit(random);
    }
  }
  return cost;
}

Order nearest_neighbour_and_two_opt(const Matrix& cost) {
  const std::size_t stops = cost.size() - 2;
  Order order;
  for (std::size_t at = 0; order.size() < stops; at = order.back()) {
    std::size_t next = 0;
    for (std::size_t s = 1; s <= stops; ++s) {
      if (std::find(order.begin(), order.end(), s) != order.end()) continue;
      if (next == 0 || cost[at][s] < cost[at][next]) next = s;
    }
    order.push_back(next);
  }
  for (bool better = true; better;) {
    better = false;
    for (std::size_t i = 0; i < stops; ++i) {
      for (std::size_t j = i + 1; j < stops; ++j) {
        Order tried = order;
        std::reverse(tried.begin() + static_cast<std::ptrdiff_t>(i),
                     tried.begin() + static_cast<std::ptrdiff_t>(j) + 1);
        if (tour_cost(cost, tried) < tour_cost(cost, order) - 1e-9) {
          order = tried;
          better = true;
        }
      }
    }
  }
  return order;
}

class RandomTours : public testing::TestWithParam<bool> {};

TEST_P(RandomTours, AreNeverWorseThanNearestNeighbourAndTwoOpt) {
  constexpr std::uint64_t kSeed = 31;
  std::mt19937_64 random(kSeed);
  int better = 0;
  for (int i = 0; i < 40; ++i) {
    const std::size_t stops = 2 + random() % 20;
    const Matrix cost = random_costs(random, stops, GetParam());
    const Order order = shortest_order(cost);
    Order sorted = order;
    std::sort(sorted.begin(), sorted.end());
    Order all(stops);
    std::iota(all.begin(), all.end(), std::size_t{1});
    ASSERT_EQ(sorted, all) << "seed " << kSeed << " case " << i;
    const double theirs = tour_cost(cost, nearest_neighbour_and_two_opt(cost));
    ASSERT_LE(tour_cost(cost, order), theirs + 1e-9) << "seed " << kSeed << " case " << i;
    better += tour_cost(cost, order) < theirs - 1e-6 ? 1 : 0;
    ASSERT_EQ(order, shortest_order(cost)) << "not repeatable";
  }
  EXPECT_GT(better, 5);
}

INSTANTIATE_TEST_SUITE_P(Costs, RandomTours, testing::Bool(), [](const auto& param) {
  return param.param ? std::string("InThePlane") : std::string("Lopsided");
});

TEST(RandomTours, ElevenStopsAreAsGoodAsTheBestOrderNearlyAlways) {
  // One stop more than is solved exactly; the last one is split off to ask the exact solver.
  std::mt19937_64 random(7);
  int best = 0;
  for (int i = 0; i < 15; ++i) {
    const Matrix cost = random_costs(random, 11, true);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t first = 1; first <= 11; ++first) {
      // The way begins with `first`: ten others remain, from there.
      Matrix rest;
      for (std::size_t r = 0; r < cost.size(); ++r) {
        if (r == first) continue;
        const std::size_t from = r == 0 ? first : r;
        std::vector<double> row;
        for (std::size_t c = 0; c < cost.size(); ++c) {
          if (c != first) row.push_back(cost[from][c]);
        }
        rest.push_back(row);
      }
      least = std::min(least, cost[0][first] + tour_cost(rest, shortest_order(rest)));
    }
    const double ours = tour_cost(cost, shortest_order(cost));
    ASSERT_GE(ours, least - 1e-9);
    ASSERT_LE(ours, 1.02 * least);
    best += ours < least + 1e-6 ? 1 : 0;
  }
  EXPECT_GE(best, 13);
}

}  // namespace
}  // namespace rovigo::planning
