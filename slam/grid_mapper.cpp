#include "slam/grid_mapper.h"

#include <algorithm>
#include <cmath>

#include "slam/overhang.h"

namespace rovigo::slam {

namespace {

constexpr int kOccupiedSteps = 8;  // log-odds 0.5: far surfaces, rarely seen, are obstacles too
// Where something moved, what may be its standing leg is an obstacle only after several looks.
constexpr int kOccupiedAmidMotionSteps = 24;
constexpr int kFreeSteps = -5;
constexpr int kHiddenShare = 4;   // a level crossed so much less often than those around it hides
constexpr int kMostCells = 8000;  // a side
constexpr int kStripRows = 64;

struct Box {
  double x0 = 1e9, y0 = 1e9, x1 = -1e9, y1 = -1e9;
  void add(const TPoint2D& p) {
    x0 = std::min(x0, p.x);
    y0 = std::min(y0, p.y);
    x1 = std::max(x1, p.x);
    y1 = std::max(y1, p.y);
  }
};

/// A patch with its tiles laid out for looking up, and the part of the map it covers.
class Layer {
 public:
  Layer(const PlacedPatch& placed, double resolution_m)
      : patch_from_map_(maps::inverse(placed.map_from_patch)), resolution_m_(resolution_m) {
    constexpr int kSide = EvidencePatch::kTileSide;
    if (placed.patch->tiles().empty()) return;
    EvidencePatch::TileIndex last{};
    first_ = last = placed.patch->tiles().begin()->first;
    for (const auto& [i, tile] : placed.patch->tiles()) {
      first_ = {std::min(first_.y, i.y), std::min(first_.x, i.x)};
      last = {std::max(last.y, i.y), std::max(last.x, i.x)};
    }
    across_ = last.x - first_.x + 1;
    down_ = last.y - first_.y + 1;
    tiles_.resize(static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_));
    for (const auto& [i, tile] : placed.patch->tiles()) {
      tiles_[static_cast<std::size_t>((i.y - first_.y) * across_ + i.x - first_.x)] = {
          &tile, placed.patch->is_doubted(i)};
    }
    for (const int y : {first_.y * kSide, (last.y + 1) * kSide}) {
      for (const int x : {first_.x * kSide, (last.x + 1) * kSide}) {
        box_.add(maps::transform(placed.map_from_patch, {x * resolution_m, y * resolution_m}));
      }
    }
  }

  const Box& box() const { return box_; }

  /// The evidence of the cell that holds a point of the map, and whether something moved there.
  struct Evidence {
    const CellEvidence* bands = nullptr;  ///< null: none
    bool doubted = false;
  };
  Evidence at(const TPoint2D& in_map) const {
    constexpr int kSide = EvidencePatch::kTileSide;
    const TPoint2D p = maps::transform(patch_from_map_, in_map);
    const int x = static_cast<int>(std::floor(p.x / resolution_m_)) - first_.x * kSide;
    const int y = static_cast<int>(std::floor(p.y / resolution_m_)) - first_.y * kSide;
    if (x < 0 || y < 0 || x >= across_ * kSide || y >= down_ * kSide) return {};
    const LaidTile& laid = tiles_[static_cast<std::size_t>((y / kSide) * across_ + x / kSide)];
    if (laid.tile == nullptr) return {};
    return {&(*laid.tile)[static_cast<std::size_t>((y % kSide) * kSide + x % kSide)], laid.doubted};
  }

