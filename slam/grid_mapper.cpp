#include "slam/grid_mapper.h"

#include <algorithm>
#include <cmath>

namespace rovigo::slam {

namespace {

constexpr double kHit = 0.9;     // log-odds of a hit close by
constexpr double kMiss = 0.35;   // and of a ray passing
constexpr double kBlindM = 0.7;  // nearer than this the camera sees over low things
constexpr double kBlindMiss = 0.1;
constexpr double kDriven = 1.0;
constexpr double kLimit = 6.0;             // so that the world may change its mind
constexpr double kOccupiedLogOdds = 0.62;  // 65%
constexpr double kFreeLogOdds = -0.3;
constexpr int kMostCells = 8000;  // a side

struct Box {
  double x0 = 1e9, y0 = 1e9, x1 = -1e9, y1 = -1e9;
  void add(const TPoint2D& p, double margin) {
    x0 = std::min(x0, p.x - margin);
    y0 = std::min(y0, p.y - margin);
    x1 = std::max(x1, p.x + margin);
    y1 = std::max(y1, p.y + margin);
  }
};

TPoint2D point_of(const PlacedScan& placed, double direction, double range) {
  const DepthScan& s = *placed.scan;
  const double a = s.first_direction_rad + direction * s.direction_step_rad;
  return maps::transform(placed.map_from_level,
                         {s.origin.x() + range * std::cos(a), s.origin.y() + range * std::sin(a)});
}

maps::GridGeometry geometry_of(const GridRequest& request, const GridConfig& config) {
  Box box;
  for (const PlacedScan& p : request.scans) {
    box.add(maps::position_of(p.map_from_level), 0.3);
    for (std::size_t d = 0; d < p.scan->clear_m.size(); d += 4) {
      box.add(point_of(p, static_cast<double>(d), p.scan->clear_m[d]), 0.3);
    }
    for (const ScanHit& h : p.scan->hits) box.add(point_of(p, h.direction, h.range_m), 0.3);
  }
  for (const TPose2D& pose : request.driven) box.add(maps::position_of(pose), 0.5);
  if (box.x1 < box.x0) box.add({0, 0}, 0.5);
  const double r = config.grid_resolution_m;
  maps::GridGeometry g;
  g.resolution_m = r;
  // Whole multiples of the resolution, so that maps of one place line up cell by cell.
  g.origin = {std::floor(box.x0 / r) * r, std::floor(box.y0 / r) * r};
  g.width = std::clamp(static_cast<int>(std::ceil((box.x1 - g.origin.x) / r)), 1, kMostCells);
  g.height = std::clamp(static_cast<int>(std::ceil((box.y1 - g.origin.y) / r)), 1, kMostCells);
  return g;
}

/// Adds up evidence; within one scan each cell counts once, and hits before misses.
class Evidence {
 public:
  explicit Evidence(const maps::GridGeometry& g)
      : geometry_(g), log_odds_(g.size(), 0.0f), seen_(g.size(), 0), stamp_(g.size(), 0) {}

  void add(const PlacedScan& placed) {
    ++scan_;
    for (const ScanHit& h : placed.scan->hits) {
      // A far hit may lie in the next cell: it counts for less.
      const double trust = 1.0 / (1.0 + std::pow(h.range_m / 3.0, 2));
      const double many = std::min(1.0, 0.25 * h.pixels);
      mark(geometry_.cell_at(point_of(placed, h.direction, h.range_m)),
           kHit * std::max(0.3, trust) * many * 1.3);
    }
    const TPoint2D eye = point_of(placed, 0, 0);
    for (std::size_t d = 0; d < placed.scan->clear_m.size(); ++d) {
      clear_ray(eye, point_of(placed, static_cast<double>(d), placed.scan->clear_m[d]));
    }
  }

  void add_driven(const TPose2D& pose, double radius_m) {
    const maps::Cell c = geometry_.cell_at(maps::position_of(pose));
    const int n = static_cast<int>(std::ceil(radius_m / geometry_.resolution_m));
    ++scan_;
    for (int dy = -n; dy <= n; ++dy) {
      for (int dx = -n; dx <= n; ++dx) {
        const maps::Cell cell{c.x + dx, c.y + dy};
        if (!geometry_.contains(cell)) continue;
        if (maps::distance(geometry_.center_of(cell), maps::position_of(pose)) <= radius_m) {
          mark(cell, -kDriven);
        }
      }
    }
  }

  maps::OccupancyGrid grid() const {
    maps::OccupancyGrid out(geometry_);
    for (std::size_t i = 0; i < log_odds_.size(); ++i) {
      const double l = log_odds_[i];
      if (!seen_[i] || (l > kFreeLogOdds && l < kOccupiedLogOdds)) continue;
      const double p = 1.0 - 1.0 / (1.0 + std::exp(l));
      out.cells[i] = static_cast<std::int8_t>(std::lround(100.0 * p));
    }
    return out;
  }

 private:
  void mark(maps::Cell cell, double amount) {
    if (!geometry_.contains(cell)) return;
    const std::size_t i = geometry_.index_of(cell);
    if (stamp_[i] == scan_) return;
    stamp_[i] = scan_;
    seen_[i] = 1;
    log_odds_[i] = static_cast<float>(std::clamp(log_odds_[i] + amount, -kLimit, kLimit));
  }

  void clear_ray(const TPoint2D& from, const TPoint2D& to) {
    const double length = maps::distance(from, to);
    const int steps = static_cast<int>(length / (0.5 * geometry_.resolution_m));
    if (steps < 1) return;
    const double dx = (to.x - from.x) / length, dy = (to.y - from.y) / length;
    // The last cell is left alone: what stopped the ray may reach into it.
    const double end = length - 0.7 * geometry_.resolution_m;
    for (int i = 0; i <= steps; ++i) {
      const double r = 0.5 * geometry_.resolution_m * i;
      if (r > end) break;
      mark(geometry_.cell_at({from.x + r * dx, from.y + r * dy}),
           r < kBlindM ? -kBlindMiss : -kMiss);
    }
  }

  maps::GridGeometry geometry_;
  std::vector<float> log_odds_;
  std::vector<std::uint8_t> seen_;
  std::vector<std::uint32_t> stamp_;
  std::uint32_t scan_ = 0;
};

}  // namespace

maps::OccupancyGrid render_grid(const GridRequest& request, const GridConfig& config) {
  Evidence evidence(geometry_of(request, config));
  for (const PlacedScan& placed : request.scans) evidence.add(placed);
  for (const TPose2D& pose : request.driven) evidence.add_driven(pose, request.driven_radius_m);
  return evidence.grid();
}

}  // namespace rovigo::slam
