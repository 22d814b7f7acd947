#pragma once
// The order in which several stops are visited.

#include <cstddef>
#include <vector>

namespace rovigo::planning {

/// cost[i][j]: from place i to place j; place 0 is the start, the last the goal, those between are
/// the stops. Returns the stops (indices 1 .. n - 2) in the order of the cheapest way from start
/// to goal through all: exact for up to 10 stops (Held & Karp 1962), above that
/// simulated annealing from the better of nearest neighbour and cheapest insertion, both improved
/// by 2-opt and or-opt moves until none helps, and never worse than these. Same costs, same order:
/// the annealing has a seed of its own and a fixed number of steps. Among equally cheap orders the
/// choice is always the same. Infinite costs mark unreachable pairs. Precondition: the matrix is
/// square with at least two rows.
std::vector<std::size_t> shortest_order(const std::vector<std::vector<double>>& cost);

/// Cost of visiting the stops in this order, from place 0 to the last place.
double tour_cost(const std::vector<std::vector<double>>& cost,
                 const std::vector<std::size_t>& order);

}  // namespace rovigo::planning
