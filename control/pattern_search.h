#pragma once
// Minimises a cost of a few positive parameters without derivatives.

#include <cstdint>
#include <functional>
#include <vector>

namespace rovigo::control {

/// One parameter; steps are factors, so all must be positive. Precondition: min <= start <= max.
struct SearchParameter {
  double start = 1.0;
  double min = 0.1;
  double max = 10.0;
};

/// The costs of these points, in their order; they may be computed side by side. What is not a
/// number counts as infinitely bad.
using BatchCost = std::function<std::vector<double>(const std::vector<std::vector<double>>&)>;

struct PatternSearchConfig {
  double first_factor = 1.6;  ///< of the first steps, up or down
  double last_factor = 1.05;  ///< steps finer than this are not worth it
  int max_evaluations = 100;  ///< the start's is one
  std::uint64_t seed = 1;
};

struct PatternSearchResult {
  std::vector<double> best;  ///< never costs more than the start
  double cost = 0.0;
  double start_cost = 0.0;
  int evaluations = 0;
  bool converged = false;  ///< the steps got finer than asked; else the evaluations ran out
};

/// Polls up and down along the parameters, later along random orthogonal directions (as mesh
/// adaptive direct search does, Audet & Dennis 2006), goes to the best point that is better, and
/// halves the step where none is. Same arguments, same result, however the costs are computed.
PatternSearchResult pattern_search(const std::vector<SearchParameter>& parameters,
                                   const BatchCost& cost, const PatternSearchConfig& config);

}  // namespace rovigo::control
