#include "slam/place_match.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <random>

namespace rovigo::slam {

namespace {

constexpr int kSamples = 250;
constexpr double kSampleGatePx = 8.0;  // mild: a sample of three noisy depths is rough
constexpr double kRatio = 0.85;
constexpr double kSameHeightM = 0.06;     // a rover on its floor sees a point at the height it has,
constexpr double kHeightPerRange = 0.02;  // give or take tilt and the depth's own error
constexpr double kFloorM = 0.06;          // landmarks below lie on the floor
constexpr double kCeilingM = 1.9;         // and above may hang from the ceiling
constexpr double kMinBaselineM = 0.3;     // of two points, across the floor

struct Pair {
  Eigen::Vector3d point_map;
  Eigen::Vector3d point_base;  ///< as measured now; only if has_depth
  Eigen::Vector2d pixel;
  double gate_px = kSampleGatePx;
  bool has_depth = false;
};

std::vector<Pair> pairs_of(const LandmarkMap& map, const std::vector<FeatureMatch>& matches,
                           const FeatureSet& features) {
  std::vector<Pair> pairs;
  for (const FeatureMatch& m : matches) {
    const Feature& f = features[static_cast<std::size_t>(m.feature)];
    Pair p;
    p.point_map = map.landmark(m.landmark).position_map;
    p.pixel = f.pixel.cast<double>();
    p.has_depth = f.depth_m > 0;
    p.gate_px = kSampleGatePx * std::sqrt(octave_scale(f.octave, map.config().features));
    p.point_base = map.base_from_camera() * map.camera().unproject(p.pixel, f.depth_m);
    pairs.push_back(p);
  }
  return pairs;
}

int count_agreeing(const LandmarkMap& map, const std::vector<Pair>& pairs,
                   const Se3& map_from_base) {
  const Se3 camera_from_map = (map_from_base * map.base_from_camera()).inverse();
  int n = 0;
  for (const Pair& p : pairs) {
    const Eigen::Vector3d c = camera_from_map * p.point_map;
    if (c.z() < 0.1) continue;
    n += (map.camera().project(c) - p.pixel).squaredNorm() < p.gate_px * p.gate_px;
  }
  return n;
}

/// Three points known in both frames fix a rigid motion; nothing for a triple that is not rigid.
std::optional<Se3> fit_triple(const std::vector<const Pair*>& solid, std::mt19937_64& random) {
  std::vector<Eigen::Vector3d> source, target;
  for (int k = 0; k < 3; ++k) {
    const Pair& p = *solid[random() % solid.size()];
    source.push_back(p.point_base);
    target.push_back(p.point_map);
  }
  // A rigid scene keeps its distances: most wrong triples fail here, before the fit.
  for (std::size_t k = 0; k < 3; ++k) {
    const double a = (source[k] - source[(k + 1) % 3]).norm();
    const double b = (target[k] - target[(k + 1) % 3]).norm();
    if (!(a > 0.1 && b > 0.1 && std::abs(a - b) < 0.1 + 0.05 * (a + b))) return std::nullopt;
  }
  return fit_rigid(source, target);
}

/// On the floor two points are enough: the direction between them is the heading.
std::optional<Se3> fit_pair(const std::vector<const Pair*>& solid, std::mt19937_64& random) {
  const Pair& p = *solid[random() % solid.size()];
  const Pair& q = *solid[random() % solid.size()];
  const Eigen::Vector2d source = (q.point_base - p.point_base).head<2>();
  const Eigen::Vector2d target = (q.point_map - p.point_map).head<2>();
  const double a = source.norm(), b = target.norm();
  if (!(a > kMinBaselineM && b > kMinBaselineM && std::abs(a - b) < 0.05 + 0.03 * (a + b))) {
    return std::nullopt;
  }
  const double yaw =
      maps::wrap_angle(std::atan2(target.y(), target.x()) - std::atan2(source.y(), source.x()));
  const Eigen::Vector2d from = 0.5 * (p.point_base + q.point_base).head<2>();
  const Eigen::Vector2d to = 0.5 * (p.point_map + q.point_map).head<2>();
  const TPoint2D turned = maps::transform(TPose2D(0.0, 0.0, yaw), {from.x(), from.y()});
  return from_planar({to.x() - turned.x, to.y() - turned.y, yaw});
}

/// RANSAC (Fischler & Bolles 1981) over the fewest points that fix a pose.
std::pair<int, Se3> best_sample(const LandmarkMap& map, const std::vector<Pair>& pairs,
                                bool on_floor, std::uint64_t seed) {
  std::vector<const Pair*> solid;
  for (const Pair& p : pairs) {
    if (p.has_depth) solid.push_back(&p);
  }
  std::pair<int, Se3> best{0, Se3{}};
  if (solid.size() < 6) return best;
  std::mt19937_64 random(seed);
  int samples = kSamples;
  for (int i = 0; i < samples; ++i) {
    const auto fit = on_floor ? fit_pair(solid, random) : fit_triple(solid, random);
    if (!fit) {
      if (samples < 8 * kSamples) ++samples;  // a cheap miss does not use up a sample
      continue;
    }
    const int agreeing = count_agreeing(map, pairs, *fit);
    if (agreeing > best.first) best = {agreeing, *fit};
    if (best.first * 10 > static_cast<int>(pairs.size()) * 7) break;
  }
  return best;
}

/// Matches that a rover on its floor may believe: a corner keeps its height.
void drop_other_heights(const LandmarkMap& map, const FeatureSet& features,
                        std::vector<FeatureMatch>& matches) {
  std::erase_if(matches, [&](const FeatureMatch& m) {
    const Feature& f = features[static_cast<std::size_t>(m.feature)];
    if (f.depth_m <= 0) return false;
    const Eigen::Vector3d here =
        map.base_from_camera() * map.camera().unproject(f.pixel.cast<double>(), f.depth_m);
    return std::abs(here.z() - map.landmark(m.landmark).position_map.z()) >
           kSameHeightM + kHeightPerRange * f.depth_m;
  });
}

PosePrior6 floor_prior(const Se3& near, const TrackingConfig& config) {
  PosePrior6 prior;
  prior.map_from_base = from_planar(to_planar(near));
  prior.information(2, 2) = 1.0 / std::pow(config.plane_height_sigma_m, 2);
  prior.information(3, 3) = prior.information(4, 4) =
      1.0 / std::pow(config.plane_tilt_sigma_rad, 2);
  return prior;
}

}  // namespace

bool is_upright(const Landmark& landmark) {
  return landmark.position_map.z() > kFloorM && landmark.position_map.z() < kCeilingM;
}

std::optional<Se3> fit_rigid(const std::vector<Eigen::Vector3d>& source,
                             const std::vector<Eigen::Vector3d>& target) {
  if (source.size() < 3 || source.size() != target.size()) return std::nullopt;
  Eigen::Vector3d ms = Eigen::Vector3d::Zero(), mt = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < source.size(); ++i) {
    ms += source[i];
    mt += target[i];
  }
  ms /= static_cast<double>(source.size());
  mt /= static_cast<double>(source.size());
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < source.size(); ++i) {
    cross += (target[i] - mt) * (source[i] - ms).transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (svd.singularValues()(1) < 1e-3 * svd.singularValues()(0)) return std::nullopt;  // in line
  Eigen::Matrix3d flip = Eigen::Matrix3d::Identity();
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) flip(2, 2) = -1;
  Se3 out;
  out.rotation = svd.matrixU() * flip * svd.matrixV().transpose();
  out.translation = mt - out.rotation * ms;
  return out;
}

