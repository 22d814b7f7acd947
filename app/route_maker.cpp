#include "app/route_maker.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <random>

#include "app/resources.h"
#include "app/route_drive.h"
#include "app/text.h"
#include "maps/distance_field.h"
#include "maps/error.h"

namespace rovigo::app {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRoomyM = 0.15;  // beyond the rover's radius, at places to visit
constexpr double kApartM = 1.2;   // between places
constexpr std::size_t kMaxPlaces = 24;
constexpr int kTours = 200;            // drawn; the one nearest to the wanted length is taken
constexpr double kHopM = 3.0;          // places about this far away come next most often
constexpr double kNewShare = 0.55;     // of the tour: visits new places first
constexpr double kLongestShare = 1.1;  // of the wanted length, drawn tours may be

/// Uniform in [0, 1); the standard's distributions differ between libraries, this does not.
double unit(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11U) * (1.0 / 9007199254740992.0);
}

/// Lengths of the ways over ground where the rover fits, from one place to everywhere.
class Ways {
 public:
  Ways(const maps::OccupancyGrid& grid, double clearance_m)
      : grid_(grid), field_(maps::distance_to_occupied(grid)), clearance_m_(clearance_m) {}

  double clearance(maps::Cell c) const { return static_cast<double>(field_.at(c)); }
  bool fits(maps::Cell c) const {
    return grid_.geometry.contains(c) && maps::OccupancyGrid::is_free(grid_.at(c)) &&
           clearance(c) >= clearance_m_;
  }

  /// Dijkstra over 8 neighbours, row-major as the grid; infinity where there is no way.
  std::vector<double> from(maps::Cell start) const {
    const auto& g = grid_.geometry;
    std::vector<double> length(g.size(), kInfinity);
    using Entry = std::pair<double, std::size_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    length[g.index_of(start)] = 0.0;
    open.emplace(0.0, g.index_of(start));
    while (!open.empty()) {
      const auto [so_far, index] = open.top();
      open.pop();
      if (so_far > length[index]) continue;
      const int x = static_cast<int>(index % static_cast<std::size_t>(g.width));
      const int y = static_cast<int>(index / static_cast<std::size_t>(g.width));
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const maps::Cell next{x + dx, y + dy};
          if (!fits(next)) continue;
          const double total = so_far + g.resolution_m * std::hypot(dx, dy);
          double& known = length[g.index_of(next)];
          if (total >= known) continue;
          known = total;
          open.emplace(total, g.index_of(next));
        }
      }
    }
    return length;
  }

 private:
  const maps::OccupancyGrid& grid_;
  maps::DistanceField field_;
  double clearance_m_;
};

/// Places of a world and the ways between them; place 0 is home.
struct Places {
  std::vector<TPoint2D> at;
  std::vector<std::vector<double>> way_m;
};

/// Farthest-point sampling among random roomy cells, so that every room gets its share.
Places find_places(const maps::OccupancyGrid& grid, const TPoint2D& home,
                   const maps::RobotModel& robot, std::mt19937_64& random) {
  const auto& g = grid.geometry;
  const Ways ways(grid, robot.robot_radius_m + g.resolution_m);
  Places places;
  const auto add = [&](const TPoint2D& p) { places.at.push_back(p); };
  add(home);
  const auto from_home = ways.from(g.cell_at(home));
  std::vector<TPoint2D> candidates;
  for (std::size_t i = 0; i < from_home.size(); ++i) {
    const maps::Cell c{static_cast<int>(i % static_cast<std::size_t>(g.width)),
                       static_cast<int>(i / static_cast<std::size_t>(g.width))};
    const bool roomy = ways.clearance(c) >= robot.robot_radius_m + kRoomyM;
    if (std::isfinite(from_home[i]) && roomy && unit(random) < 0.1) {
      candidates.push_back(g.center_of(c));
    }
  }
  std::vector<double> gap(candidates.size(), kInfinity);
  while (places.at.size() < kMaxPlaces) {
    std::size_t farthest = candidates.size();
    double most = kApartM;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      gap[i] = std::min(gap[i], maps::distance(candidates[i], places.at.back()));
      if (gap[i] > most) most = gap[farthest = i];
    }
    if (farthest == candidates.size()) break;
    add(candidates[farthest]);
  }
  for (const auto& a : places.at) {
    const auto length = ways.from(g.cell_at(a));
    auto& row = places.way_m.emplace_back();
    for (const auto& b : places.at) row.push_back(length[g.index_of(g.cell_at(b))]);
  }
  return places;
}

