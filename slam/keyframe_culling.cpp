#include "slam/keyframe_culling.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "slam/local_map.h"

namespace rovigo::slam {

namespace {

constexpr int kLatest = 15;              // keyframes not yet looked back at
constexpr int kMinShared = 15;           // landmarks, for keyframes to show the same place
constexpr double kNearSpacing = 1.0;     // a host stands within one spacing
constexpr std::size_t kOtherViews = 3;   // enough to know a landmark by
constexpr double kKnownElsewhere = 0.9;  // share of its landmarks that makes a keyframe redundant
constexpr int kCrowd = 4;                // keyframes so near together: the least useful one goes
constexpr double kCrowdSpacing = 0.6;
constexpr double kLongestLinkS = 60.0;  // dead reckoning for longer ties nothing
// How well a keyframe is known against its host, which sees the same from near by.
constexpr double kRelationM = 0.004, kRelationRad = 0.002;

/// Share of a keyframe's landmarks that enough others see as finely.
double share_known_elsewhere(const LandmarkMap& map, const Keyframe& k) {
  int all = 0, known = 0;
  for (std::size_t i = 0; i < k.landmark_of.size(); ++i) {
    if (k.landmark_of[i] < 0) continue;
    ++all;
    std::size_t others = 0;
    for (const Sighting& s : map.landmark(k.landmark_of[i]).sightings) {
      if (s.keyframe == k.id) continue;
      const auto& f = map.keyframe(s.keyframe).features[static_cast<std::size_t>(s.feature)];
      others += f.octave <= k.features[i].octave + 1;
    }
    known += others >= kOtherViews;
  }
  return all > 0 ? static_cast<double>(known) / all : 0.0;
}

struct Candidate {
  Culling culling;
  double share = 0.0;
  int crowd = 0;  ///< keyframes so near, itself included
};

Candidate judged(const LandmarkMap& map, int keyframe) {
  Candidate c{{keyframe, -1}, share_known_elsewhere(map, map.keyframe(keyframe)), 1};
  double nearest = kNearSpacing;
  for (const auto& [other, shared] : map.covisible(keyframe, kMinShared)) {
    const double spacing =
        keyframe_spacing(map.keyframe(other).map_from_base, map.keyframe(keyframe).map_from_base,
                         map.config().tracking);
    c.crowd += spacing < kCrowdSpacing;
    if (spacing >= nearest) continue;
    nearest = spacing;
    c.culling.host = other;
  }
  return c;
}

Se3 host_from(const LandmarkMap& map, const Culling& c) {
  return map.keyframe(c.host).map_from_base.inverse() * map.keyframe(c.keyframe).map_from_base;
}

/// The same measurement towards a frame that is rigidly tied to the one it led to: `to_from_new`.
void extend(PoseGraphEdge& e, const Se3& to_from_new) {
  const Eigen::Matrix3d turned = to_from_new.rotation.transpose();
  Matrix6d adjoint = Matrix6d::Zero();
  adjoint.topLeftCorner<3, 3>() = adjoint.bottomRightCorner<3, 3>() = turned;
  adjoint.topRightCorner<3, 3>() = -turned * skew(to_from_new.translation);
  Matrix6d covariance = adjoint * e.information.inverse() * adjoint.transpose();
  covariance.diagonal().head<3>().array() += kRelationM * kRelationM;
  covariance.diagonal().tail<3>().array() += kRelationRad * kRelationRad;
  e.information = covariance.inverse();
  e.from_from_to = e.from_from_to * to_from_new;
}

MotionLink relation(int from, int to, double time_s, const Se3& from_from_to) {
  MotionLink link;
  link.from = from;
  link.to = to;
  link.begin_s = link.end_s = time_s;
  link.from_from_to = to_planar(from_from_to);
  link.covariance.diagonal() << kRelationM * kRelationM, kRelationM * kRelationM,
      kRelationRad * kRelationRad;
  return link;
}

}  // namespace

std::optional<Culling> dispensable_keyframe(const LandmarkMap& map) {
  const int newest = static_cast<int>(map.keyframes().size()) - 1;
  std::optional<Candidate> best;
  for (const auto& [id, shared] : map.covisible(newest, kMinShared)) {
    if (id == 0 || id > newest - kLatest) continue;
    const Candidate c = judged(map, id);
    if (c.culling.host < 0) continue;
    if (c.share < kKnownElsewhere && c.crowd <= kCrowd) continue;
    if (!best || c.share > best->share) best = c;
  }
  if (!best) return std::nullopt;
  return best->culling;
}

void rehang_edges(const LandmarkMap& map, const Culling& culling,
                  std::vector<PoseGraphEdge>& edges) {
  const Se3 host_from_keyframe = host_from(map, culling);
  std::vector<int> tied;  // to the host
  for (const PoseGraphEdge& e : edges) {
    if (e.from == culling.host) tied.push_back(e.to);
    if (e.to == culling.host) tied.push_back(e.from);
  }
  std::erase_if(edges, [&](PoseGraphEdge& e) {
    const bool begins = e.from == culling.keyframe, ends = e.to == culling.keyframe;
    if (!begins && !ends) return false;
    const int other = begins ? e.to : e.from;
    if (other == culling.host || std::find(tied.begin(), tied.end(), other) != tied.end()) {
      return true;
    }
    tied.push_back(other);
    (begins ? e.from : e.to) = culling.host;
    if (ends) extend(e, host_from_keyframe.inverse());
    if (begins) e.from_from_to = host_from_keyframe * e.from_from_to;
    return false;
  });
}

MotionLink chained(const MotionLink& a, const MotionLink& b) {
  const double c = std::cos(a.from_from_to.phi), s = std::sin(a.from_from_to.phi);
  // What does not depend on the calibration holds under any.
  const MotionCalibration at = a.by_calibration.isZero() ? b.calibration : a.calibration;
  const TPose2D then = b.under(at);
  Eigen::Matrix3d by_a = Eigen::Matrix3d::Identity(), by_b = Eigen::Matrix3d::Identity();
  by_a(0, 2) = -s * then.x - c * then.y;
  by_a(1, 2) = c * then.x - s * then.y;
  by_b.topLeftCorner<2, 2>() << c, -s, s, c;
  MotionLink out = a;
  out.to = b.to;
  out.end_s = b.end_s;
  out.from_from_to = maps::compose(a.from_from_to, then);
  out.by_calibration = by_a * a.by_calibration + by_b * b.by_calibration;
  out.covariance = by_a * a.covariance * by_a.transpose() + by_b * b.covariance * by_b.transpose();
  out.calibration = at;
  return out;
}

void rehang_links(const LandmarkMap& map, const Culling& culling, std::vector<MotionLink>& links) {
  const int gone = culling.keyframe;
  const Se3 host_from_gone = host_from(map, culling);
  const auto ending =
      std::find_if(links.begin(), links.end(), [&](const auto& l) { return l.to == gone; });
  const auto beginning =
      std::find_if(links.begin(), links.end(), [&](const auto& l) { return l.from == gone; });
  std::vector<MotionLink> kept;
  // Wheels make a chain: what led here leads on to where the next one leads.
  const bool joined = ending != links.end() && beginning != links.end() &&
                      !ending->by_calibration.isZero() && !beginning->by_calibration.isZero() &&
                      beginning->end_s - ending->begin_s < kLongestLinkS;
  for (const MotionLink& l : links) {
    if (joined && &l == &*beginning) continue;
    MotionLink link = l;
    if (joined && &l == &*ending) {
      link = chained(l, *beginning);
    } else if (l.to == gone) {
      link = chained(l, relation(gone, culling.host, l.end_s, host_from_gone.inverse()));
    } else if (l.from == gone) {
      link = chained(relation(culling.host, gone, l.begin_s, host_from_gone), l);
      link.begin_s = l.begin_s;
    }
    const bool moved = l.from == gone || l.to == gone;
    const bool known = moved && std::any_of(links.begin(), links.end(), [&](const auto& other) {
                         return other.from == link.from && other.to == link.to;
                       });
    if (link.from != link.to && !known) kept.push_back(link);
  }
  links = std::move(kept);
}

}  // namespace rovigo::slam
