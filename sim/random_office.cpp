// Furnished random offices: rooms on both sides of a corridor. Whatever is placed keeps a passage's
// width from everything it does not stand against, so that every room can be reached.

#include <algorithm>
#include <cmath>

#include "sim/furniture.h"
#include "sim/random.h"
#include "sim/world.h"

namespace rovigo::sim {
namespace {

constexpr double kWallM = 0.12;
constexpr double kWallHeightM = 2.6;
constexpr double kLintelM = 2.05;
constexpr double kPassageM = 0.95;      // between things that do not stand together
constexpr double kDoorApproachM = 1.1;  // kept free on both sides of a door
constexpr double kMinRoomWidthM = 3.2;
constexpr int kTriesPerPiece = 12;

struct Door {
  double center = 0.0;  ///< along the wall
  double width = 1.05;
};

enum class Standing { kAtWall, kFree };

struct Room {
  std::string name;
  Bounds inside;             ///< between the walls' middles
  std::vector<Bounds> kept;  ///< door approaches
  std::vector<Bounds> used;  ///< furniture
};

double gap_between(const Bounds& a, const Bounds& b) {
  const double dx = std::max({0.0, a.min.x - b.max.x, b.min.x - a.max.x});
  const double dy = std::max({0.0, a.min.y - b.max.y, b.min.y - a.max.y});
  return std::hypot(dx, dy);
}

class OfficeBuilder {
 public:
  explicit OfficeBuilder(std::uint64_t seed) : random_(derive_seed(seed, 77)) {
    world_.name = "office_" + std::to_string(seed);
  }

  WorldModel build() {
    const double length = random_.uniform(9.0, 14.0);
    const double corridor = random_.uniform(1.5, 2.0);
    const double south = random_.uniform(3.6, 5.0);
    const double north = random_.uniform(3.6, 5.0);
    low_ = south;
    high_ = south + corridor;
    top_ = high_ + north;
    length_ = length;
    shell();
    row_of_rooms("south", 0.0, south, low_);
    row_of_rooms("north", high_, top_, high_);
    for (auto& room : rooms_) furnish(room);
    require_low_table();
    world_.start = {1.0, 0.5 * (low_ + high_), 0.0};
    return std::move(world_);
  }

 private:
  using Color = std::array<float, 3>;

  Color wall_color() {
    const auto base = static_cast<float>(random_.uniform(0.6, 0.88));
    const auto tint = [&] {
      return std::clamp(base + float(random_.uniform(-0.1, 0.1)), 0.F, 1.F);
    };
    const float r = tint();
    const float g = tint();
    return {r, g, tint()};
  }

  Pattern wall_pattern() {
    const double p = random_.uniform(0.0, 1.0);
    return p < 0.3 ? Pattern::kPlain : p < 0.75 ? Pattern::kPlaster : Pattern::kBricks;
  }

  void shell() {
    Solid floor;
    floor.kind = Solid::Kind::kPlane;
    floor.size = {length_ + 4.0, top_ + 4.0, 1.0};
    floor.world_from_solid.translation() << length_ / 2, top_ / 2, 0.0;
    floor.name = "floor::link::surface";
    constexpr Pattern kFloors[] = {Pattern::kTiles, Pattern::kWood, Pattern::kCarpet};
    floor.material = {{0.6F, 0.57F, 0.53F}, kFloors[random_.bits() % 3], name_seed(floor.name)};
    world_.solids.push_back(floor);
    ModelBuilder ceiling(world_, "ceiling", {length_ / 2, top_ / 2, 0.0});
    ceiling.box("panels", {length_, top_, 0.05}, {0, 0, kWallHeightM + 0.025},
                {0.86F, 0.86F, 0.84F}, Pattern::kTiles);
    wall_along_x("wall_south", 0.0, 0.0, length_, {});
    wall_along_x("wall_north", top_, 0.0, length_, {});
    wall_along_y("wall_west", 0.0, 0.0, top_, {});
    wall_along_y("wall_east", length_, 0.0, top_, {});
  }

  /// A wall from `from` to `to` along x at height y of the plan, with door openings and lintels.
  void wall_along_x(const std::string& name, double y, double from, double to,
                    std::vector<Door> doors) {
    build_wall(name, {0.0, y, 0.0}, from, to, std::move(doors));
  }
  void wall_along_y(const std::string& name, double x, double from, double to,
                    std::vector<Door> doors) {
    build_wall(name, {x, 0.0, maps::kPi / 2}, from, to, std::move(doors));
  }

