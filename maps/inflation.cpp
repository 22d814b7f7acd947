#include "maps/inflation.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "maps/error.h"
#include "maps/gaussian_blur.h"
#include "maps/squared_distance.h"

namespace rovigo::maps {
namespace {

constexpr double kMaxReach = 100.0;  // metres; also cells for sigma: far beyond any rover

void require(bool fine, const char* name, double value, double limit) {
  if (fine) return;
  throw InputError(std::string(name) + " = " + std::to_string(value) + " is outside [0, " +
                   std::to_string(limit) + "]");
}

void check(const InflationConfig& config) {
  const auto inside = [](double v, double limit) { return v >= 0.0 && v <= limit; };
  require(inside(config.robot_radius_m, kMaxReach), "robot_radius_m", config.robot_radius_m,
          kMaxReach);
  require(inside(config.soft_cost_sigma_m, kMaxReach), "soft_cost_sigma_m",
          config.soft_cost_sigma_m, kMaxReach);
  require(inside(config.soft_cost_peak, Costmap::kMaxSoft), "soft_cost_peak", config.soft_cost_peak,
          Costmap::kMaxSoft);
}

void check_sigma(double sigma_cells) {
  require(sigma_cells >= 0.0 && sigma_cells <= kMaxReach, "sigma_cells", sigma_cells, kMaxReach);
}

/// The cost of a cell as a function of its squared distance in half cells, tabulated up to where
/// it has fallen to nothing.
class CostOfDistance {
 public:
  CostOfDistance(const InflationConfig& config, double resolution_m)
      : config_(config), half_cell_m_(0.5 * resolution_m) {
    double reach_m = config.robot_radius_m;
    if (config.soft_cost_sigma_m > 0.0 && config.soft_cost_peak > 0) {
      // Beyond this the Gaussian rounds to 0.
      reach_m += config.soft_cost_sigma_m * std::sqrt(2.0 * std::log(2.0 * config.soft_cost_peak));
    }
    reach_half_cells_ = reach_m / half_cell_m_;
    const double entries = std::floor(reach_half_cells_ * reach_half_cells_) + 1.0;
    table_.resize(static_cast<std::size_t>(std::min(entries, kMaxEntries)));
    for (std::size_t i = 0; i < table_.size(); ++i) {
      table_[i] = compute(static_cast<std::int64_t>(i));
    }
  }

  double reach_half_cells() const { return reach_half_cells_; }

  std::uint8_t operator()(std::int64_t squared_half_cells) const {
    if (static_cast<std::uint64_t>(squared_half_cells) < table_.size()) {
      return table_[static_cast<std::size_t>(squared_half_cells)];
    }
    return table_.size() < static_cast<std::size_t>(kMaxEntries) ? Costmap::kFree
                                                                 : compute(squared_half_cells);
  }

 private:
  static constexpr double kMaxEntries = 1 << 20;

  std::uint8_t compute(std::int64_t squared_half_cells) const {
    if (squared_half_cells == 0) return Costmap::kLethal;  // occupied itself
    const double distance_m = half_cell_m_ * std::sqrt(static_cast<double>(squared_half_cells));
    const double beyond_m = distance_m - config_.robot_radius_m;
    // A distance equal to the radius is allowed; rounding must not decide it.
    if (beyond_m < -1e-9 * config_.robot_radius_m) return Costmap::kLethal;
    if (config_.soft_cost_sigma_m <= 0.0) return Costmap::kFree;
    const double sigmas = std::max(beyond_m, 0.0) / config_.soft_cost_sigma_m;
    return static_cast<std::uint8_t>(
        std::lround(config_.soft_cost_peak * std::exp(-0.5 * sigmas * sigmas)));
  }