struct Tour {
  std::vector<std::size_t> stops;  ///< between leaving home and coming back
  double length_m = 0.0;
};

/// One random walk from place to place that is home again before `length_m`.
Tour draw_tour(const Places& places, double length_m, std::mt19937_64& random) {
  Tour tour;
  std::vector<bool> visited(places.at.size(), false);
  std::size_t here = 0;
  std::size_t before = 0;
  std::vector<double> weight(places.at.size());
  while (true) {
    const bool wants_new = tour.length_m < kNewShare * length_m;
    double total = 0.0;
    for (std::size_t i = 1; i < places.at.size(); ++i) {
      const double way = places.way_m[here][i];
      const bool in_time = tour.length_m + way + places.way_m[i][0] <= kLongestShare * length_m;
      weight[i] = i == here || i == before || !in_time ? 0.0 : std::exp(-way / kHopM);
      if (visited[i] == wants_new) weight[i] *= 0.02;
      total += weight[i];
    }
    if (total <= 0.0) break;
    double draw = unit(random) * total;
    std::size_t next = 0;
    for (std::size_t i = 1; i < places.at.size(); ++i) {
      if (weight[i] <= 0.0) continue;
      next = i;
      draw -= weight[i];
      if (draw < 0.0) break;
    }
    tour.length_m += places.way_m[here][next];
    tour.stops.push_back(next);
    visited[next] = true;
    before = here;
    here = next;
  }
  tour.length_m += places.way_m[here][0];
  return tour;
}

sim::Route route_of(const Tour& tour, const Places& places, const TourRequest& request,
                    std::mt19937_64& random) {
  sim::Route route;
  route.laps = request.laps;
  route.waypoints.push_back(places.at[0]);
  for (const std::size_t stop : tour.stops) {
    if (request.turns) {
      const double half_turns = 1.0 + unit(random);
      const double side = unit(random) < 0.5 ? -1.0 : 1.0;
      route.turns.push_back({route.waypoints.size(), side * half_turns * maps::kPi});
    }
    route.waypoints.push_back(places.at[stop]);
  }
  route.waypoints.push_back(places.at[0]);
  return route;
}

/// The text's fields after the word, as numbers within limits.
class Form {
 public:
  Form(const std::string& text, const std::string& usage) : text_(text), usage_(usage) {
    fields_ = split(text, ':');
  }
  [[noreturn]] void refuse(const std::string& why) const {
    throw maps::InputError("route \"" + text_ + "\": " + why + "; write " + usage_);
  }
  std::size_t count() const { return fields_.size(); }
  void require_count(std::size_t least, std::size_t most) const {
    if (count() < least || count() > most) refuse("has too few or too many parts");
  }
  double real(std::size_t i, double fallback, double min, double max) const {
    return i < count() ? number(fields_[i], min, max) : fallback;
  }
  std::uint64_t whole(std::size_t i, std::uint64_t fallback, double max) const {
    const double value = real(i, static_cast<double>(fallback), 0.0, max);
    if (value != std::floor(value)) refuse("\"" + fields_[i] + "\" must be a whole number");
    return static_cast<std::uint64_t>(value);
  }
  std::vector<double> list(std::size_t i, std::size_t size, double limit) const {
    std::vector<double> out;
    for (const auto& part : split(fields_[i], ',')) out.push_back(number(part, -limit, limit));
    if (out.size() != size) refuse("\"" + fields_[i] + "\" must be X,Y,YAW");
    return out;
  }

