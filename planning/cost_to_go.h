#pragma once
// The cost of the cheapest way from every cell to the nearest of some goals, at once.

#include <cstdint>
#include <vector>

#include "planning/search_grid.h"
#include "planning/step_scale.h"

namespace rovigo::planning {

class StepPrices;

/// Dijkstra's search over the whole grid, with the costs of GridSearch (astar.h) and as exact.
/// For questions about many cells: tours, exploration, how far things are. Keeps a reference to the
/// grid last computed on.
class CostToGo {
 public:
  /// Goals outside the grid or impassable are left out.
  void compute(const SearchGrid& grid, const std::vector<maps::Cell>& goals,
               double soft_cost_weight);

  /// Length weighted by soft costs, metres; infinity where no goal can be reached from.
  double cost_m(maps::Cell cell) const;

  struct Way {
    std::vector<maps::Cell> cells;  ///< to the goal, both ends included; empty when there is none
    double length_m = 0.0;          ///< of the polyline through the cell centres
  };
  Way way_from(maps::Cell cell) const;

  std::size_t memory_bytes() const;

 private:
  /// Returns false where costs outgrow 32 bits.
  template <bool soft>
  bool flood(const StepPrices& prices, const std::vector<maps::Cell>& goals);

  const SearchGrid* grid_ = nullptr;
  StepScale scale_{};
  double soft_cost_weight_ = 0.0;
  std::vector<std::uint32_t> costs_;
  std::vector<std::vector<std::uint32_t>> buckets_;
};

}  // namespace rovigo::planning
