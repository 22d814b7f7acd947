#include "planning/any_angle_search.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "planning/move_order.h"

namespace rovigo::planning {

namespace {

constexpr float kNever = std::numeric_limits<float>::infinity();
constexpr float kSqrt2 = 1.41421356F;
constexpr std::uint32_t kConfirmed = std::uint32_t{1} << 31;
constexpr float kBucketsPerCell = 8.0F;
/// A label rises by at most twice a diagonal step, when a cell is offered and when it is confirmed.
constexpr std::size_t kRing = 64;

float straight_length(maps::Cell a, maps::Cell b) {
  const auto dx = static_cast<float>(a.x - b.x), dy = static_cast<float>(a.y - b.y);
  return std::sqrt(dx * dx + dy * dy);
}

}  // namespace

bool line_of_sight(const SearchGrid& grid, maps::Cell from, maps::Cell to) {
  if (!grid.is_passable(from) || !grid.is_passable(to)) return false;
  const int nx = std::abs(to.x - from.x), ny = std::abs(to.y - from.y);
  const unsigned along_x = to.x > from.x ? 1U : 2U, along_y = to.y > from.y ? 4U : 8U;
  const int step_x = to.x > from.x ? 1 : -1;
  const int step_y = to.y > from.y ? grid.stride() : -grid.stride();
  const std::uint8_t* moves = grid.moves() + grid.index_of(from);
  // Which border does the line cross first: beyond[x] * ny against beyond[y] * nx.
  std::int64_t ahead = std::int64_t{ny} - nx;
  for (int x = 0, y = 0; x < nx || y < ny;) {
    if (ahead < 0) {
      if ((*moves & along_x) == 0) return false;
      moves += step_x;
      ahead += 2 * std::int64_t{ny};
      ++x;
    } else if (ahead > 0) {
      if ((*moves & along_y) == 0) return false;
      moves += step_y;
      ahead -= 2 * std::int64_t{nx};
      ++y;
    } else {
      if ((*moves & along_x) == 0 || (*moves & along_y) == 0) return false;
      if ((moves[step_x] & along_y) == 0 || (moves[step_y] & along_x) == 0) return false;
      moves += step_x + step_y;
      ahead += 2 * (std::int64_t{ny} - nx);
      ++x, ++y;
    }
  }
  return true;
}

/// One search: what does not change while it runs, and what it counts.
struct AnyAngleSearch::Query {
  const SearchGrid& grid;
  const LineTest& also_free;
  std::uint32_t start = 0;
  std::uint32_t goal = 0;
  maps::Cell goal_cell;
  float best = kNever;  ///< length to the goal once it is confirmed
  std::size_t bucket = 0;
  std::size_t waiting = 0;
  std::size_t expanded = 0;

