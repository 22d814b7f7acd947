#include "sim/route.h"

#include <cmath>

#include "sim/yaml_reader.h"

namespace rovigo::sim {
namespace {

constexpr double kMaxCoordinateM = 1000.0;
constexpr std::size_t kMaxWaypoints = 10000;
constexpr int kMaxLaps = 1000;
constexpr double kMaxTurnDeg = 3600.0;

/// The keys of a route file that are plain settings.
struct RouteSettings {
  double speed_m_s = 0.4;
  double turn_rate_rad_s = 1.5;
  int laps = 1;
  std::string world;
  void describe(maps::SettingsVisitor& v) {
    v.real({.name = "speed_m_s", .help = "Cruising speed.", .min = 0.02, .max = 1.0}, speed_m_s);
    v.real({.name = "turn_rate_rad_s",
            .help = "Of the turns in place at waypoints.",
            .min = 0.05,
            .max = 2.0},
           turn_rate_rad_s);
    v.integer(
        {.name = "laps", .help = "How often the whole route is driven.", .min = 1, .max = kMaxLaps},
        laps);
    v.text({.name = "world", .help = "The world the route was made for."}, world);
  }
};

TPoint2D read_point(const std::string& file, const YAML::Node& node) {
  if (!node.IsSequence() || node.size() != 2) {
    fail_at(file, node, "a waypoint is two numbers, [x, y], in metres");
  }
  const TPoint2D p{real_at(file, node[0], "x"), real_at(file, node[1], "y")};
  if (std::abs(p.x) > kMaxCoordinateM || std::abs(p.y) > kMaxCoordinateM) {
    fail_at(file, node, "a waypoint's coordinates must lie within +-1000 m");
  }
  return p;
}

/// A waypoint with what the rover does there: {at: [x, y], turn_deg: 360}.
void read_stop(const std::string& file, const YAML::Node& node, Route& route) {
  require_known_keys(file, node, {"at", "turn_deg"});
  if (!node["at"]) fail_at(file, node, "a waypoint with a turn needs `at: [x, y]`");
  const TPoint2D at = read_point(file, node["at"]);
  if (const YAML::Node turn = node["turn_deg"]) {
    const double degrees = real_at(file, turn, "turn_deg");
    if (!(std::abs(degrees) <= kMaxTurnDeg)) {
      fail_at(file, turn, "turn_deg must lie within +-3600");
    }
    route.turns.push_back({route.waypoints.size(), degrees * maps::kPi / 180.0});
  }
  route.waypoints.push_back(at);
}

}  // namespace

Route parse_route(const std::string& yaml, const std::string& file) {
  const YAML::Node root = parse_yaml(yaml, file);
  RouteSettings settings;
  YamlFields fields(file, root);
  settings.describe(fields);
  std::vector<std::string> known = fields.names();
  known.emplace_back("waypoints");
  require_known_keys(file, root, known);

  Route route;
  route.name = std::filesystem::path(file).stem().string();
  route.speed_m_s = settings.speed_m_s;
  route.turn_rate_rad_s = settings.turn_rate_rad_s;
  route.laps = settings.laps;
  route.world = settings.world;
  const YAML::Node points = root["waypoints"];
  if (!points) throw maps::InputError(file + ": `waypoints: [[x, y], ...]` is missing");
  if (!points.IsSequence()) fail_at(file, points, "waypoints must be a list of [x, y]");
  if (points.size() < 2 || points.size() > kMaxWaypoints) {
    fail_at(file, points,
            "a route has 2 to " + std::to_string(kMaxWaypoints) + " waypoints, this one has " +
                std::to_string(points.size()));
  }
  for (const auto& node : points) {
    if (node.IsMap()) {
      read_stop(file, node, route);
    } else {
      route.waypoints.push_back(read_point(file, node));
    }
  }
  const TPoint2D way = route.waypoints[1] - route.waypoints[0];
  route.start_yaw_rad = std::atan2(way.y, way.x);
  return route;
}

Route load_route(const std::filesystem::path& file) {
  return parse_route(read_text(file), file.string());
}

}  // namespace rovigo::sim
