// The text formats: trajectory and GeoJSON.

#include <mrpt/poses/CPose3DQuat.h>

#include <charconv>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "maps/error.h"
#include "maps/export.h"

namespace rovigo::maps {
namespace {

using Json = nlohmann::ordered_json;

/// Fixed decimals, the same whatever the locale.
void append(std::string& text, double value, int decimals) {
  char buffer[400];
  const auto end =
      std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, decimals).ptr;
  text.append(buffer, end);
}

Json point(double x, double y) { return Json::array({x, y}); }

Json feature(const char* kind, const std::string& name, Json geometry) {
  Json properties = {{"kind", kind}};
  if (!name.empty()) properties["name"] = name;
  return {{"type", "Feature"}, {"properties", properties}, {"geometry", std::move(geometry)}};
}

/// GeoJSON wants the outer ring counter-clockwise and closed.
Json ring(std::vector<TPoint2D> corners) {
  double twice_area = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const TPoint2D& a = corners[i];
    const TPoint2D& b = corners[(i + 1) % corners.size()];
    twice_area += a.x * b.y - b.x * a.y;
  }
  if (twice_area < 0.0) std::reverse(corners.begin(), corners.end());
  Json list = Json::array();
  for (const TPoint2D& c : corners) list.push_back(point(c.x, c.y));
  if (!corners.empty()) list.push_back(list.front());
  return list;
}

Json polygon(const std::vector<TPoint2D>& corners) {
  return {{"type", "Polygon"}, {"coordinates", Json::array({ring(corners)})}};
}

/// Where the map knows anything, through the centres of the outermost known cells.
void add_outline(const OccupancyGrid& grid, Json& features) {
  if (grid.cells.empty()) return;
  cv::Mat known(grid.geometry.height, grid.geometry.width, CV_8UC1);
  for (std::size_t i = 0; i < grid.cells.size(); ++i) {
    known.data[i] = OccupancyGrid::is_unknown(grid.cells[i]) ? 0 : 255;
  }
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(known, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_SIMPLE);
  for (const auto& contour : contours) {
    if (contour.size() < 3) continue;
    std::vector<TPoint2D> corners;
    for (const cv::Point& p : contour) corners.push_back(grid.geometry.center_of({p.x, p.y}));
    features.push_back(feature("outline", "", polygon(corners)));
  }
}

}  // namespace

std::string trajectory_text(const SavedMap& map) {
  if (map.trajectory.empty()) {
    throw InputError("the map holds no trajectory; only maps made from recordings do");
  }
  std::string text = "# map_from_base_link\n# timestamp tx ty tz qx qy qz qw\n";
  for (const StoredPose& stored : map.trajectory) {
    const mrpt::poses::CPose3DQuat pose(stored.map_from_base);
    const auto& q = pose.quat();
    append(text, stored.time_s, 7);
    for (const double v : {pose.x(), pose.y(), pose.z(), q.x(), q.y(), q.z(), q.r()}) {
      text += ' ';
      append(text, v, 9);
    }
    text += '\n';
  }
  return text;
}

std::string geojson_text(const SavedMap& map) {
  Json features = Json::array();
  add_outline(map.grid, features);
  for (const NoGoZone& zone : map.zones) {
    if (zone.corners.size() < 3) continue;
    features.push_back(feature("no_go_zone", zone.name, polygon(zone.corners)));
  }
  for (const NamedPlace& place : map.places) {
    Json f = feature("place", place.name,
                     {{"type", "Point"}, {"coordinates", point(place.pose.x, place.pose.y)}});
    f["properties"]["yaw_rad"] = place.pose.phi;
    features.push_back(std::move(f));
  }
  Json line = Json::array();
  for (const StoredPose& p : map.trajectory) {
    line.push_back(point(p.map_from_base.x(), p.map_from_base.y()));
  }
  if (line.size() >= 2) {
    features.push_back(
        feature("trajectory", "", {{"type", "LineString"}, {"coordinates", std::move(line)}}));
  }
  const Json collection = {{"type", "FeatureCollection"},
                           {"coordinate_unit", "metres in the map frame, x east, y north"},
                           {"features", std::move(features)}};
  return collection.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace rovigo::maps