  void build_wall(const std::string& name, const TPose2D& axis, double from, double to,
                  std::vector<Door> doors) {
    std::sort(doors.begin(), doors.end(),
              [](const Door& a, const Door& b) { return a.center < b.center; });
    ModelBuilder wall(world_, name, axis);
    const Color color = wall_color();
    const Pattern pattern = wall_pattern();
    int part = 0;
    const auto piece = [&](double a, double b, double bottom) {
      if (b - a < 1e-6) return;
      wall.box("part_" + std::to_string(++part), {b - a, kWallM, kWallHeightM - bottom},
               {(a + b) / 2, 0.0, (bottom + kWallHeightM) / 2}, color, pattern);
    };
    double at = from;
    for (const Door& door : doors) {
      piece(at, door.center - door.width / 2, 0.0);
      piece(door.center - door.width / 2, door.center + door.width / 2, kLintelM);
      at = door.center + door.width / 2;
    }
    piece(at, to, 0.0);
  }

  void row_of_rooms(const std::string& side, double bottom, double top, double door_wall_y) {
    const int most = std::min(3, static_cast<int>(length_ / kMinRoomWidthM));
    const int count = 2 + static_cast<int>(random_.bits() % static_cast<unsigned>(most - 1));
    std::vector<double> borders{0.0};
    const double spare = length_ - count * kMinRoomWidthM;
    std::vector<double> cuts;
    for (int i = 1; i < count; ++i) cuts.push_back(random_.uniform(0.0, spare));
    std::sort(cuts.begin(), cuts.end());
    for (int i = 1; i < count; ++i) {
      borders.push_back(i * kMinRoomWidthM + cuts[static_cast<std::size_t>(i - 1)]);
    }
    borders.push_back(length_);
    const std::size_t first_room = rooms_.size();
    std::vector<Door> doors;
    for (std::size_t i = 0; i + 1 < borders.size(); ++i) {
      Room room{side + "_" + std::to_string(i + 1),
                {{borders[i], bottom}, {borders[i + 1], top}},
                {},
                {}};
      const Door door{random_.uniform(borders[i] + 0.9, borders[i + 1] - 0.9),
                      random_.uniform(1.0, 1.2)};
      doors.push_back(door);
      const double half = door.width / 2 + 0.2;
      room.kept.push_back({{door.center - half, door_wall_y - kDoorApproachM},
                           {door.center + half, door_wall_y + kDoorApproachM}});
      rooms_.push_back(std::move(room));
    }
    wall_along_x("wall_corridor_" + side, door_wall_y, 0.0, length_, doors);
    for (std::size_t i = 1; i + 1 < borders.size(); ++i) {
      std::vector<Door> between;
      if (random_.uniform(0.0, 1.0) < 0.6) {
        const Door door{random_.uniform(bottom + 0.9, top - 0.9), random_.uniform(1.0, 1.2)};
        between.push_back(door);
        const double half = door.width / 2 + 0.2;
        const Bounds approach{{borders[i] - kDoorApproachM, door.center - half},
                              {borders[i] + kDoorApproachM, door.center + half}};
        rooms_[first_room + i - 1].kept.push_back(approach);
        rooms_[first_room + i].kept.push_back(approach);
      }
      wall_along_y("wall_" + side + "_" + std::to_string(i), borders[i], bottom, top, between);
    }
  }

  void furnish(Room& room) {
    constexpr Furniture kChoice[] = {Furniture::kDesk,     Furniture::kShelf,  Furniture::kDesk,
                                     Furniture::kCabinet,  Furniture::kSofa,   Furniture::kPlant,
                                     Furniture::kLowTable, Furniture::kCarton, Furniture::kShelf,
                                     Furniture::kBin,      Furniture::kPillar, Furniture::kCarton};
    const int pieces = 5 + static_cast<int>(random_.bits() % 5);
    for (int i = 0; i < pieces; ++i) {
      const Furniture kind = kChoice[random_.bits() % std::size(kChoice)];
      for (int attempt = 0; attempt < kTriesPerPiece; ++attempt) {
        const Standing standing = stands_at_wall(kind) ? Standing::kAtWall : Standing::kFree;
        if (place(room, kind, room.name + "_piece_" + std::to_string(i + 1), standing)) break;
      }
    }
    for (int i = 0; i < 3; ++i) hang_print(room, i + 1);
  }