  float heuristic(std::uint32_t cell) const {
    return straight_length(grid.cell_of(cell), goal_cell);
  }
  bool is_free(std::uint32_t from, std::uint32_t to) const {
    const maps::Cell a = grid.cell_of(from), b = grid.cell_of(to);
    return line_of_sight(grid, a, b) && (!also_free || also_free(a, b));
  }
};

void AnyAngleSearch::prepare(const SearchGrid& grid) {
  for (const std::uint32_t cell : touched_) length_[cell] = kNever;
  touched_.clear();
  if (length_.size() != grid.padded_size()) {
    length_.assign(grid.padded_size(), kNever);
    parent_.resize(grid.padded_size());
  }
  buckets_.resize(kRing);
  for (auto& bucket : buckets_) bucket.clear();
}

GridSearchResult AnyAngleSearch::find(const SearchGrid& grid, maps::Cell start, maps::Cell goal,
                                      const LineTest& also_free) {
  if (!grid.is_passable(start) || !grid.is_passable(goal)) return {};
  prepare(grid);
  Query query{.grid = grid,
              .also_free = also_free,
              .start = grid.index_of(start),
              .goal = grid.index_of(goal),
              .goal_cell = goal};
  if (!run(query)) return {.expanded_cells = query.expanded};
  return collect(query);
}

bool AnyAngleSearch::run(Query& query) {
  query.bucket = static_cast<std::size_t>(query.heuristic(query.start) * kBucketsPerCell);
  set(query, query.start, query.start, 0.0F, true);
  while (query.waiting > 0) {
    auto& open = buckets_[query.bucket % kRing];
    if (open.empty()) {
      ++query.bucket;
      continue;
    }
    if (static_cast<float>(query.bucket) >= query.best * kBucketsPerCell) break;
    const Entry entry = open.back();
    open.pop_back();
    --query.waiting;
    if (entry.length != length_[entry.cell]) continue;  // improved since
    if (entry.length + query.heuristic(entry.cell) >= query.best) continue;
    if ((parent_[entry.cell] & kConfirmed) == 0 && !confirm(query, entry.cell)) {
      // Longer than thought: it waits for its new turn.
      set(query, entry.cell, parent_[entry.cell] & ~kConfirmed, length_[entry.cell], true);
      continue;
    }
    if (entry.cell == query.goal) {
      query.best = std::min(query.best, length_[query.goal]);
    } else {
      expand(query, entry.cell);
    }
  }
  return query.best != kNever;
}

/// Confirms the line to the parent, or else takes the best neighbour for a parent: there is one,
/// the cell that made the offer. False when that made the way longer.
bool AnyAngleSearch::confirm(const Query& query, std::uint32_t cell) {
  const std::uint32_t parent = parent_[cell];
  if (query.is_free(parent, cell)) {
    parent_[cell] = parent | kConfirmed;
    return true;
  }
  length_[cell] = kNever;
  const auto offsets = query.grid.offsets();
  for_each_move(query.grid.moves()[cell], [&](std::size_t move) {
    const auto next = static_cast<std::uint32_t>(static_cast<int>(cell) + offsets[move]);
    if (length_[next] == kNever || (parent_[next] & kConfirmed) == 0) return;
    const float length = length_[next] + (move < kStraightMoves ? 1.0F : kSqrt2);
    if (length >= length_[cell]) return;
    length_[cell] = length;
    parent_[cell] = next | kConfirmed;
  });
  return false;
}

void AnyAngleSearch::expand(Query& query, std::uint32_t cell) {
  ++query.expanded;
  const auto offsets = query.grid.offsets();
  for_each_move(query.grid.moves()[cell], [&](std::size_t move) {
    const auto next = static_cast<std::uint32_t>(static_cast<int>(cell) + offsets[move]);
    offer(query, cell, next, move < kStraightMoves ? 1.0F : kSqrt2);
  });
}

/// Offers `to`, a move of length `step` away, the way through `from`: from the parent of `from`
/// straight, where that is free.
void AnyAngleSearch::offer(Query& query, std::uint32_t from, std::uint32_t to, float step) {
  const std::uint32_t parent = parent_[from] & ~kConfirmed;
  const float straight =
      length_[parent] + straight_length(query.grid.cell_of(parent), query.grid.cell_of(to));
  if (straight >= length_[to]) return;
  // What is confirmed stays so, because other ways rest on it.
  const bool settled = length_[to] != kNever && (parent_[to] & kConfirmed) != 0;
  if (parent == from) return set(query, to, from, straight, true);
  if (!settled) return set(query, to, parent, straight, false);
  if (query.is_free(parent, to)) return set(query, to, parent, straight, true);
  if (length_[from] + step < length_[to]) set(query, to, from, length_[from] + step, true);
}

void AnyAngleSearch::set(Query& query, std::uint32_t cell, std::uint32_t parent, float length,
                         bool confirmed) {
  const float total = length + query.heuristic(cell);
  if (length_[cell] == kNever) touched_.push_back(cell);
  length_[cell] = length;
  parent_[cell] = parent | (confirmed ? kConfirmed : 0U);
  if (total >= query.best) return;
  const auto due = std::max(query.bucket, static_cast<std::size_t>(total * kBucketsPerCell));
  buckets_[due % kRing].push_back({cell, length});
  ++query.waiting;
}

GridSearchResult AnyAngleSearch::collect(const Query& query) const {
  GridSearchResult result{.found = true, .expanded_cells = query.expanded};
  double length = 0.0;
  std::uint32_t cell = query.goal;
  result.cells.push_back(query.goal_cell);
  while (cell != query.start) {
    cell = parent_[cell] & ~kConfirmed;
    const maps::Cell at = query.grid.cell_of(cell), last = result.cells.back();
    length += std::hypot(at.x - last.x, at.y - last.y);
    result.cells.push_back(at);
  }
  std::reverse(result.cells.begin(), result.cells.end());
  result.length_m = length * query.grid.geometry().resolution_m;
  result.cost_m = result.length_m;
  return result;
}

std::size_t AnyAngleSearch::memory_bytes() const {
  std::size_t bytes = length_.capacity() * sizeof(float) +
                      (parent_.capacity() + touched_.capacity()) * sizeof(std::uint32_t);
  for (const auto& bucket : buckets_) bytes += bucket.capacity() * sizeof(Entry);
  return bytes;
}

}  // namespace rovigo::planning