 private:
  TPose2D patch_from_map_;
  double resolution_m_;
  EvidencePatch::TileIndex first_{};
  int across_ = 0, down_ = 0;
  struct LaidTile {
    const EvidencePatch::Tile* tile = nullptr;
    bool doubted = false;
  };
  std::vector<LaidTile> tiles_;
  Box box_;
};

maps::GridGeometry geometry_of(const std::vector<Layer>& layers, double resolution_m) {
  Box box;
  for (const Layer& l : layers) {
    if (l.box().x1 < l.box().x0) continue;
    box.add({l.box().x0, l.box().y0});
    box.add({l.box().x1, l.box().y1});
  }
  if (box.x1 < box.x0) box = {-0.5, -0.5, 0.5, 0.5};
  // Whole multiples of the resolution, so that maps of one place line up cell by cell, and patches
  // that were not moved are copied as they are.
  const double r = resolution_m;
  maps::GridGeometry g;
  g.resolution_m = r;
  g.origin = {std::floor(box.x0 / r + 0.01) * r, std::floor(box.y0 / r + 0.01) * r};
  const auto cells = [&](double from, double to) {
    return std::clamp(static_cast<int>(std::ceil((to - from) / r - 0.01)), 1, kMostCells);
  };
  g.width = cells(g.origin.x, box.x1);
  g.height = cells(g.origin.y, box.y1);
  return g;
}

struct CellSums {
  std::array<std::int32_t, kHeightBands> bands{};
  bool doubted = false;
};

/// Adds one layer to rows [y0, y1) of the grid.
void add_layer(const Layer& layer, const maps::GridGeometry& g, int y0, int y1,
               std::vector<CellSums>& sums) {
  const double r = g.resolution_m;
  const auto cell = [&](double at, double origin) {
    return static_cast<int>(std::floor((at - origin) / r));
  };
  const int x_begin = std::max(0, cell(layer.box().x0, g.origin.x));
  const int x_end = std::min(g.width, cell(layer.box().x1, g.origin.x) + 1);
  const int y_begin = std::max(y0, cell(layer.box().y0, g.origin.y));
  const int y_end = std::min(y1, cell(layer.box().y1, g.origin.y) + 1);
  for (int y = y_begin; y < y_end; ++y) {
    for (int x = x_begin; x < x_end; ++x) {
      const Layer::Evidence e = layer.at(g.center_of({x, y}));
      if (e.bands == nullptr) continue;
      CellSums& sum = sums[static_cast<std::size_t>(y - y0) * static_cast<std::size_t>(g.width) +
                           static_cast<std::size_t>(x)];
      for (std::size_t b = 0; b < sum.bands.size(); ++b) sum.bands[b] += (*e.bands)[b];
      sum.doubted = sum.doubted || e.doubted;
    }
  }
}

std::int8_t percent(double steps) {
  const double p = 1.0 - 1.0 / (1.0 + std::exp(std::clamp(steps / kStepsPerLogOdds, -6.0, 6.0)));
  return static_cast<std::int8_t>(std::lround(100.0 * p));
}

/// Crossed, but hardly ever where rays keep passing both below and above: something level is in the
/// way, thinner than what the heights of rays far away tell.
bool hides_a_top(const std::array<std::int32_t, kHeightBands>& sums, std::size_t band) {
  const auto at = sums.begin() + static_cast<std::ptrdiff_t>(band);
  if (band == 0 || at + 1 == sums.end()) return false;
  const int below = *std::min_element(sums.begin(), at);
  const int above = *std::min_element(at + 1, sums.end());
  return kHiddenShare * *at > std::max(below, above);
}

std::int8_t decide(const CellSums& cell, CellBands& bands) {
  const auto& sums = cell.bands;
  const int enough = cell.doubted ? kOccupiedAmidMotionSteps : kOccupiedSteps;
  for (std::size_t b = 0; b < sums.size(); ++b) {
    if (sums[b] >= enough) bands.occupied |= static_cast<std::uint16_t>(1U << b);
    if (sums[b] <= kFreeSteps && !hides_a_top(sums, b)) {
      bands.free |= static_cast<std::uint16_t>(1U << b);
    }
  }
  // What is decided lies beyond map_server's thresholds (0.65 and 0.196), however little evidence
  // decided it.
  if (bands.occupied != 0) {
    return std::max<std::int8_t>(percent(*std::max_element(sums.begin(), sums.end())), 65);
  }
  if ((bands.free & kUpperBands) != kUpperBands) return maps::OccupancyGrid::kUnknown;
  const auto worst = *std::max_element(sums.begin() + kHeightBands / 2, sums.end());
  return std::min<std::int8_t>(percent(worst), 19);
}

}  // namespace

maps::OccupancyGrid render_grid(const std::vector<PlacedPatch>& patches, const GridConfig& config) {
  std::vector<Layer> layers;
  layers.reserve(patches.size());
  for (const PlacedPatch& p : patches) layers.emplace_back(p, config.grid_resolution_m);
  maps::OccupancyGrid grid(geometry_of(layers, config.grid_resolution_m));
  const maps::GridGeometry& g = grid.geometry;
  std::vector<CellBands> bands(g.size());
  std::vector<CellSums> sums;
  for (int y0 = 0; y0 < g.height; y0 += kStripRows) {
    const int y1 = std::min(g.height, y0 + kStripRows);
    sums.assign(static_cast<std::size_t>(y1 - y0) * static_cast<std::size_t>(g.width), CellSums{});
    for (const Layer& layer : layers) add_layer(layer, g, y0, y1, sums);
    const std::size_t first = g.index_of({0, y0});
    for (std::size_t i = 0; i < sums.size(); ++i) {
      grid.cells[first + i] = decide(sums[i], bands[first + i]);
    }
  }
  fill_overhangs(bands, grid);
  return grid;
}

}  // namespace rovigo::slam
