#include "slam/view_slide.h"

#include <algorithm>
#include <cmath>

#include "slam/place_match.h"

namespace rovigo::slam {

namespace {

constexpr std::size_t kMostFeatures = 400;  // evenly taken; more say the same again
constexpr int kAlikeBits = 50;              // of 256
constexpr double kSameHeightM = 0.06;       // tilt, and the depth's own error
constexpr double kCellM = 0.06;             // with its neighbours: the depth's error across a room
constexpr int kHalf = static_cast<int>(ViewSlide::kReachM / kCellM);
constexpr int kSide = 2 * kHalf + 1;
constexpr std::size_t kMostPlaces = 6;
constexpr double kApartM = 0.18;
constexpr double kLeastShare = 0.5;  // of the best, to be told

/// Votes over shifts, each feature once a cell; a vote counts for the cells around it, too.
class Votes {
 public:
  Votes() : cells_(static_cast<std::size_t>(kSide) * kSide) {}

  void add(int feature, const Eigen::Vector2d& shift) {
    const int x = static_cast<int>(std::lround(shift.x() / kCellM)) + kHalf;
    const int y = static_cast<int>(std::lround(shift.y() / kCellM)) + kHalf;
    for (int v = std::max(0, y - 1); v <= std::min(kSide - 1, y + 1); ++v) {
      for (int u = std::max(0, x - 1); u <= std::min(kSide - 1, x + 1); ++u) {
        Cell& c = at(u, v);
        if (c.last == feature) continue;
        c.last = feature;
        ++c.features;
        c.sum += shift;
      }
    }
  }

  /// The mean of a cell's votes, which is finer than the cell.
  std::vector<Slide> slides(int least) const {
    std::vector<Slide> out;
    for (const Cell& c : cells_) {
      if (c.features >= least) out.push_back({c.sum / c.features, c.features});
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const Slide& a, const Slide& b) { return a.features > b.features; });
    return out;
  }

  int most(double within_m) const {
    int out = 0;
    for (const Cell& c : cells_) {
      if (c.features > out && c.sum.norm() <= within_m * c.features) out = c.features;
    }
    return out;
  }

 private:
  struct Cell {
    int features = 0;
    int last = -1;
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  };
  Cell& at(int x, int y) {
    return cells_[static_cast<std::size_t>(y) * kSide + static_cast<std::size_t>(x)];
  }
  std::vector<Cell> cells_;
};

}  // namespace

ViewSlide::ViewSlide(const LandmarkMap& map) : map_(map) {
  for (std::size_t l = 0; l < map.landmarks().size(); ++l) {
    const Landmark& landmark = map.landmark(static_cast<int>(l));
    if (landmark.alive && is_upright(landmark)) {
      upright_.push_back({landmark.position_map.z(), static_cast<int>(l)});
    }
  }
  std::stable_sort(upright_.begin(), upright_.end(),
                   [](const Upright& a, const Upright& b) { return a.height_m < b.height_m; });
}

SlideSpectrum ViewSlide::around(const FeatureSet& features, const Se3& map_from_base) const {
  Votes votes;
  const std::size_t step = std::max<std::size_t>(1, features.size() / kMostFeatures);
  for (std::size_t i = 0; i < features.size(); i += step) {
    const Feature& f = features[i];
    if (f.depth_m <= 0) continue;
    const Eigen::Vector3d p =
        map_from_base *
        (map_.base_from_camera() * map_.camera().unproject(f.pixel.cast<double>(), f.depth_m));
    const auto low =
        std::lower_bound(upright_.begin(), upright_.end(), p.z() - kSameHeightM,
                         [](const Upright& u, double height_m) { return u.height_m < height_m; });
    for (auto it = low; it != upright_.end() && it->height_m <= p.z() + kSameHeightM; ++it) {
      const Landmark& l = map_.landmark(it->landmark);
      const Eigen::Vector2d shift = (l.position_map - p).head<2>();
      if (shift.cwiseAbs().maxCoeff() > kReachM) continue;
      if (hamming_distance(l.descriptor, features.descriptor(i)) > kAlikeBits) continue;
      votes.add(static_cast<int>(i), shift);
    }
  }
  SlideSpectrum out;
  out.here = votes.most(kHereM);
  const int least = std::max(1, static_cast<int>(kLeastShare * votes.most(2.0 * kReachM)));
  for (const Slide& s : votes.slides(least)) {
    const double away_m = s.shift_map.norm();
    const bool slope = away_m <= kHereM || (away_m < kApartM && out.here >= s.features) ||
                       std::any_of(out.elsewhere.begin(), out.elsewhere.end(), [&](const Slide& o) {
                         return (o.shift_map - s.shift_map).norm() < kApartM;
                       });
    if (!slope && out.elsewhere.size() < kMostPlaces) out.elsewhere.push_back(s);
  }
  return out;
}

}  // namespace rovigo::slam
