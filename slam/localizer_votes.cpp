#include "slam/localizer_votes.h"

#include <algorithm>
#include <cmath>

namespace rovigo::slam {

namespace {

constexpr double kSamePlaceM = 0.4;
constexpr double kSamePlaceRad = 0.2;
constexpr double kKeptShare = 0.98;  // a frame; half is left after 34
constexpr double kForgottenWeight = 0.02;

bool is_same(const Se3& a, const Se3& b) {
  return (a.translation - b.translation).head<2>().norm() < kSamePlaceM &&
         so3_log(a.rotation.transpose() * b.rotation).norm() < kSamePlaceRad;
}

}  // namespace

void PlaceVotes::add(double time_s, const Se3& map_from_base, const Se3& odom_from_base,
                     double weight) {
  for (PlaceVote& v : votes_) {
    if (!is_same(v.map_from_odom * odom_from_base, map_from_base)) continue;
    v.map_from_odom = map_from_base * odom_from_base.inverse();
    v.weight += weight;
    ++v.views;
    v.last_s = time_s;
    return;
  }
  votes_.push_back({map_from_base * odom_from_base.inverse(), weight, 1, time_s});
}

void PlaceVotes::fade() {
  for (PlaceVote& v : votes_) v.weight *= kKeptShare;
  std::erase_if(votes_, [](const PlaceVote& v) { return v.weight < kForgottenWeight; });
}

std::optional<PlaceVote> PlaceVotes::best() const {
  const auto it =
      std::max_element(votes_.begin(), votes_.end(),
                       [](const PlaceVote& a, const PlaceVote& b) { return a.weight < b.weight; });
  if (it == votes_.end()) return std::nullopt;
  return *it;
}

PlaceVotes::Split PlaceVotes::split(const Se3& map_from_base, const Se3& odom_from_base) const {
  Split out;
  for (const PlaceVote& v : votes_) {
    if (is_same(v.map_from_odom * odom_from_base, map_from_base)) {
      out.here += v.weight;
      out.views_here += v.views;
    } else {
      out.elsewhere = std::max(out.elsewhere, v.weight);
    }
  }
  return out;
}

void PlaceVotes::refute(const Se3& map_from_base, const Se3& odom_from_base) {
  std::erase_if(votes_, [&](const PlaceVote& v) {
    return is_same(v.map_from_odom * odom_from_base, map_from_base);
  });
}

}  // namespace rovigo::slam
