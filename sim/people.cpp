#include "sim/people.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>

#include "sim/simulator.h"

namespace rovigo::sim {
namespace {

constexpr double kCellM = 0.1;
constexpr double kLowestM = 0.05;
constexpr double kHeadM = 1.85;           // people do not walk under anything lower
constexpr double kWalkClearanceM = 0.30;  // of planned ways from walls
constexpr double kLeastClearanceM = 0.25;
constexpr double kComfortM = 1.25;  // from the rover's middle: nearer, people step back
constexpr double kReactionS = 0.3;
constexpr double kFollowM = 5.0;  // farther from the rover, they come after it
constexpr double kAimS = 0.1;
constexpr auto kStraightM = static_cast<float>(kCellM);
constexpr float kDiagonalM = kStraightM * 1.41421356F;
constexpr float kNowhere = std::numeric_limits<float>::infinity();

TPoint2D direction(const TPoint2D& from, const TPoint2D& to) {
  const TPoint2D d = to - from;
  const double n = d.norm();
  return n > 1e-9 ? d * (1.0 / n) : TPoint2D(0.0, 0.0);
}

}  // namespace

People::People(const World& world, const PeopleSettings& settings, const TPose2D& world_from_base,
               std::uint64_t seed)
    : settings_(settings),
      grid_(true_grid(world, kCellM, kLowestM, kHeadM)),
      field_(maps::distance_to_occupied(grid_)),
      random_(seed),
      persons_(static_cast<std::size_t>(settings.count)) {
  for (auto& person : persons_) appear(person, world_from_base);
}

bool People::is_walkable(maps::Cell c) const {
  return grid_.geometry.contains(c) && maps::OccupancyGrid::is_free(grid_.at(c)) &&
         static_cast<double>(field_.at(c)) >= kWalkClearanceM;
}

double People::clearance(const TPoint2D& p) const {
  const maps::Cell c = grid_.geometry.cell_at(p);
  if (!grid_.geometry.contains(c) || !maps::OccupancyGrid::is_free(grid_.at(c))) return 0.0;
  return maps::clearance_at(grid_, field_, p, 1.0);
}

/// By the cells' own distances: exact to half a cell, and cheap.
bool People::is_clear(const TPoint2D& a, const TPoint2D& b, double clearance_m) const {
  const int steps = static_cast<int>(maps::distance(a, b) / (0.5 * kCellM)) + 1;
  for (int i = 0; i <= steps; ++i) {
    const maps::Cell c = grid_.geometry.cell_at(a + (b - a) * (static_cast<double>(i) / steps));
    if (!grid_.geometry.contains(c) || !maps::OccupancyGrid::is_free(grid_.at(c))) return false;
    if (static_cast<double>(field_.at(c)) < clearance_m) return false;
  }
  return true;
}

/// Mostly a place in the camera's view, on the other side of it than the person is now.
void People::choose_target(Person& person, const TPose2D& rover) {
  constexpr int kTries = 40;
  constexpr double kHalfViewRad = 0.55;
  const TPoint2D seen = maps::transform(maps::inverse(rover), person.at);
  for (int i = 0; i < kTries; ++i) {
    const bool in_view = random_.uniform(0.0, 1.0) < 0.8;
    const double side = seen.y > 0.0 ? -1.0 : 1.0;
    const double bearing = in_view ? side * random_.uniform(-0.1, kHalfViewRad)
                                   : random_.uniform(-maps::kPi, maps::kPi);
    const double away = random_.uniform(kComfortM, settings_.reach_m);
    const TPoint2D p =
        maps::transform(rover, TPoint2D(away * std::cos(bearing), away * std::sin(bearing)));
    if (!is_walkable(grid_.geometry.cell_at(p))) continue;
    if (!is_clear(maps::position_of(rover), p, 0.05)) continue;  // behind a wall
    person.target = p;
    break;
  }
  person.speed_m_s = random_.uniform(settings_.min_speed_m_s, settings_.max_speed_m_s);
  person.until_choice_s = random_.uniform(2.0, 4.0);
  find_way(person, maps::position_of(rover));
}

/// Dijkstra from the target over ground where people fit, round the rover, as far as the person.
void People::find_way(Person& person, const TPoint2D& rover) const {
  const auto& g = grid_.geometry;
  person.until_way_s = 0.7;
  person.way_m.assign(g.size(), kNowhere);
  const maps::Cell goal = g.cell_at(person.target);
  if (!is_walkable(goal)) return;
  using Entry = std::pair<float, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  person.way_m[g.index_of(goal)] = 0.0F;
  open.emplace(0.0F, g.index_of(goal));
  constexpr float kBeyondM = 0.3F;  // the person's neighbourhood, too
  const maps::Cell person_cell = g.cell_at(person.at);
  const std::size_t person_index = g.contains(person_cell) ? g.index_of(person_cell) : 0;
  while (!open.empty()) {
    const auto [so_far, index] = open.top();
    open.pop();
    if (so_far > person.way_m[index]) continue;
    if (so_far > person.way_m[person_index] + kBeyondM) break;
    const int x = static_cast<int>(index % static_cast<std::size_t>(g.width));
    const int y = static_cast<int>(index / static_cast<std::size_t>(g.width));
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const maps::Cell n{x + dx, y + dy};
        if (!is_walkable(n) || maps::distance(g.center_of(n), rover) < kNearestM) continue;
        const float total = so_far + (dx != 0 && dy != 0 ? kDiagonalM : kStraightM);
        float& known = person.way_m[g.index_of(n)];
        if (total >= known) continue;
        known = total;
        open.emplace(total, g.index_of(n));
      }
    }
  }
}

