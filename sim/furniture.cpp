#include "sim/furniture.h"

#include <cmath>

namespace rovigo::sim {
namespace {

using Color = std::array<float, 3>;

constexpr Color kDarkMetal{0.25F, 0.25F, 0.27F};
constexpr double kDeskTopM = 0.75;  // a rover drives under it

Color shade(const Color& base, RandomStream& random) {
  const auto f = static_cast<float>(random.uniform(0.75, 1.2));
  return {std::min(1.0F, base[0] * f), std::min(1.0F, base[1] * f), std::min(1.0F, base[2] * f)};
}

Pattern rich_or_plain(Pattern rich, RandomStream& random) {
  return random.uniform(0.0, 1.0) < 0.65 ? rich : Pattern::kPlain;
}

void desk_with_chair(ModelBuilder& m, RandomStream& random) {
  // The desk takes the back 0.7 m of the extent, the chair stands half under its front edge.
  const double desk_x = -0.3;
  m.box("top", {0.7, 1.4, 0.03}, {desk_x, 0.0, kDeskTopM - 0.015},
        shade({0.7F, 0.54F, 0.36F}, random), rich_or_plain(Pattern::kWood, random));
  for (const double x : {-0.3, 0.3}) {
    for (const double y : {-0.65, 0.65}) {
      m.box("leg_" + std::to_string(x > 0) + std::to_string(y > 0), {0.05, 0.05, 0.72},
            {desk_x + x, y, 0.36}, kDarkMetal);
    }
  }
  m.box("monitor", {0.05, 0.55, 0.34}, {desk_x - 0.2, random.uniform(-0.3, 0.3), 1.0},
        {0.35F, 0.4F, 0.5F}, Pattern::kPoster);
  const Color fabric = shade({0.3F, 0.28F, 0.35F}, random);
  const double y = random.uniform(-0.3, 0.3);
  m.box("seat", {0.44, 0.44, 0.05}, {0.35, y, 0.445}, fabric, Pattern::kCarpet);
  m.box("back", {0.05, 0.42, 0.42}, {0.55, y, 0.7}, fabric, Pattern::kCarpet);
  for (const double dx : {-0.18, 0.18}) {
    for (const double dy : {-0.18, 0.18}) {
      m.box("chair_leg_" + std::to_string(dx > 0) + std::to_string(dy > 0), {0.035, 0.035, 0.42},
            {0.35 + dx, y + dy, 0.21}, kDarkMetal);
    }
  }
}

void shelf(ModelBuilder& m, RandomStream& random) {
  const double height = random.uniform(1.4, 2.1);
  m.box("case", {0.35, 1.2, height}, {0.0, 0.0, height / 2}, shade({0.5F, 0.36F, 0.24F}, random),
        Pattern::kWood);
  const Pattern goods = random.uniform(0.0, 1.0) < 0.6 ? Pattern::kBooks : Pattern::kCardboard;
  m.box("front", {0.02, 1.12, height - 0.14}, {0.185, 0.0, height / 2 + 0.03}, {0.7F, 0.66F, 0.6F},
        goods);
}

void low_table(ModelBuilder& m, RandomStream& random) {
  // A camera at 0.25 m sees edge, legs and hardly the underside; the rover would not fit under.
  const double height = random.uniform(0.35, 0.45);
  m.box("top", {0.55, 0.9, 0.04}, {0.0, 0.0, height - 0.02}, shade({0.6F, 0.42F, 0.26F}, random),
        rich_or_plain(Pattern::kWood, random));
  m.legs(0.47, 0.82, height - 0.04, 0.035);
}

void plant(ModelBuilder& m) {
  m.cylinder("pot", 0.17, 0.0, 0.35, {0.62F, 0.33F, 0.22F}, Pattern::kNoise);
  m.cylinder("stem", 0.03, 0.35, 0.8, {0.3F, 0.22F, 0.12F});
  m.cylinder("leaves", 0.25, 0.75, 1.4, {0.18F, 0.42F, 0.16F}, Pattern::kNoise);
}

}  // namespace

void ModelBuilder::add(Solid solid, const std::string& part, const Eigen::Vector3d& center,
                       const Color& color, Pattern pattern) {
  Eigen::Isometry3d world_from_model = Eigen::Isometry3d::Identity();
  world_from_model.translation() << pose_.x, pose_.y, 0.0;
  world_from_model.linear() =
      Eigen::AngleAxisd(pose_.phi, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  Eigen::Isometry3d model_from_solid = Eigen::Isometry3d::Identity();
  model_from_solid.translation() = center;
  solid.world_from_solid = world_from_model * model_from_solid;
  solid.name = name_ + "::link::" + part;
  solid.material = {color, pattern, name_seed(solid.name)};
  world_.solids.push_back(std::move(solid));
}

void ModelBuilder::box(const std::string& part, const Eigen::Vector3d& size,
                       const Eigen::Vector3d& center, const Color& color, Pattern pattern) {
  Solid solid;
  solid.size = size;
  add(std::move(solid), part, center, color, pattern);
}

void ModelBuilder::cylinder(const std::string& part, double radius_m, double bottom_m, double top_m,
                            const Color& color, Pattern pattern) {
  Solid solid;
  solid.kind = Solid::Kind::kCylinder;
  solid.size = {2.0 * radius_m, 2.0 * radius_m, top_m - bottom_m};
  add(std::move(solid), part, {0.0, 0.0, 0.5 * (bottom_m + top_m)}, color, pattern);
}

void ModelBuilder::legs(double length_m, double width_m, double height_m, double thickness_m) {
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      box("leg_" + std::to_string(x > 0) + std::to_string(y > 0),
          {thickness_m, thickness_m, height_m}, {x * length_m, y * width_m, height_m / 2},
          kDarkMetal);
    }
  }
}

