#include "slam/scan_search.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "maps/distance_field.h"

namespace rovigo::slam {

namespace {

constexpr int kFull = 100;     // a point on a wall
constexpr int kUnknown = 60;   // on ground nobody has seen
constexpr double kOnM = 0.08;  // this near to a wall's cells is on it; it fades out
constexpr double kOffM = 0.20;
constexpr double kOutsideM = 0.25;  // the rover stands on free ground, or hardly off it
constexpr int kHeadings = 180;
constexpr int kPad = 32;  // the largest window reaches over the grid's low edges
constexpr std::size_t kMostNodes = 300000;
constexpr double kSamePlaceM = 0.5, kSamePlaceRad = 0.35;

double heading_of(int heading) { return maps::wrap_angle(2.0 * maps::kPi * heading / kHeadings); }

int wall_score(double distance_m) {
  const double fade = (kOffM - distance_m) / (kOffM - kOnM);
  return static_cast<int>(kFull * std::clamp(fade, 0.0, 1.0));
}

maps::DistanceField distance_to_free(const maps::OccupancyGrid& grid) {
  maps::OccupancyGrid free = grid;
  for (auto& cell : free.cells) {
    cell = maps::OccupancyGrid::is_free(cell) ? maps::OccupancyGrid::kOccupied
                                              : maps::OccupancyGrid::kFree;
  }
  return maps::distance_to_occupied(free);
}

bool is_same_place(const TPose2D& a, const TPose2D& b) {
  return maps::distance(maps::position_of(a), maps::position_of(b)) < kSamePlaceM &&
         std::abs(maps::wrap_angle(a.phi - b.phi)) < kSamePlaceRad;
}

}  // namespace

bool ScanSearch::Node::operator<(const Node& other) const {
  return std::tie(score, other.level, other.heading, other.y, other.x) <
         std::tie(other.score, level, heading, y, x);
}

ScanSearch::ScanSearch(const maps::OccupancyGrid& grid)
    : geometry_(grid.geometry),
      stride_(grid.geometry.width + kPad),
      rows_(grid.geometry.height + kPad),
      blocked_(grid.cells.size()) {
  const maps::DistanceField walls = maps::distance_to_occupied(grid);
  const maps::DistanceField free_ground = distance_to_free(grid);
  windows_.emplace_back(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(rows_),
                        static_cast<std::uint8_t>(kUnknown));
  for (int y = 0; y < geometry_.height; ++y) {
    for (int x = 0; x < geometry_.width; ++x) {
      const std::size_t i = geometry_.index_of({x, y});
      blocked_[i] = maps::OccupancyGrid::is_occupied(grid.cells[i]) ||
                    free_ground.meters[i] > static_cast<float>(kOutsideM);
      const int wall = wall_score(walls.meters[i]);
      const bool unknown = maps::OccupancyGrid::is_unknown(grid.cells[i]);
      windows_[0][static_cast<std::size_t>((y + kPad) * stride_ + x + kPad)] =
          static_cast<std::uint8_t>(unknown ? std::max(kUnknown, wall) : wall);
    }
  }
  for (int level = 1; level < kLevels; ++level) widen(level);
}

/// The best of a window of 2^k cells is the best of four of 2^(k-1).
void ScanSearch::widen(int level) {
  const int half = 1 << (level - 1);
  auto& wide = windows_.emplace_back(windows_[0].size());
  const auto narrow = [&](int x, int y) { return window(level - 1, x, y); };
  for (int y = -kPad; y < geometry_.height; ++y) {
    for (int x = -kPad; x < geometry_.width; ++x) {
      wide[static_cast<std::size_t>((y + kPad) * stride_ + x + kPad)] =
          static_cast<std::uint8_t>(std::max({narrow(x, y), narrow(x + half, y),
                                              narrow(x, y + half), narrow(x + half, y + half)}));
    }
  }
}

int ScanSearch::window(int level, int x, int y) const {
  const int column = x + kPad, row = y + kPad;
  if (column < 0 || row < 0 || column >= stride_ || row >= rows_) return kUnknown;
  return windows_[static_cast<std::size_t>(level)]
                 [static_cast<std::size_t>(row) * static_cast<std::size_t>(stride_) +
                  static_cast<std::size_t>(column)];
}

int ScanSearch::score(const Cells& cells, int level, int x, int y) const {
  int sum = 0;
  for (const maps::Cell& c : cells) sum += window(level, c.x + x, c.y + y);
  return sum;
}

bool ScanSearch::may_stand(int x, int y) const {
  return x < geometry_.width && y < geometry_.height && !blocked_[geometry_.index_of({x, y})];
}

std::vector<ScanSearch::Cells> ScanSearch::turn(const std::vector<TPoint2D>& points) const {
  std::vector<Cells> turned(kHeadings);
  for (int h = 0; h < kHeadings; ++h) {
    const TPose2D pose(0.0, 0.0, heading_of(h));
    for (const TPoint2D& p : points) {
      const TPoint2D q = maps::transform(pose, p);
      turned[static_cast<std::size_t>(h)].push_back(
          {static_cast<int>(std::lround(q.x / geometry_.resolution_m)),
           static_cast<int>(std::lround(q.y / geometry_.resolution_m))});
    }
  }
  return turned;
}

/// Takes a node in if it may still hold something good enough.
void ScanSearch::consider(Search& search, int level, int heading, int x, int y) const {
  const bool outside = x >= geometry_.width || y >= geometry_.height;
  if (outside || (level == 0 && !may_stand(x, y))) return;
  ++search.nodes;
  const int sum = score(search.turned[static_cast<std::size_t>(heading)], level, x, y);
  if (sum >= search.least) search.open.push({sum, level, heading, x, y});
}

ScanSearchResult ScanSearch::find(const std::vector<TPoint2D>& points, double min_share,
                                  double below_best, std::size_t most) const {
  ScanSearchResult out;
  if (points.empty() || blocked_.empty()) return out;
  const double full = kFull * static_cast<double>(points.size());
  const auto score_of = [&](double share) { return static_cast<int>(std::ceil(share * full)); };
  Search search{turn(points), {}, score_of(min_share), 0};
  const int window = 1 << (kLevels - 1);
  for (int h = 0; h < kHeadings; ++h) {
    for (int y = 0; y < geometry_.height; y += window) {
      for (int x = 0; x < geometry_.width; x += window) consider(search, kLevels - 1, h, x, y);
    }
  }
  search.nodes = 0;  // the limit is on what has to be opened, whatever the map's size
  // Best first: what comes out as a single cell is better than all that is left.
  while (!search.open.empty() && out.places.size() < most) {
    const Node node = search.open.top();
    search.open.pop();
    if (node.score < search.least) break;
    if (node.level > 0) {
      if (search.nodes > kMostNodes) {
        out.complete = false;
        break;
      }
      const int half = 1 << (node.level - 1);
      for (const int dy : {0, half}) {
        for (const int dx : {0, half}) {
          consider(search, node.level - 1, node.heading, node.x + dx, node.y + dy);
        }
      }
      continue;
    }
    const TPoint2D at = geometry_.center_of({node.x, node.y});
    const ScanPlace place{{at.x, at.y, heading_of(node.heading)}, node.score / full};
    if (out.places.empty()) {
      search.least = std::max(search.least, score_of(place.share - below_best));
    }
    const bool known = std::any_of(out.places.begin(), out.places.end(), [&](const ScanPlace& p) {
      return is_same_place(p.map_from_scan, place.map_from_scan);
    });
    if (!known) out.places.push_back(place);
  }
  return out;
}

}  // namespace rovigo::slam
