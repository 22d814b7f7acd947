#include "maps/squared_distance.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "maps/error.h"

namespace rovigo::maps {
namespace {

constexpr std::int16_t kFar = kMaxGridSide;

/// Squared half cells between a centre and the edge of a cell `cells` further on.
std::int64_t squared_reach(std::int64_t cells) {
  const std::int64_t half_cells = cells == 0 ? 0 : 2 * std::abs(cells) - 1;
  return half_cells * half_cells;
}

/// floor(a / b) for b > 0.
std::int64_t floor_div(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0); }

/// Cells to the nearest obstacle in the same column, for every cell; kFar for none.
std::vector<std::int16_t> column_distances(const OccupancyGrid& grid) {
  const auto width = static_cast<std::size_t>(grid.geometry.width);
  const auto height = static_cast<std::size_t>(grid.geometry.height);
  std::vector<std::int16_t> distances(grid.geometry.size());
  const auto closer = [](std::int16_t a, std::int16_t b) {
    return std::min(a, static_cast<std::int16_t>(std::min<std::int16_t>(b, kFar - 1) + 1));
  };
  for (std::size_t y = 0; y < height; ++y) {
    const std::int8_t* cells = grid.cells.data() + y * width;
    std::int16_t* here = distances.data() + y * width;
    for (std::size_t x = 0; x < width; ++x) {
      here[x] = cells[x] >= OccupancyGrid::kOccupiedThreshold ? std::int16_t{0} : kFar;
    }
    if (y == 0) continue;
    const std::int16_t* below = here - width;
    for (std::size_t x = 0; x < width; ++x) here[x] = closer(here[x], below[x]);
  }
  for (std::size_t y = height; y-- > 1;) {
    const std::int16_t* here = distances.data() + y * width;
    std::int16_t* below = distances.data() + (y - 1) * width;
    for (std::size_t x = 0; x < width; ++x) below[x] = closer(below[x], here[x]);
  }
  return distances;
}

/// First column where an obstacle `later_along` off in column `later` is strictly nearer than one
/// `earlier_along` off in column `earlier` < `later`. The difference of the two distances grows
/// with the column, so there is one crossing; the closed form depends on which side of the two
/// columns it lies, because the reach is 0 in the obstacle's own column and not -1.
std::int64_t first_nearer(std::int64_t earlier, std::int64_t earlier_along, std::int64_t later,
                          std::int64_t later_along) {
  const std::int64_t gap = later - earlier;
  const std::int64_t advantage = later_along - earlier_along;  // of the earlier one
  if (squared_reach(gap) <= advantage) {  // the earlier one still holds in column `later`
    return std::max(floor_div(floor_div(advantage, 4 * gap) + earlier + later + 1, 2) + 1,
                    later + 1);
  }
  if (-squared_reach(gap) > advantage) {  // the later one already holds in column `earlier`
    return std::min(floor_div(floor_div(advantage, 4 * gap) + earlier + later - 1, 2) + 1, earlier);
  }
  if (gap == 1) return later;
  const std::int64_t between = floor_div(floor_div(advantage, 4 * (gap - 1)) + earlier + later, 2);
  return std::clamp(between + 1, earlier + 1, later);
}

}  // namespace

SquaredDistanceTransform::SquaredDistanceTransform(const OccupancyGrid& grid,
                                                   double limit_half_cells)
    : width_(grid.geometry.width) {
  if (grid.geometry.width > kMaxGridSide || grid.geometry.height > kMaxGridSide) {
    throw InputError("the grid has " + std::to_string(grid.geometry.width) + " x " +
                     std::to_string(grid.geometry.height) + " cells; a side of at most " +
                     std::to_string(kMaxGridSide) + " can be handled");
  }
  limit_cells_ = static_cast<int>(std::min(std::floor(limit_half_cells / 2.0) + 1.0, kFar - 1.0));
  column_ = column_distances(grid);
  envelope_.reserve(static_cast<std::size_t>(width_));
  row_.resize(static_cast<std::size_t>(width_));
}

void SquaredDistanceTransform::build_envelope(int y) {
  const std::int16_t* column =
      column_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
  envelope_.clear();
  for (int x = 0; x < width_; ++x) {
    if (column[x] > limit_cells_) continue;
    const std::int64_t along = squared_reach(column[x]);
    while (!envelope_.empty()) {
      const Site& top = envelope_.back();
      if (squared_reach(top.first - top.column) + top.along <=
          squared_reach(top.first - x) + along) {
        break;
      }
      envelope_.pop_back();
    }
    std::int64_t first = 0;
    if (!envelope_.empty()) {
      const Site& top = envelope_.back();
      first = first_nearer(top.column, top.along, x, along);
    }
    if (first < width_) envelope_.push_back({x, static_cast<int>(first), along});
  }
}

const std::vector<std::int64_t>& SquaredDistanceTransform::row(int y) {
  build_envelope(y);
  if (envelope_.empty()) {
    std::fill(row_.begin(), row_.end(), kNone);
    return row_;
  }
  for (std::size_t i = 0; i < envelope_.size(); ++i) {
    const Site& site = envelope_[i];
    const int end = i + 1 < envelope_.size() ? envelope_[i + 1].first : width_;
    for (int x = site.first; x < end; ++x) {
      row_[static_cast<std::size_t>(x)] = squared_reach(x - site.column) + site.along;
    }
  }
  return row_;
}

}  // namespace rovigo::maps
