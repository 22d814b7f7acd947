#include "sim/world_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rovigo::sim {

const std::vector<std::pair<std::string, Pattern>>& pattern_names() {
  static const std::vector<std::pair<std::string, Pattern>> kNames = {
      {"Plain", Pattern::kPlain},     {"Noise", Pattern::kNoise},
      {"Plaster", Pattern::kPlaster}, {"Bricks", Pattern::kBricks},
      {"Wood", Pattern::kWood},       {"Tiles", Pattern::kTiles},
      {"Carpet", Pattern::kCarpet},   {"Books", Pattern::kBooks},
      {"Poster", Pattern::kPoster},   {"Cardboard", Pattern::kCardboard},
  };
  return kNames;
}

std::vector<Eigen::Vector3d> corners_of(const Solid& solid) {
  const Eigen::Vector3d half = solid.size / 2.0;
  std::vector<Eigen::Vector3d> local;
  if (solid.kind == Solid::Kind::kCylinder) {
    for (const double z : {-half.z(), half.z()}) {
      for (int i = 0; i < kCylinderSides; ++i) {
        const double a = 2.0 * maps::kPi * i / kCylinderSides;
        local.emplace_back(half.x() * std::cos(a), half.y() * std::sin(a), z);
      }
    }
  } else {
    const bool flat = solid.kind == Solid::Kind::kPlane;
    for (const double z : {-half.z(), half.z()}) {
      local.emplace_back(-half.x(), -half.y(), flat ? 0.0 : z);
      local.emplace_back(half.x(), -half.y(), flat ? 0.0 : z);
      local.emplace_back(half.x(), half.y(), flat ? 0.0 : z);
      local.emplace_back(-half.x(), half.y(), flat ? 0.0 : z);
      if (flat) break;
    }
  }
  for (auto& p : local) p = solid.world_from_solid * p;
  return local;
}

Bounds bounds_of(const WorldModel& world) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  for (const bool planes : {false, true}) {
    Bounds b{{kInf, kInf}, {-kInf, -kInf}};
    for (const auto& solid : world.solids) {
      if ((solid.kind == Solid::Kind::kPlane) != planes) continue;
      for (const auto& p : corners_of(solid)) {
        b.min = {std::min(b.min.x, p.x()), std::min(b.min.y, p.y())};
        b.max = {std::max(b.max.x, p.x()), std::max(b.max.y, p.y())};
      }
    }
    if (b.min.x <= b.max.x) return b;
  }
  return {{-1.0, -1.0}, {1.0, 1.0}};
}

std::uint32_t name_seed(const std::string& name) {
  std::uint32_t h = 2166136261U;
  for (const char c : name) h = (h ^ static_cast<unsigned char>(c)) * 16777619U;
  return h;
}

}  // namespace rovigo::sim