Extent extent_of(Furniture kind) {
  switch (kind) {
    case Furniture::kDesk:
      return {1.3, 1.4};
    case Furniture::kShelf:
      return {0.4, 1.2};
    case Furniture::kCabinet:
      return {0.5, 0.9};
    case Furniture::kSofa:
      return {0.8, 1.8};
    case Furniture::kLowTable:
      return {0.55, 0.9};
    case Furniture::kCarton:
      return {0.6, 0.5};
    case Furniture::kPlant:
      return {0.36, 0.36};
    case Furniture::kBin:
      return {0.3, 0.3};
    case Furniture::kPillar:
      return {0.36, 0.36};
  }
  return {1.0, 1.0};
}

bool stands_at_wall(Furniture kind) {
  return kind != Furniture::kLowTable && kind != Furniture::kCarton && kind != Furniture::kPillar;
}

void add_furniture(WorldModel& world, Furniture kind, const std::string& name, const TPose2D& pose,
                   RandomStream& random) {
  ModelBuilder m(world, name, pose);
  const Extent e = extent_of(kind);
  switch (kind) {
    case Furniture::kDesk:
      return desk_with_chair(m, random);
    case Furniture::kShelf:
      return shelf(m, random);
    case Furniture::kLowTable:
      return low_table(m, random);
    case Furniture::kPlant:
      return plant(m);
    case Furniture::kCabinet: {
      const double height = random.uniform(0.8, 1.9);
      return m.box("body", {e.length_m, e.width_m, height}, {0, 0, height / 2},
                   shade({0.55F, 0.58F, 0.6F}, random), rich_or_plain(Pattern::kWood, random));
    }
    case Furniture::kSofa: {
      const Color fabric = shade({0.45F, 0.24F, 0.22F}, random);
      m.box("seat", {0.8, 1.8, 0.42}, {0, 0, 0.21}, fabric, Pattern::kCarpet);
      return m.box("back", {0.2, 1.8, 0.4}, {-0.3, 0, 0.62}, fabric, Pattern::kCarpet);
    }
    case Furniture::kCarton: {
      const double height = random.uniform(0.25, 0.8);
      return m.box("box", {e.length_m, e.width_m, height}, {0, 0, height / 2},
                   shade({0.72F, 0.55F, 0.36F}, random), Pattern::kCardboard);
    }
    case Furniture::kBin:
      return m.cylinder("bin", 0.15, 0.0, 0.35, shade({0.3F, 0.33F, 0.36F}, random));
    case Furniture::kPillar:
      return m.cylinder("shaft", 0.18, 0.0, 2.6, shade({0.75F, 0.73F, 0.7F}, random),
                        rich_or_plain(Pattern::kNoise, random));
  }
}

}  // namespace rovigo::sim