  const InflationConfig& config_;
  double half_cell_m_;
  double reach_half_cells_ = 0.0;
  std::vector<std::uint8_t> table_;
};

CellRect grown(const CellRect& rect, int cells, const GridGeometry& g) {
  return {{std::max(rect.lower.x - cells, 0), std::max(rect.lower.y - cells, 0)},
          {std::min(rect.upper.x + cells, g.width), std::min(rect.upper.y + cells, g.height)}};
}

/// What a change reaches is inflated anew, from a piece of the grid that holds all it depends on.
template <typename Inflate>
void update(const OccupancyGrid& grid, const CellRect& changed, int reach_cells, Costmap& costmap,
            const Inflate& inflate) {
  const GridGeometry& g = grid.geometry;
  if (costmap.geometry.width != g.width || costmap.geometry.height != g.height) {
    throw InputError("a costmap of " + std::to_string(costmap.geometry.width) + " x " +
                     std::to_string(costmap.geometry.height) + " cells is not that of a grid of " +
                     std::to_string(g.width) + " x " + std::to_string(g.height));
  }
  const CellRect inside = grown(changed, 0, g);
  if (inside.lower.x >= inside.upper.x || inside.lower.y >= inside.upper.y) return;
  const CellRect reached = grown(inside, reach_cells, g);
  const CellRect seen = grown(reached, reach_cells, g);
  GridGeometry piece_geometry = g;
  piece_geometry.width = seen.upper.x - seen.lower.x;
  piece_geometry.height = seen.upper.y - seen.lower.y;
  OccupancyGrid piece(piece_geometry, OccupancyGrid::kFree);
  for (int y = seen.lower.y; y < seen.upper.y; ++y) {
    const auto row = grid.cells.begin() + static_cast<std::ptrdiff_t>(g.index_of({0, y}));
    std::copy(row + seen.lower.x, row + seen.upper.x, &piece.at({0, y - seen.lower.y}));
  }
  const Costmap inflated = inflate(piece);
  for (int y = reached.lower.y; y < reached.upper.y; ++y) {
    const std::uint8_t* row =
        inflated.cells.data() +
        inflated.geometry.index_of({reached.lower.x - seen.lower.x, y - seen.lower.y});
    std::copy(row, row + (reached.upper.x - reached.lower.x), &costmap.at({reached.lower.x, y}));
  }
}

}  // namespace

void InflationConfig::describe(SettingsVisitor& v) {
  v.real({.name = "soft_cost_sigma_m",
          .help = "How far beyond robot_radius_m paths shun obstacles (sigma of a Gaussian of the "
                  "distance); 0 switches it off.",
          .min = 0.0,
          .max = 5.0},
         soft_cost_sigma_m);
  v.integer({.name = "soft_cost_peak",
             .help = "Soft cost right at robot_radius_m.",
             .min = 0,
             .max = Costmap::kMaxSoft},
            soft_cost_peak);
  int mode = static_cast<int>(map_mode);
  v.integer({.name = "map_mode",
             .help = "0: only known-free ground is passable; 1: unknown ground too; 2: everything.",
             .min = 0,
             .max = 2,
             .advanced = false},
            mode);
  map_mode = static_cast<MapMode>(mode);
}

Costmap inflate_safe(const OccupancyGrid& grid, const InflationConfig& config) {
  check(config);
  Costmap costmap(grid.geometry, Costmap::kFree);
  if (config.map_mode == MapMode::kEverything) return costmap;
  const CostOfDistance cost(config, grid.geometry.resolution_m);
  SquaredDistanceTransform transform(grid, cost.reach_half_cells());
  const bool keep_unknown = config.map_mode == MapMode::kKnownFree;
  const std::int8_t* cell = grid.cells.data();
  std::uint8_t* out = costmap.cells.data();
  for (int y = 0; y < grid.geometry.height; ++y) {
    for (const std::int64_t squared : transform.row(y)) {
      const std::uint8_t value = cost(squared);
      const bool unknown =
          keep_unknown && OccupancyGrid::is_unknown(*cell) && value != Costmap::kLethal;
      *out++ = unknown ? Costmap::kUnknown : value;
      ++cell;
    }
  }
  return costmap;
}

Costmap inflate_reference(const OccupancyGrid& grid, double sigma_cells, MapMode map_mode) {
  check_sigma(sigma_cells);
  Costmap costmap(grid.geometry, Costmap::kFree);
  if (map_mode == MapMode::kEverything) return costmap;
  const bool unknown_blocks = map_mode == MapMode::kKnownFree;
  std::transform(grid.cells.begin(), grid.cells.end(), costmap.cells.begin(),
                 [unknown_blocks](std::int8_t value) {
                   return static_cast<std::uint8_t>(value > 0 || (unknown_blocks && value < 0));
                 });
  costmap.cells = blur_like_scipy(std::move(costmap.cells), grid.geometry.width,
                                  grid.geometry.height, sigma_cells, BlurOutput::kPositive);
  for (std::uint8_t& cell : costmap.cells) cell = cell ? Costmap::kLethal : Costmap::kFree;
  return costmap;
}

void update_safe(const OccupancyGrid& grid, const CellRect& changed, const InflationConfig& config,
                 Costmap& costmap) {
  check(config);
  const double reach = CostOfDistance(config, grid.geometry.resolution_m).reach_half_cells();
  const double whole_grid = std::max(grid.geometry.width, grid.geometry.height);
  update(grid, changed, static_cast<int>(std::min(0.5 * reach + 2.0, whole_grid)), costmap,
         [&](const OccupancyGrid& piece) { return inflate_safe(piece, config); });
}

void update_reference(const OccupancyGrid& grid, const CellRect& changed, double sigma_cells,
                      MapMode map_mode, Costmap& costmap) {
  check_sigma(sigma_cells);
  update(grid, changed, blur_radius_cells(sigma_cells), costmap, [&](const OccupancyGrid& piece) {
    return inflate_reference(piece, sigma_cells, map_mode);
  });
}

}  // namespace rovigo::maps