  /// Every office has at least one table that is too low to drive under.
  void require_low_table() {
    constexpr int kTries = 60;
    for (int attempt = 0; attempt < kTries && !has_low_table_; ++attempt) {
      for (auto& room : rooms_) {
        const std::string name = room.name + "_low_table";
        if (place(room, Furniture::kLowTable, name, Standing::kFree)) return;
        if (attempt < kTries / 2) continue;  // no room in the middle: against a wall
        if (place(room, Furniture::kLowTable, name, Standing::kAtWall)) return;
      }
    }
  }

  /// Somewhere along a wall, its back to it, or free in the room; false where it does not fit.
  bool place(Room& room, Furniture kind, const std::string& name, Standing standing) {
    const Extent e = extent_of(kind);
    const Bounds& in = room.inside;
    const double half_wall = kWallM / 2 + 0.01;
    TPose2D pose;
    double dx = e.length_m / 2;
    double dy = e.width_m / 2;
    if (standing == Standing::kAtWall) {
      const auto wall = random_.bits() % 4;  // which one its back is at: west, south, east, north
      pose.phi = static_cast<double>(wall) * maps::kPi / 2;
      if (wall % 2 == 1) std::swap(dx, dy);
      pose.x = random_.uniform(in.min.x + half_wall + dx, in.max.x - half_wall - dx);
      pose.y = random_.uniform(in.min.y + half_wall + dy, in.max.y - half_wall - dy);
      if (wall == 0) pose.x = in.min.x + half_wall + dx;
      if (wall == 1) pose.y = in.min.y + half_wall + dy;
      if (wall == 2) pose.x = in.max.x - half_wall - dx;
      if (wall == 3) pose.y = in.max.y - half_wall - dy;
    } else {
      pose.phi = random_.uniform(-maps::kPi, maps::kPi);
      dx = dy = std::hypot(e.length_m, e.width_m) / 2;
      const double margin = half_wall + kPassageM;
      if (in.max.x - in.min.x < 2 * (dx + margin) || in.max.y - in.min.y < 2 * (dy + margin)) {
        return false;
      }
      pose.x = random_.uniform(in.min.x + margin + dx, in.max.x - margin - dx);
      pose.y = random_.uniform(in.min.y + margin + dy, in.max.y - margin - dy);
    }
    const Bounds taken{{pose.x - dx, pose.y - dy}, {pose.x + dx, pose.y + dy}};
    for (const auto& other : room.kept) {
      if (gap_between(taken, other) <= 0.0) return false;
    }
    for (const auto& other : room.used) {
      if (gap_between(taken, other) < kPassageM) return false;
    }
    room.used.push_back(taken);
    add_furniture(world_, kind, name, pose, random_);
    has_low_table_ |= kind == Furniture::kLowTable;
    return true;
  }

  void hang_print(const Room& room, int number) {
    const Bounds& in = room.inside;
    const auto wall = random_.bits() % 4;
    const double w = random_.uniform(0.5, 1.2);
    const double h = random_.uniform(0.5, 0.9);
    TPose2D pose{random_.uniform(in.min.x + 0.8, in.max.x - 0.8),
                 random_.uniform(in.min.y + 0.8, in.max.y - 0.8),
                 static_cast<double>(wall) * maps::kPi / 2};
    const double off = kWallM / 2 + 0.008;
    if (wall == 0) pose.x = in.min.x + off;
    if (wall == 1) pose.y = in.min.y + off;
    if (wall == 2) pose.x = in.max.x - off;
    if (wall == 3) pose.y = in.max.y - off;
    const Bounds here{{pose.x - w / 2, pose.y - w / 2}, {pose.x + w / 2, pose.y + w / 2}};
    for (const auto& door : room.kept) {
      if (gap_between(here, door) <= 0.0) return;  // not across an opening
    }
    ModelBuilder print(world_, room.name + "_print_" + std::to_string(number), pose);
    print.box("print", {0.016, w, h}, {0.0, 0.0, random_.uniform(1.0, 1.5)}, {0.8F, 0.8F, 0.8F},
              Pattern::kPoster);
  }

  RandomStream random_;
  WorldModel world_;
  std::vector<Room> rooms_;
  bool has_low_table_ = false;
  double length_ = 0.0;
  double low_ = 0.0;
  double high_ = 0.0;
  double top_ = 0.0;
};

}  // namespace

World World::random_office(std::uint64_t seed) { return World(OfficeBuilder(seed).build()); }

}  // namespace rovigo::sim