 private:
  double number(const std::string& field, double min, double max) const {
    const auto value = parse_number(field);
    if (value && *value >= min && *value <= max) return *value;
    refuse("\"" + field + "\" must be a number within [" + with_digits(min) + ", " +
           with_digits(max) + "]");
  }
  static std::string with_digits(double value) {
    std::string digits = std::to_string(value);
    digits.erase(digits.find_last_not_of('0') + 1);
    if (digits.back() == '.') digits.pop_back();
    return digits;
  }
  std::string text_;
  std::string usage_;
  std::vector<std::string> fields_;
};

constexpr double kMaxTourM = 5000.0;
constexpr double kMaxSeed = 9007199254740992.0;  // whole numbers are exact up to here

sim::Route tour_from(const std::string& text, const sim::World& world, const RovigoConfig& config) {
  const bool turns = text[0] == 't';
  const Form form(text, turns ? "turns:METRES[:SEED], e.g. turns:20:7"
                              : "loop:METRES[:SEED[:LAPS]], e.g. loop:30:7");
  form.require_count(2, turns ? 3 : 4);
  TourRequest request;
  request.turns = turns;
  request.length_m = form.real(1, 30.0, 2.0, kMaxTourM);
  request.seed = form.whole(2, 1, kMaxSeed);
  request.laps = static_cast<int>(std::max<std::uint64_t>(1, form.whole(3, 1, 1000.0)));
  return make_tour(request, world, config);
}

sim::Route spin_from(const std::string& text) {
  const Form form(text, "spin:X,Y,YAW[:RATE[:SECONDS]], e.g. spin:2,1.5,0:0.5:20");
  form.require_count(2, 4);
  const auto pose = form.list(1, 3, 1000.0);
  const double rate = form.real(2, 0.5, -2.0, 2.0);
  if (std::abs(rate) < 0.05) form.refuse("RATE must be at least 0.05 rad/s either way");
  const double seconds = form.real(3, 2.0 * maps::kPi / std::abs(rate), 0.5, 3600.0);
  sim::Route route;
  route.waypoints.push_back({pose[0], pose[1]});
  route.start_yaw_rad = pose[2];
  route.turn_rate_rad_s = std::abs(rate);
  route.turns.push_back({0, rate * seconds});
  return route;
}

}  // namespace

sim::Route make_tour(const TourRequest& request, const sim::World& world,
                     const RovigoConfig& config) {
  std::mt19937_64 random(request.seed);
  sim::Route route;
  const planning::Planner planner = route_planner(world, config, route.speed_m_s);
  const Places places =
      find_places(planner.grid(), maps::position_of(world.start()), config.robot, random);
  Tour best;
  double best_error = kInfinity;
  for (int i = 0; i < kTours; ++i) {
    Tour tour = draw_tour(places, request.length_m, random);
    const double error = std::abs(tour.length_m - request.length_m);
    if (tour.stops.empty() || error >= best_error) continue;
    best = std::move(tour);
    best_error = error;
  }
  if (best.stops.empty()) {
    throw maps::InputError("world \"" + world.name() + "\" has no place that a tour of " +
                           std::to_string(static_cast<int>(request.length_m)) +
                           " m could visit and come home from; ask for a longer one");
  }
  route = route_of(best, places, request, random);
  route.name = request.turns ? "turns" : "loop";
  return route;
}

sim::Route route_in_world(const std::string& text, const sim::World& world,
                          const RovigoConfig& config) {
  sim::Route route;
  if (text.rfind("loop:", 0) == 0 || text.rfind("turns:", 0) == 0) {
    route = tour_from(text, world, config);
  } else if (text.rfind("spin:", 0) == 0) {
    route = spin_from(text);
  } else {
    return open_route(text);
  }
  route.name = text;
  return route;
}

}  // namespace rovigo::app