std::vector<FeatureMatch> match_by_appearance(const LandmarkMap& map,
                                              const std::vector<int>& landmarks,
                                              const FeatureSet& features) {
  struct Owner {
    int landmark = -1;
    int distance = 257;
  };
  std::vector<Owner> owner(features.size());
  for (const int l : landmarks) {
    const NearestTwo n =
        nearest_two(map.landmark(l).descriptor, features.descriptors().data(), features.size());
    if (n.index < 0 || n.best > map.config().tracking.max_descriptor_distance) continue;
    if (n.best > kRatio * n.second) continue;
    Owner& o = owner[static_cast<std::size_t>(n.index)];
    if (n.best < o.distance) o = {l, n.best};
  }
  std::vector<FeatureMatch> matches;
  for (std::size_t i = 0; i < owner.size(); ++i) {
    if (owner[i].landmark >= 0) matches.push_back({owner[i].landmark, static_cast<int>(i)});
  }
  return matches;
}

PlaceMatch match_place(const LandmarkMap& map, const std::vector<int>& core,
                       const std::vector<int>& wide, const FeatureSet& features, bool on_floor,
                       const PlaceMatchConfig& config) {
  PlaceMatch out;
  const TrackingConfig& tracking = map.config().tracking;
  auto by_appearance = match_by_appearance(map, core, features);
  if (on_floor) drop_other_heights(map, features, by_appearance);
  out.appearance_matches = static_cast<int>(by_appearance.size());
  if (out.appearance_matches < 10) return out;

  const auto sample =
      best_sample(map, pairs_of(map, by_appearance, features), on_floor, config.seed);
  out.sample_inliers = sample.first;
  if (sample.first < 10) return out;

  Se3 pose = sample.second;
  out.matches = by_appearance;
  // Two rounds of matching by the pose found, over ever more of the surroundings.
  for (const double radius_px : {0.0, 1.5 * tracking.search_radius_px, 6.0}) {
    if (radius_px > 0) {
      out.matches =
          match_by_projection(map, visible_landmarks(map, wide, pose), features, radius_px);
    }
    std::optional<PosePrior6> prior;
    if (on_floor) prior = floor_prior(pose, tracking);
    out.solution = optimize_pose(observations_of(map, out.matches, features, pose, 0.0), pose,
                                 prior, map.camera(), map.base_from_camera());
    if (out.solution.inliers < 10 || !is_finite(out.solution.map_from_base)) return out;
    pose = out.solution.map_from_base;
  }
  const auto tried = static_cast<double>(out.matches.size());
  std::vector<FeatureMatch> inliers;
  for (std::size_t i = 0; i < out.matches.size(); ++i) {
    if (out.solution.is_inlier[i]) inliers.push_back(out.matches[i]);
  }
  out.matches = std::move(inliers);
  out.upright_inliers =
      static_cast<int>(std::count_if(out.matches.begin(), out.matches.end(), [&](const auto& m) {
        return is_upright(map.landmark(m.landmark));
      }));
  const bool stands =
      !on_floor || out.upright_inliers >= config.min_upright_share * config.min_inliers;
  out.accepted = stands && out.solution.inliers >= config.min_inliers &&
                 out.solution.inliers >= config.min_inlier_share * tried &&
                 !out.solution.degenerate;
  return out;
}

}  // namespace rovigo::slam