/// The farthest point down the way that can be walked to in a straight line.
TPoint2D People::aim(const Person& person) const {
  constexpr int kLookAheadCells = 14;
  const auto& g = grid_.geometry;
  maps::Cell c = g.cell_at(person.at);
  TPoint2D best = person.at;
  for (int i = 0; i < kLookAheadCells; ++i) {
    maps::Cell next = c;
    float least = g.contains(c) ? person.way_m[g.index_of(c)] : kNowhere;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const maps::Cell n{c.x + dx, c.y + dy};
        if (!g.contains(n) || person.way_m[g.index_of(n)] >= least) continue;
        least = person.way_m[g.index_of(n)];
        next = n;
      }
    }
    if (next == c) break;
    c = next;
    const TPoint2D p = g.center_of(c);
    if (i > 0 && !is_clear(person.at, p, kLeastClearanceM)) break;
    best = p;
  }
  return best;
}

void People::appear(Person& person, const TPose2D& rover) {
  constexpr int kTries = 400;
  const TPoint2D eye = maps::position_of(rover);
  const auto& g = grid_.geometry;
  for (int i = 0; i < kTries; ++i) {
    const double far_m = 1.8 + 4.0 * i / kTries;
    const double bearing = random_.uniform(-maps::kPi, maps::kPi);
    const double away = random_.uniform(1.6, far_m);
    const TPoint2D p =
        maps::transform(rover, TPoint2D(away * std::cos(bearing), away * std::sin(bearing)));
    const bool in_sight = std::abs(bearing) < 0.9 && is_clear(eye, p, 0.0);
    if (!is_walkable(g.cell_at(p)) || in_sight) continue;
    person.at = person.target = p;
    person.velocity = TPoint2D(0.0, 0.0);
    person.until_aim_s = 0.0;
    choose_target(person, rover);
    if (person.way_m[g.index_of(g.cell_at(p))] < kNowhere) return;  // can come and be seen
  }
}

void People::walk(Person& person, const TPose2D& rover_pose) {
  const TPoint2D rover = maps::position_of(rover_pose);
  person.until_aim_s -= kStepS;
  if (person.until_aim_s <= 0.0) {
    person.aim = aim(person);
    person.until_aim_s = kAimS;
  }
  TPoint2D wanted = direction(person.at, person.aim) * person.speed_m_s;
  const TPoint2D out = direction(rover, person.at);
  const double away = maps::distance(rover, person.at);
  if (away < kComfortM) {
    const double inwards = std::min(0.0, wanted.x * out.x + wanted.y * out.y);
    wanted = wanted - out * inwards + out * (4.0 * (kComfortM - away));
  }
  const double most = settings_.max_speed_m_s;
  if (wanted.norm() > most) wanted = wanted * (most / wanted.norm());
  person.velocity = person.velocity + (wanted - person.velocity) * (kStepS / kReactionS);

  // Along a wall only what leads along it is walked.
  const TPoint2D step = person.velocity * kStepS;
  const double now = clearance(person.at);
  for (const TPoint2D& part : {step, TPoint2D(step.x, 0.0), TPoint2D(0.0, step.y)}) {
    const TPoint2D next = person.at + part;
    const double there = clearance(next);
    if (there < kLeastClearanceM && there <= now) continue;
    if (there <= 0.0) continue;
    person.at = next;
    break;
  }
  if (maps::distance(rover, person.at) < kNearestM) return appear(person, rover_pose);

  const double speed = person.velocity.norm();
  if (speed > 0.1) {
    const double facing = std::atan2(person.velocity.y, person.velocity.x);
    person.heading_rad +=
        std::clamp(maps::wrap_angle(facing - person.heading_rad), -5.0 * kStepS, 5.0 * kStepS);
  }
  constexpr double kStrideM = 1.3;  // two steps
  person.stride_rad += 2.0 * maps::kPi * speed * kStepS / kStrideM;
}

void People::step(const TPose2D& rover) {
  const TPoint2D eye = maps::position_of(rover);
  for (auto& person : persons_) {
    person.until_choice_s -= kStepS;
    person.until_way_s -= kStepS;
    const bool there = maps::distance(person.at, person.target) < 0.35;
    const bool left_behind = maps::distance(person.target, eye) > kFollowM;
    if (there || left_behind || person.until_choice_s <= 0.0) {
      choose_target(person, rover);
    } else if (person.until_way_s <= 0.0) {
      find_way(person, eye);
    }
    walk(person, rover);
  }
}

std::vector<Mover> People::bodies() const {
  std::vector<Mover> movers;
  for (std::size_t i = 0; i < persons_.size(); ++i) {
    movers.push_back({person_body(persons_[i], i)});
  }
  return movers;
}

}  // namespace rovigo::sim
