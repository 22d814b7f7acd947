#pragma once
// What a world is made of, once loaded: convex solids with a colour and a texture. Sim's own.

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "maps/geometry.h"

namespace rovigo::sim {

/// What covers a surface. All but kPlain are rich: features on them repeat from view to view.
enum class Pattern {
  kPlain,      ///< one colour, nothing to hold on to
  kNoise,      ///< mottled, every scale
  kPlaster,    ///< nearly plain: faint mottling, as painted walls have
  kBricks,     ///< courses of bricks
  kWood,       ///< stripes and knots
  kTiles,      ///< square tiles with joints
  kCarpet,     ///< coarse woven blotches
  kBooks,      ///< rows of book spines
  kPoster,     ///< a print: shapes and lines of text, different on every surface
  kCardboard,  ///< brown board with tape and labels
  kMarker,     ///< an ArUco marker that fills the +x face of a box; the other faces stay plain
};

/// Name in SDF files ("Rovigo/Bricks"), and back; nullptr-free and exhaustive.
const std::vector<std::pair<std::string, Pattern>>& pattern_names();

struct Material {
  std::array<float, 3> color{0.7F, 0.7F, 0.7F};  ///< red, green, blue, 0 .. 1
  Pattern pattern = Pattern::kPlain;
  std::uint32_t seed = 0;  ///< makes two surfaces of one pattern differ; of a marker: its id
};

/// A solid: box (size x, y, z), upright cylinder along its z axis (size: diameter, diameter,
/// length), or plane (its top face at z = 0 of its own frame; size x, y; no thickness).
struct Solid {
  enum class Kind { kBox, kCylinder, kPlane };
  Kind kind = Kind::kBox;
  Eigen::Isometry3d world_from_solid = Eigen::Isometry3d::Identity();
  Eigen::Vector3d size = Eigen::Vector3d::Ones();
  Material material;
  bool visible = true;    ///< the camera sees it
  bool touchable = true;  ///< the rover bumps into it
  std::string name;       ///< model::link::visual, for messages
};

/// An axis-aligned rectangle on the floor, metres.
struct Bounds {
  TPoint2D min;
  TPoint2D max;
};

struct WorldModel {
  std::string name;
  TPose2D start;  ///< world_from_base where rovers are put down
  std::vector<Solid> solids;
};

/// Corners of a solid's convex hull in the world: 8 for a box, 4 for a plane, two rings for a
/// cylinder (`kCylinderSides` each, bottom first).
inline constexpr int kCylinderSides = 24;
std::vector<Eigen::Vector3d> corners_of(const Solid& solid);

/// Rectangle around all solids but planes; around the planes when there is nothing else.
Bounds bounds_of(const WorldModel& world);

/// Seed of a surface's texture from its name, the same on every machine (FNV-1a).
std::uint32_t name_seed(const std::string& name);

}  // namespace rovigo::sim
