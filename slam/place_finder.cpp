#include "slam/place_finder.h"

#include <algorithm>
#include <cmath>

namespace rovigo::slam {

namespace {

constexpr double kSamePlaceM = 0.4, kSamePlaceRad = 0.2;
constexpr double kKeptShare = 0.98;  // of a recognition's weight, a frame; half is left after 34
constexpr double kForgottenWeight = 0.02;
constexpr std::size_t kMostViews = 24;     // three radians of turning
constexpr double kDoubtedSurface = 500.0;  // points, about one view's: so many are taken on trust
constexpr std::size_t kFewPoints = 40;     // fit anywhere
constexpr std::size_t kSearchPoints = 150;
constexpr double kLeastFit = 0.55, kBelowBest = 0.2;  // shares of the points
constexpr std::size_t kMostPlaces = 6, kMostCandidates = 16;
// A fortieth of the shape weighs as much as one clear view: views repeat, walls less so.
constexpr double kShapeWeight = 40.0, kMostRecognitions = 4.0;
constexpr double kRefutationWeight = 3.0;
constexpr double kRefuted = 0.06;  // of the shape: so much worse than another place
// Of a place found cell by cell, and of the odometry since.
constexpr double kPlaceSigmaM = 0.08, kPlaceSigmaRad = 0.04;

bool is_same(const Se3& a, const Se3& b) {
  return (a.translation - b.translation).head<2>().norm() < kSamePlaceM &&
         so3_log(a.rotation.transpose() * b.rotation).norm() < kSamePlaceRad;
}

double weight_of(const PlaceCandidate& c) {
  return kShapeWeight * c.shape() + std::min(c.recognitions, kMostRecognitions) -
         kRefutationWeight * c.refutations;
}

/// Evenly taken, so that a search costs the same in large rooms and small ones.
std::vector<TPoint2D> some_of(const std::vector<ScanPoint>& points) {
  const std::size_t step = std::max<std::size_t>(1, points.size() / kSearchPoints);
  std::vector<TPoint2D> out;
  for (std::size_t i = 0; i < points.size(); i += step) out.push_back(points[i].base_point);
  return out;
}

}  // namespace

PlaceFinder::PlaceFinder(const maps::OccupancyGrid& grid, DepthMemory depths)
    : depths_(std::move(depths)) {
  if (grid.cells.empty()) return;
  field_.emplace(grid);
  scan_search_.emplace(grid);
}

bool PlaceFinder::see(double time_s, const Se3& odom_from_base, const std::vector<ScanPoint>& scan,
                      const cv::Mat& depth, double depth_unit_m, bool jumped) {
  if (!field_) return false;
  const bool is_new = local_scan_.add(time_s, to_planar(odom_from_base), scan, jumped);
  if (is_new) {
    views_.push_back({time_s, odom_from_base, depths_.view_of(depth, depth_unit_m)});
    if (views_.size() > kMostViews) views_.pop_front();
  }
  points_ = local_scan_.points(to_planar(odom_from_base));
  return is_new || unsearched_;
}

void PlaceFinder::recognize(const Se3& map_from_base, const Se3& odom_from_base, double weight) {
  for (PlaceCandidate& c : candidates_) {
    if (!is_same(c.map_from_odom * odom_from_base, map_from_base)) continue;
    // Along a wall features say more than its shape, which alone has proposed this so far.
    if (c.recognitions == 0.0) c.map_from_odom = map_from_base * odom_from_base.inverse();
    c.recognitions += weight;
    return;
  }
  candidates_.push_back({map_from_base * odom_from_base.inverse(), weight});
  refine(candidates_.back(), odom_from_base);
}

void PlaceFinder::refute(const Se3& map_from_base, const Se3& odom_from_base) {
  for (PlaceCandidate& c : candidates_) {
    if (!is_same(c.map_from_odom * odom_from_base, map_from_base)) continue;
    c.recognitions = 0.0;
    c.refutations += 1.0;
  }
}

void PlaceFinder::fade() {
  for (PlaceCandidate& c : candidates_) {
    c.refutations *= kKeptShare;
    c.recognitions *= kKeptShare;
    if (c.recognitions < kForgottenWeight) c.recognitions = 0.0;
  }
}

void PlaceFinder::propose(const Se3& map_from_odom, const Se3& odom_from_base) {
  const Se3 map_from_base = map_from_odom * odom_from_base;
  const bool known =
      std::any_of(candidates_.begin(), candidates_.end(), [&](const PlaceCandidate& c) {
        return is_same(c.map_from_odom * odom_from_base, map_from_base);
      });
  if (!known) candidates_.push_back({map_from_odom});
}

void PlaceFinder::search(const Se3& odom_from_base, const std::optional<PoseRegion>& region) {
  unsearched_ = false;
  if (scan_search_ && points_.size() >= kFewPoints) {
    const auto found = scan_search_->find(some_of(points_), kLeastFit, kBelowBest, kMostPlaces);
    knows_all_rivals_ = found.complete;
    for (const ScanPlace& place : found.places) {
      const Se3 map_from_base = from_planar(place.map_from_scan);
      if (region && !region->contains(map_from_base)) continue;
      propose(map_from_base * odom_from_base.inverse(), odom_from_base);
    }
  }
  judge(odom_from_base);
}

void PlaceFinder::judge(const Se3& odom_from_base) {
  for (PlaceCandidate& c : candidates_) refine(c, odom_from_base);
  tidy(odom_from_base);
}

/// Slides the local scan to where it fits best around the candidate.
void PlaceFinder::refine(PlaceCandidate& candidate, const Se3& odom_from_base) const {
  if (!field_ || points_.size() < kFewPoints) return;
  const TPose2D before = to_planar(candidate.map_from_odom * odom_from_base);
  const Eigen::Vector3d sigma(kPlaceSigmaM, kPlaceSigmaM, kPlaceSigmaRad);
  const GridMatch match =
      match_scan(*field_, points_, before, sigma.cwiseAbs2().asDiagonal().toDenseMatrix());
  const TPose2D after = match.look.map_from_base;
  const double share_before = scan_agreement(*field_, points_, before).share;
  const double share_after = scan_agreement(*field_, points_, after).share;
  candidate.scan_share = std::max(share_before, share_after);
  if (share_after > share_before) {
    candidate.map_from_odom = from_planar(after) * odom_from_base.inverse();
  }
  candidate.surface_share = surface_share(candidate.map_from_odom);
}

double PlaceFinder::surface_share(const Se3& map_from_odom) const {
  DepthAgreement sum;
  for (const View& v : views_) {
    const DepthAgreement a = depths_.agreement(v.depth, map_from_odom * v.odom_from_base);
    sum.at_depth += a.at_depth;
    sum.seen_through += a.seen_through;
    sum.hidden += a.hidden;
  }
  // A glimpse of something that fits is no match for a room that does: few points leave it at what
  // nobody knows.
  const double judged = sum.at_depth + sum.seen_through + kDoubtedSurface;
  return (sum.at_depth + kDoubtedSurface * PlaceCandidate::kUnjudgedShare) / judged;
}

/// Candidates that came to be the same are joined, hopeless ones dropped.
void PlaceFinder::tidy(const Se3& odom_from_base) {
  std::stable_sort(candidates_.begin(), candidates_.end(),
                   [](const auto& a, const auto& b) { return weight_of(a) > weight_of(b); });
  std::vector<PlaceCandidate> kept;
  for (const PlaceCandidate& c : candidates_) {
    const auto same = std::find_if(kept.begin(), kept.end(), [&](const PlaceCandidate& k) {
      return is_same(k.map_from_odom * odom_from_base, c.map_from_odom * odom_from_base);
    });
    if (same != kept.end()) {
      same->recognitions += c.recognitions;
    } else if (c.recognitions > 0.0 || c.scan_share >= kLeastFit) {
      kept.push_back(c);
    }
  }
  if (kept.size() > kMostCandidates) kept.resize(kMostCandidates);
  candidates_ = std::move(kept);
}

std::optional<PlaceCandidate> PlaceFinder::best() const {
  const auto it =
      std::max_element(candidates_.begin(), candidates_.end(),
                       [](const auto& a, const auto& b) { return weight_of(a) < weight_of(b); });
  if (it == candidates_.end()) return std::nullopt;
  return *it;
}

bool PlaceFinder::is_best(const Se3& map_from_base, const Se3& odom_from_base) const {
  const auto found = best();
  return found && is_same(found->map_from_odom * odom_from_base, map_from_base);
}

PlaceSupport PlaceFinder::support(const Se3& map_from_base, const Se3& odom_from_base) const {
  PlaceSupport out;
  out.scan_points = static_cast<int>(points_.size());
  const bool by_shape = field_ && points_.size() >= kFewPoints;
  if (by_shape) {
    PlaceCandidate here{map_from_base * odom_from_base.inverse()};
    here.scan_share = scan_agreement(*field_, points_, to_planar(map_from_base)).share;
    here.surface_share = surface_share(here.map_from_odom);
    out.scan_share = here.scan_share;
    out.surface_share = here.surface_share;
    out.shape = here.shape();
  }
  // Nothing to tell them apart by, or a place as good may have been left unfound.
  if (!by_shape || !knows_all_rivals_) out.rival_shape = out.shape;
  for (const PlaceCandidate& c : candidates_) {
    if (is_same(c.map_from_odom * odom_from_base, map_from_base)) {
      out.recognitions += c.recognitions;
    } else {
      // A look-alike that the shape of its surroundings has refuted is no rival any more.
      if (!by_shape || c.shape() >= out.shape - kRefuted) {
        out.rival_recognitions = std::max(out.rival_recognitions, c.recognitions);
      }
      if (by_shape) out.rival_shape = std::max(out.rival_shape, c.shape());
    }
  }
  return out;
}

void PlaceFinder::clear_before(double time_s) {
  local_scan_.forget_before(time_s);
  while (!views_.empty() && views_.front().time_s < time_s) views_.pop_front();
  points_.clear();
  candidates_.clear();
  unsearched_ = true;
  knows_all_rivals_ = false;
}

}  // namespace rovigo::slam
