#include "planning/tour.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <random>

namespace rovigo::planning {

namespace {

using Matrix = std::vector<std::vector<double>>;
using Order = std::vector<std::size_t>;

constexpr std::size_t kMostExact = 10;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Dynamic programme over sets of visited stops and the last one of them.
Order exact_order(const Matrix& cost) {
  const std::size_t stops = cost.size() - 2;
  const std::size_t sets = std::size_t{1} << stops;
  std::vector<double> best(sets * stops, kInfinity);
  std::vector<std::size_t> before(sets * stops, stops);
  for (std::size_t s = 0; s < stops; ++s) best[(std::size_t{1} << s) * stops + s] = cost[0][s + 1];
  for (std::size_t set = 1; set < sets; ++set) {
    for (std::size_t last = 0; last < stops; ++last) {
      const double here = best[set * stops + last];
      if ((set >> last & 1U) == 0 || here == kInfinity) continue;
      for (std::size_t next = 0; next < stops; ++next) {
        if ((set >> next & 1U) != 0) continue;
        const std::size_t to = (set | std::size_t{1} << next) * stops + next;
        const double total = here + cost[last + 1][next + 1];
        if (total < best[to]) {
          best[to] = total;
          before[to] = last;
        }
      }
    }
  }
  std::size_t last = stops;
  double least = kInfinity;
  for (std::size_t s = 0; s < stops; ++s) {
    const double total = best[(sets - 1) * stops + s] + cost[s + 1].back();
    if (total < least) {
      least = total;
      last = s;
    }
  }
  Order order;
  for (std::size_t set = sets - 1; last < stops;) {
    order.push_back(last + 1);
    const std::size_t previous = before[set * stops + last];
    set &= ~(std::size_t{1} << last);
    last = previous;
  }
  std::reverse(order.begin(), order.end());
  return order;
}

Order given_order(std::size_t stops) {
  Order order(stops);
  for (std::size_t i = 0; i < stops; ++i) order[i] = i + 1;
  return order;
}

Order nearest_neighbour(const Matrix& cost) {
  Order left = given_order(cost.size() - 2);
  Order order;
  std::size_t at = 0;
  while (!left.empty()) {
    const auto next = std::min_element(left.begin(), left.end(), [&](std::size_t a, std::size_t b) {
      return cost[at][a] < cost[at][b];
    });
    at = *next;
    order.push_back(at);
    left.erase(next);
  }
  return order;
}

Order cheapest_insertion(const Matrix& cost) {
  Order order;
  for (std::size_t stop = 1; stop + 1 < cost.size(); ++stop) {
    Order best;
    double least = kInfinity;
    for (std::size_t place = 0; place <= order.size(); ++place) {
      Order tried = order;
      tried.insert(tried.begin() + static_cast<std::ptrdiff_t>(place), stop);
      const double total = tour_cost(cost, tried);
      if (best.empty() || total < least) {
        least = total;
        best = std::move(tried);
      }
    }
    order = std::move(best);
  }
  return order;
}

/// Reversals (2-opt) and moves of up to three stops (or-opt) until none makes the way cheaper.
void improve(const Matrix& cost, Order& order) {
  constexpr double kGain = 1e-9;
  double least = tour_cost(cost, order);
  const auto keep_if_better = [&](Order&& tried) {
    const double total = tour_cost(cost, tried);
    if (!(total < least - kGain)) return false;
    least = total;
    order = std::move(tried);
    return true;
  };
  const auto at = [](Order& o, std::size_t i) {
    return o.begin() + static_cast<std::ptrdiff_t>(i);
  };
  for (bool better = true; better;) {
    better = false;
    for (std::size_t i = 0; i < order.size(); ++i) {
      for (std::size_t j = i + 1; j < order.size(); ++j) {
        Order reversed = order;
        std::reverse(at(reversed, i), at(reversed, j + 1));
        better |= keep_if_better(std::move(reversed));
        // Stops i .. j moved behind each later stop: a rotation.
        for (std::size_t k = j + 1; j - i <= 3 && k < order.size(); ++k) {
          Order moved = order;
          std::rotate(at(moved, i), at(moved, j), at(moved, k + 1));
          better |= keep_if_better(std::move(moved));
          Order back = order;
          std::rotate(at(back, i), at(back, k + 1 - (j - i)), at(back, k + 1));
          better |= keep_if_better(std::move(back));
        }
      }
    }
  }
}

/// Simulated annealing (Kirkpatrick et al. 1983) over reversals and moves of single stops, cooling
/// geometrically; returns the best order met. Same arguments, same answer.
Order anneal(const Matrix& cost, const Order& first) {
  constexpr int kStepsPerStop = 1500;
  constexpr double kColdest = 1e-3;  // of the start temperature
  std::mt19937_64 random(first.size());
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  Order order = first;
  Order best = first;
  double now = tour_cost(cost, order);
  double least = now;
  if (!(now < kInfinity)) return best;  // nothing to weigh against
  const int steps = kStepsPerStop * static_cast<int>(order.size());
  const double hottest = 0.3 * now / static_cast<double>(order.size() + 1);
  for (int step = 0; step < steps; ++step) {
    const double temperature = hottest * std::pow(kColdest, static_cast<double>(step) / steps);
    Order tried = order;
    const std::size_t i = below(order.size());
    const std::size_t j = below(order.size());
    const auto low = tried.begin() + static_cast<std::ptrdiff_t>(std::min(i, j));
    const auto high = tried.begin() + static_cast<std::ptrdiff_t>(std::max(i, j)) + 1;
    if (step % 2 == 0) {
      std::reverse(low, high);
    } else {
      i < j ? std::rotate(low, low + 1, high) : std::rotate(low, high - 1, high);
    }
    const double total = tour_cost(cost, tried);
    const double chance = static_cast<double>(random() >> 11) * 0x1p-53;
    if (total > now && !(chance < std::exp((now - total) / temperature))) continue;
    order = std::move(tried);
    now = total;
    if (now < least) {
      least = now;
      best = order;
    }
  }
  return best;
}

}  // namespace

double tour_cost(const Matrix& cost, const Order& order) {
  double total = 0.0;
  std::size_t at = 0;
  for (const std::size_t stop : order) {
    total += cost[at][stop];
    at = stop;
  }
  return total + cost[at].back();
}

Order shortest_order(const Matrix& cost) {
  assert(cost.size() >= 2);
  const std::size_t stops = cost.size() - 2;
  if (stops < 2) return given_order(stops);
  if (stops <= kMostExact) {
    Order order = exact_order(cost);
    return order.size() == stops ? order : given_order(stops);  // nothing connects them all
  }
  Order near = nearest_neighbour(cost);
  Order inserted = cheapest_insertion(cost);
  improve(cost, near);
  improve(cost, inserted);
  const Order& better = tour_cost(cost, near) <= tour_cost(cost, inserted) ? near : inserted;
  Order annealed = anneal(cost, better);
  improve(cost, annealed);
  return tour_cost(cost, annealed) < tour_cost(cost, better) ? annealed : better;
}

}  // namespace rovigo::planning
