#pragma once
// Pieces of furniture for worlds made in code. Each stands on the floor at `pose`: origin in its
// middle, except where noted, and adds its solids to the world.

#include <string>

#include "sim/random.h"
#include "sim/world_model.h"

namespace rovigo::sim {

/// Collects solids under one model name, placed relative to a pose.
class ModelBuilder {
 public:
  ModelBuilder(WorldModel& world, std::string name, const TPose2D& pose)
      : world_(world), name_(std::move(name)), pose_(pose) {}
  void box(const std::string& part, const Eigen::Vector3d& size, const Eigen::Vector3d& center,
           const std::array<float, 3>& color, Pattern pattern = Pattern::kPlain);
  void cylinder(const std::string& part, double radius_m, double bottom_m, double top_m,
                const std::array<float, 3>& color, Pattern pattern = Pattern::kPlain);
  /// Four legs under a rectangle.
  void legs(double length_m, double width_m, double height_m, double thickness_m);

 private:
  void add(Solid solid, const std::string& part, const Eigen::Vector3d& center,
           const std::array<float, 3>& color, Pattern pattern);
  WorldModel& world_;
  std::string name_;
  TPose2D pose_;
};

/// What there is, and the floor each takes: length along x, width along y of its own frame. Its
/// back is towards -x where it has one, so that it may stand against a wall.
enum class Furniture { kDesk, kShelf, kCabinet, kSofa, kLowTable, kCarton, kPlant, kBin, kPillar };
struct Extent {
  double length_m;
  double width_m;
};
Extent extent_of(Furniture kind);
bool stands_at_wall(Furniture kind);
void add_furniture(WorldModel& world, Furniture kind, const std::string& name, const TPose2D& pose,
                   RandomStream& random);

}  // namespace rovigo::sim
