#include "planning/search_grid.h"

#include "maps/error.h"

namespace rovigo::planning {

namespace {

/// Searches keep an index and a move in 32 bits; no grid a person uses comes near.
void check_size(const maps::GridGeometry& g) {
  constexpr std::size_t kLimit = std::size_t{1} << SearchGrid::kIndexBits;
  const auto padded =
      (static_cast<std::size_t>(g.width) + 2) * (static_cast<std::size_t>(g.height) + 2);
  if (g.width < 0 || g.height < 0 || padded > kLimit) {
    throw maps::InputError("a grid of " + std::to_string(g.width) + " x " +
                           std::to_string(g.height) +
                           " cells is too large to plan on (limit: 2^29 cells); use a coarser one");
  }
}

}  // namespace

SearchGrid::SearchGrid(const maps::Costmap& costmap, int connectivity)
    : geometry_(costmap.geometry) {
  check_size(geometry_);
  passable_.assign(static_cast<std::size_t>(stride()) * (geometry_.height + 2), 0);
  bool has_costs = false;
  for (int y = 0; y < geometry_.height; ++y) {
    const std::uint8_t* row = costmap.cells.data() + geometry_.index_of({0, y});
    std::uint8_t* out = passable_.data() + index_of({0, y});
    for (int x = 0; x < geometry_.width; ++x) {
      out[x] = maps::Costmap::is_passable(row[x]) ? 1 : 0;
      has_costs |= out[x] != 0 && row[x] != maps::Costmap::kFree;
    }
  }
  build_moves(connectivity);
  if (!has_costs) return;
  costs_.assign(passable_.size(), 0);
  for (int y = 0; y < geometry_.height; ++y) {
    const std::uint8_t* row = costmap.cells.data() + geometry_.index_of({0, y});
    std::copy(row, row + geometry_.width, costs_.data() + index_of({0, y}));
  }
}

SearchGrid::SearchGrid(const maps::OccupancyGrid& grid, maps::MapMode map_mode, int connectivity)
    : geometry_(grid.geometry) {
  check_size(geometry_);
  passable_.assign(static_cast<std::size_t>(stride()) * (geometry_.height + 2), 0);
  std::array<std::uint8_t, 256> open{};
  for (int value = -128; value < 128; ++value) {
    const auto v = static_cast<std::int8_t>(value);
    const bool unknown_passes = map_mode != maps::MapMode::kKnownFree;
    const bool passes = map_mode == maps::MapMode::kEverything || maps::OccupancyGrid::is_free(v) ||
                        (maps::OccupancyGrid::is_unknown(v) && unknown_passes);
    open[static_cast<std::uint8_t>(v)] = passes ? 1 : 0;
  }
  for (int y = 0; y < geometry_.height; ++y) {
    const std::int8_t* row = grid.cells.data() + geometry_.index_of({0, y});
    std::uint8_t* out = passable_.data() + index_of({0, y});
    for (int x = 0; x < geometry_.width; ++x) out[x] = open[static_cast<std::uint8_t>(row[x])];
  }
  build_moves(connectivity);
}

std::array<int, 8> SearchGrid::offsets() const {
  std::array<int, 8> out{};
  for (std::size_t d = 0; d < out.size(); ++d) out[d] = kMoves[d].dy * stride() + kMoves[d].dx;
  return out;
}

void SearchGrid::build_moves(int connectivity) {
  moves_.assign(passable_.size(), 0);
  has_every_move_ = connectivity == 8;
  const int s = stride();
  const unsigned diagonals = connectivity == 8 ? 0xFFU : 0x0FU;
  for (int y = 0; y < geometry_.height; ++y) {
    const std::uint8_t* p = passable_.data() + index_of({0, y});
    std::uint8_t* out = moves_.data() + index_of({0, y});
    for (int x = 0; x < geometry_.width; ++x, ++p) {
      const unsigned e = p[1];
      const unsigned w = p[-1];
      const unsigned n = p[s];
      const unsigned south = p[-s];
      const unsigned bits = e | w << 1U | n << 2U | south << 3U | (e & n & p[s + 1]) << 4U |
                            (w & n & p[s - 1]) << 5U | (e & south & p[-s + 1]) << 6U |
                            (w & south & p[-s - 1]) << 7U;
      out[x] = static_cast<std::uint8_t>((0U - p[0]) & bits & diagonals);
    }
  }
}

void SearchGrid::close_move(maps::Cell from, maps::Cell to) {
  has_every_move_ = false;
  for (std::size_t d = 0; d < kMoves.size(); ++d) {
    if (from.x + kMoves[d].dx == to.x && from.y + kMoves[d].dy == to.y) {
      moves_[index_of(from)] &= static_cast<std::uint8_t>(~(1U << d));
    }
    if (to.x + kMoves[d].dx == from.x && to.y + kMoves[d].dy == from.y) {
      moves_[index_of(to)] &= static_cast<std::uint8_t>(~(1U << d));
    }
  }
}

}  // namespace rovigo::planning
