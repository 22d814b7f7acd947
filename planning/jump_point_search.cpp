#include "planning/jump_point_search.h"

#include <algorithm>
#include <cmath>

#include "planning/descent.h"

namespace rovigo::planning {

namespace {

constexpr std::uint32_t kMoveShift = 29;  // three bits for a move, the others for a cell
constexpr std::uint32_t kCellMask = (std::uint32_t{1} << kMoveShift) - 1;
constexpr std::uint32_t kStepsAtOnce = 30;
constexpr std::uint32_t kArrived = kUnreached;
constexpr std::uint32_t kCostLimit = kUnreached / 2;
constexpr double kSqrt2 = 1.41421356237309504880;

/// The straight moves that a diagonal one is made of: along x, along y.
constexpr std::size_t along_x(std::size_t diagonal) { return kMoves[diagonal].dx > 0 ? 0 : 1; }
constexpr std::size_t along_y(std::size_t diagonal) { return kMoves[diagonal].dy > 0 ? 2 : 3; }
constexpr std::size_t diagonal_of(int dx, int dy) {
  return (dy > 0 ? 4U : 6U) + (dx > 0 ? 0U : 1U);
}

}  // namespace

struct JumpPointSearch::Query {
  maps::Cell start, goal;
  StepScale scale{};
  std::size_t expanded = 0;
  std::uint32_t from = 0;   ///< the jump point being expanded
  std::uint32_t total = 0;  ///< cost plus heuristic that are due
  bool overflow = false;
};

JumpPointSearch::JumpPointSearch(const SearchGrid& grid)
    : grid_(grid),
      geometry_(grid.geometry()),
      rows_(geometry_.width, geometry_.height),
      columns_(geometry_.height, geometry_.width) {
  for (int y = 0; y < geometry_.height; ++y) {
    for (int x = 0; x < geometry_.width; ++x) {
      if (!grid.is_passable({x, y})) continue;
      rows_.open(x, y);
      columns_.open(y, x);
    }
  }
  rows_.find_stops();
  columns_.find_stops();
}

std::size_t JumpPointSearch::memory_bytes() const {
  return rows_.memory_bytes() + columns_.memory_bytes() + labels_.memory_bytes() +
         sizeof(Entry) * open_.capacity();
}

GridSearchResult JumpPointSearch::find(maps::Cell start, maps::Cell goal) {
  GridSearchResult result;
  if (!geometry_.contains(start) || !geometry_.contains(goal) || !is_open(start.x, start.y) ||
      !is_open(goal.x, goal.y)) {
    return result;
  }
  for (const StepScale& scale : kStepScales) {
    labels_.clear();
    open_.clear();
    Query query{.start = start, .goal = goal, .scale = scale};
    result.found = run(query);
    result.expanded_cells = query.expanded;
    if (query.overflow) continue;
    if (!result.found) return result;
    result.cost_m = static_cast<double>(labels_.find(index_of(goal))->cost) / scale.straight *
                    geometry_.resolution_m;
    collect_path(query, result);
    return result;
  }
  result.found = false;
  return result;
}

bool JumpPointSearch::run(Query& query) {
  const std::uint32_t goal = index_of(query.goal);
  const std::uint32_t start = index_of(query.start);
  labels_.set({start, 0, start});
  if (start == goal) return true;
  query.from = start;
  query.total = query.scale.octile(query.start.x - query.goal.x, query.start.y - query.goal.y);
  ++query.expanded;
  for (std::size_t move = 0; move < kStraightMoves; ++move)
    go_straight(query, query.start, 0, move);
  for (std::size_t move = kStraightMoves; move < kMoves.size(); ++move) {
    go_diagonal(query, query.start, 0, move, query.total);
  }
  while (!open_.empty() && !query.overflow) {
    std::pop_heap(open_.begin(), open_.end());
    const Entry entry = open_.back();
    open_.pop_back();
    query.total = entry.total;
    if (entry.run != kArrived) {
      query.from = entry.run & kCellMask;
      // Waiting costs time, too: from here on it goes some way at once.
      go_diagonal(query, cell_of(entry.cell), entry.cost, entry.run >> kMoveShift,
                  query.total + kStepsAtOnce * query.scale.straight);
      continue;
    }
    if (entry.cost != labels_.find(entry.cell)->cost) continue;  // improved since
    if (entry.cell == goal) return true;
    ++query.expanded;
    query.from = entry.cell;
    expand(query, entry.cell);
  }
  return false;
}

/// A jump point reached by a straight run: on, and round the corners that end beside it.
void JumpPointSearch::expand(Query& query, std::uint32_t index) {
  const maps::Cell at = cell_of(index);
  const LabelTable::Label label = *labels_.find(index);
  const std::uint32_t cost = label.cost;
  const std::size_t move = label.before >> kMoveShift;
  const Move& m = kMoves[move];
  go_straight(query, at, cost, move);
  for (const int side : {1, -1}) {
    const int sx = m.dx == 0 ? side : 0, sy = m.dy == 0 ? side : 0;
    const bool opens =
        is_open(at.x + sx, at.y + sy) && !is_open(at.x + sx - m.dx, at.y + sy - m.dy);
    if (!opens) continue;
    go_straight(query, at, cost, sx > 0 ? 0 : sx < 0 ? 1 : sy > 0 ? 2 : 3);
    go_diagonal(query, at, cost, diagonal_of(m.dx + sx, m.dy + sy), query.total);
  }
}

void JumpPointSearch::go_straight(Query& query, maps::Cell from, std::uint32_t cost,
                                  std::size_t move) {
  const bool is_row = move < 2;
  const BitRows& lines = is_row ? rows_ : columns_;
  const int at = is_row ? from.x : from.y;
  const int line = is_row ? from.y : from.x;
  const bool up = move % 2 == 0;
  const BitRows::Stop stop = up ? lines.run_up(at, line) : lines.run_down(at, line);
  const int goal_at = is_row ? query.goal.x : query.goal.y;
  const int goal_line = is_row ? query.goal.y : query.goal.x;
  int end = stop.at;
  if (goal_line == line &&
      (up ? goal_at > at && goal_at < stop.at : goal_at < at && goal_at > stop.at)) {
    end = goal_at;
  } else if (!stop.passable) {
    return;
  }
  const auto steps = static_cast<std::uint32_t>(std::abs(end - at));
  const maps::Cell cell = is_row ? maps::Cell{end, line} : maps::Cell{line, end};
  reach(query, cell, cost + steps * query.scale.straight, move);
}

/// Leaps along a diagonal: what it meets on the way is where the straight runs beside it end. No
/// way through a cell is cheaper than the cell's total, so the run waits where that is above
/// `last_due`.
void JumpPointSearch::go_diagonal(Query& query, maps::Cell at, std::uint32_t cost, std::size_t move,
                                  std::uint32_t last_due) {
  const Move& m = kMoves[move];
  const auto goes_on = [&] {
    return is_open(at.x + m.dx, at.y) && is_open(at.x, at.y + m.dy) &&
           is_open(at.x + m.dx, at.y + m.dy);
  };
  while (goes_on()) {
    const maps::Cell next{at.x + m.dx, at.y + m.dy};
    const std::uint32_t next_cost = cost + query.scale.diagonal;
    const std::uint32_t total =
        next_cost + query.scale.octile(next.x - query.goal.x, next.y - query.goal.y);
    if (total > last_due) {
      open_.push_back(
          {total, cost, index_of(at), query.from | static_cast<std::uint32_t>(move) << kMoveShift});
      std::push_heap(open_.begin(), open_.end());
      return;
    }
    at = next;
    cost = next_cost;
    if (at == query.goal) {
      reach(query, at, cost, move);
      return;
    }
    go_straight(query, at, cost, along_x(move));
    go_straight(query, at, cost, along_y(move));
  }
}

void JumpPointSearch::reach(Query& query, maps::Cell cell, std::uint32_t cost, std::size_t move) {
  if (cost > kCostLimit) {
    query.overflow = true;
    return;
  }
  const std::uint32_t index = index_of(cell);
  const LabelTable::Label* known = labels_.find(index);
  if (known != nullptr && cost >= known->cost) return;
  labels_.set({index, cost, query.from | static_cast<std::uint32_t>(move) << kMoveShift});
  const std::uint32_t total =
      cost + query.scale.octile(cell.x - query.goal.x, cell.y - query.goal.y);
  open_.push_back({total, cost, index, kArrived});
  std::push_heap(open_.begin(), open_.end());
}

void JumpPointSearch::collect_path(const Query& query, GridSearchResult& result) const {
  const std::uint32_t start = index_of(query.start);
  const auto before = [&](std::uint32_t index) { return labels_.find(index)->before & kCellMask; };
  std::size_t steps = 0, diagonal_steps = 0;
  maps::Cell at = query.goal;
  for (std::uint32_t i = index_of(query.goal); i != start; i = before(i)) {
    const maps::Cell from = cell_of(before(i));
    steps += static_cast<std::size_t>(std::max(std::abs(from.x - at.x), std::abs(from.y - at.y)));
    at = from;
  }
  result.cells.resize(steps + 1);
  auto out = result.cells.rbegin();
  *out++ = at = query.goal;
  for (std::uint32_t i = index_of(query.goal); i != start; i = before(i)) {
    const maps::Cell from = cell_of(before(i));
    const int dx = from.x - at.x, dy = from.y - at.y;
    const int nx = std::abs(dx), ny = std::abs(dy), diagonal = std::min(nx, ny);
    const int step_x = dx > 0 ? 1 : -1, step_y = dy > 0 ? 1 : -1;
    // Backwards: first the straight run, then the diagonal one.
    for (int k = diagonal; k < nx; ++k) *out++ = {at.x += step_x, at.y};
    for (int k = diagonal; k < ny; ++k) *out++ = {at.x, at.y += step_y};
    for (int k = 0; k < diagonal; ++k) *out++ = {at.x += step_x, at.y += step_y};
    diagonal_steps += static_cast<std::size_t>(diagonal);
  }
  result.length_m = geometry_.resolution_m * (static_cast<double>(steps - diagonal_steps) +
                                              kSqrt2 * static_cast<double>(diagonal_steps));
}

}  // namespace rovigo::planning
