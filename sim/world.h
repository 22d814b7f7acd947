#pragma once
// A world as an SDF file describes it: boxes, cylinders and planes with colours and textures.
// sim/worlds/README.md tells which part of SDF is understood and how textures are named.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "maps/geometry.h"
#include "maps/occupancy_grid.h"

namespace rovigo::sim {

struct WorldModel;  // geometry and materials; sim's own

/// Shared and immutable once loaded.
class World {
 public:
  /// Throws InputError naming file and element for what is missing, malformed or unsupported.
  static World load(const std::filesystem::path& sdf_file);
  /// A furnished random office of a few rooms; same seed, same world.
  static World random_office(std::uint64_t seed);
  /// Walls raised from the occupied cells of a grid, for maps that came without a world.
  static World from_grid(const maps::OccupancyGrid& grid, double wall_height_m);
  /// A world put together in code (tests).
  explicit World(WorldModel model);

  const std::string& name() const;
  TPose2D start() const;  ///< world_from_base where rovers are put down by default
  const WorldModel& model() const { return *model_; }

 private:
  std::shared_ptr<const WorldModel> model_;
};

}  // namespace rovigo::sim
