#include "slam/keyframe_scans.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "slam/keyframe_codec.h"

namespace rovigo::slam {

namespace {

constexpr double kMillimetre = 0.001;  // unit of a stored depth image
constexpr int kStride = 16;
constexpr double kLevelM = 0.05;    // thickness of a level
constexpr double kGathered = 0.02;  // share of all points that makes a level a surface

void add_heights(const cv::Mat& depth, const Se3& map_from_camera, const LandmarkMap& map,
                 std::vector<float>& heights) {
  const double farthest = map.config().grid.mapping_range_m;
  for (int v = 0; v < depth.rows; v += kStride) {
    for (int u = 0; u < depth.cols; u += kStride) {
      const double z = depth.at<std::uint16_t>(v, u) * kMillimetre;
      if (z < map.config().depth.min_depth_m || z > farthest) continue;
      const Eigen::Vector3d p =
          map_from_camera * map.camera().unproject(map.camera().undistort({u, v}), z);
      heights.push_back(static_cast<float>(p.z()));
    }
  }
}

}  // namespace

double estimate_floor_height(const std::vector<float>& heights_m) {
  if (heights_m.empty()) return 0.0;
  std::map<int, int> levels;
  for (const float h : heights_m) ++levels[static_cast<int>(std::floor(h / kLevelM))];
  const auto enough = static_cast<int>(kGathered * static_cast<double>(heights_m.size()));
  for (const auto& [level, count] : levels) {
    const auto above = levels.find(level + 1);
    // A level is a surface when it holds more than the slope of a wall would leave in it.
    if (count >= enough && (above == levels.end() || above->second <= 2 * count)) {
      return (level + 0.5) * kLevelM;
    }
  }
  return *std::min_element(heights_m.begin(), heights_m.end());
}

std::vector<KeyframeScan> scans_of_keyframes(const LandmarkMap& map, DepthScanner& scanner) {
  std::vector<float> heights;
  std::vector<std::pair<int, cv::Mat>> views;
  for (const Keyframe& k : map.keyframes()) {
    if (k.depth_png.empty()) continue;
    views.emplace_back(k.id, decode_depth(k.depth_png, {map.camera().width(), map.camera().height()}));
    add_heights(views.back().second, k.map_from_base * map.base_from_camera(), map, heights);
  }
  const double floor = estimate_floor_height(heights);
  std::vector<KeyframeScan> out;
  for (const auto& [id, depth] : views) {
    const Se3& pose = map.keyframe(id).map_from_base;
    const TPose2D planar = to_planar(pose);
    Se3 level_from_camera = from_planar(planar).inverse() * pose * map.base_from_camera();
    level_from_camera.translation.z() -= floor;
    out.push_back({planar, scanner.scan(depth, kMillimetre, level_from_camera)});
  }
  return out;
}

}  // namespace rovigo::slam
