#pragma once
// The yardstick: Boost.Graph's A* on the same grid.

#include <boost/graph/astar_search.hpp>
#include <boost/graph/compressed_sparse_row_graph.hpp>
#include <cmath>
#include <vector>

#include "planning/search_grid.h"

namespace rovigo::benchmarks {

/// A prebuilt compressed-sparse-row graph, octile heuristic, vector property maps.
class BoostAStar {
 public:
  explicit BoostAStar(const planning::SearchGrid& grid) : grid_(grid) {
    const auto offsets = grid.offsets();
    std::vector<std::pair<std::size_t, std::size_t>> edges;
    std::vector<Weight> weights;
    for (std::size_t cell = 0; cell < grid.padded_size(); ++cell) {
      for (std::size_t move = 0; move < 8; ++move) {
        if ((grid.moves()[cell] >> move & 1U) == 0) continue;
        edges.emplace_back(cell, cell + static_cast<std::size_t>(offsets[move]));
        weights.push_back({move < planning::kStraightMoves ? 1.0F : std::sqrt(2.0F)});
      }
    }
    graph_ = Graph(boost::edges_are_sorted, edges.begin(), edges.end(), weights.begin(),
                   grid.padded_size());
    distance_.resize(grid.padded_size());
    cost_.resize(grid.padded_size());
    color_.resize(grid.padded_size());
    predecessor_.resize(grid.padded_size());
  }

  /// Length in cells; infinity where there is no way.
  double find(maps::Cell start, maps::Cell goal) {
    const std::size_t to = grid_.index_of(goal);
    const auto index = boost::get(boost::vertex_index, graph_);
    const auto over = [&](auto& values) {
      return boost::make_iterator_property_map(values.begin(), index);
    };
    try {
      boost::astar_search(graph_, grid_.index_of(start), Octile{&grid_, goal},
                          boost::visitor(StopAt{{}, to})
                              .weight_map(boost::get(&Weight::length, graph_))
                              .vertex_index_map(index)
                              .distance_map(over(distance_))
                              .rank_map(over(cost_))
                              .color_map(over(color_))
                              .predecessor_map(over(predecessor_)));
    } catch (const Found&) {
      return distance_[to];
    }
    return std::numeric_limits<double>::infinity();
  }

 private:
  struct Weight {
    float length;
  };
  using Graph = boost::compressed_sparse_row_graph<boost::directedS, boost::no_property, Weight>;
  struct Found {};
  struct Octile : boost::astar_heuristic<Graph, float> {
    Octile(const planning::SearchGrid* g, maps::Cell target) : grid(g), goal(target) {}
    float operator()(std::size_t cell) const {
      const maps::Cell c = grid->cell_of(static_cast<std::uint32_t>(cell));
      const auto dx = static_cast<float>(std::abs(c.x - goal.x));
      const auto dy = static_cast<float>(std::abs(c.y - goal.y));
      return std::max(dx, dy) + (std::sqrt(2.0F) - 1.0F) * std::min(dx, dy);
    }
    const planning::SearchGrid* grid;
    maps::Cell goal;
  };
  struct StopAt : boost::default_astar_visitor {
    StopAt(boost::default_astar_visitor, std::size_t to) : goal(to) {}
    template <typename G>
    void examine_vertex(std::size_t vertex, const G&) {
      if (vertex == goal) throw Found{};
    }
    std::size_t goal;
  };

  const planning::SearchGrid& grid_;
  Graph graph_;
  std::vector<float> distance_, cost_;
  std::vector<boost::default_color_type> color_;
  std::vector<std::size_t> predecessor_;
};

}  // namespace rovigo::benchmarks
