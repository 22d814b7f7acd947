#include "planning/shortcut.h"

#include <algorithm>
#include <array>

namespace rovigo::planning {

namespace {

/// Straight segments may cost this much more than what they replace: steps between costs of
/// neighbouring cells are no reason for a bend.
constexpr double kCostSlack = 1.005;
constexpr double kCostSlackCells = 0.2;

class StringPuller {
 public:
  StringPuller(const FreeSpace& space, const Path& path, double soft_cost_weight)
      : space_(space), points_(path.points), weight_(soft_cost_weight) {
    cost_so_far_.reserve(points_.size());
    cost_so_far_.push_back(0.0);
    for (std::size_t i = 1; i < points_.size(); ++i) {
      cost_so_far_.push_back(cost_so_far_.back() +
                             space_.cost(points_[i - 1], points_[i], weight_));
    }
  }

  bool is_straight(std::size_t from, std::size_t to) const {
    if (!space_.is_free(points_[from], points_[to])) return false;
    const double old_cost = cost_so_far_[to] - cost_so_far_[from];
    return space_.cost(points_[from], points_[to], weight_) <=
           kCostSlack * old_cost + kCostSlackCells * space_.geometry().resolution_m;
  }

  /// The furthest point that a straight segment from `from` reaches: doubling steps, then halving.
  std::size_t furthest(std::size_t from) const {
    const std::size_t last = points_.size() - 1;
    std::size_t good = from + 1;
    std::size_t step = 1;
    while (good < last) {
      const std::size_t next = std::min(good + step, last);
      if (!is_straight(from, next)) break;
      good = next;
      step *= 2;
    }
    for (; step > 0; step /= 2) {
      if (good + step <= last && is_straight(from, good + step)) good += step;
    }
    return good;
  }

 private:
  const FreeSpace& space_;
  const std::vector<TPoint2D>& points_;
  double weight_;
  std::vector<double> cost_so_far_;
};

/// Cuts legs into equal pieces no longer than `spacing_m`.
Path divided(const Path& path, double spacing_m) {
  Path out;
  if (!path.points.empty()) out.points.push_back(path.points.front());
  for (std::size_t i = 1; i < path.points.size(); ++i) {
    const TPoint2D& a = path.points[i - 1];
    const TPoint2D& b = path.points[i];
    const int n = std::max(1, static_cast<int>(maps::distance(a, b) / spacing_m + 1.0));
    for (int k = 1; k < n; ++k) {
      const double f = static_cast<double>(k) / n;
      out.points.push_back({a.x + f * (b.x - a.x), a.y + f * (b.y - a.y)});
    }
    out.points.push_back(b);
  }
  return out;
}

ShortcutResult pull(const FreeSpace& space, const Path& path, double soft_cost_weight) {
  ShortcutResult result;
  if (path.points.empty()) return result;
  const StringPuller puller(space, path, soft_cost_weight);
  result.path.points.push_back(path.points.front());
  for (std::size_t at = 0; at + 1 < path.points.size();) {
    const std::size_t next = puller.furthest(at);
    if (next == at + 1 && !space.is_free(path.points[at], path.points[next])) {
      const auto round = space.way_round(path.points[at], path.points[next]);
      if (!round) return {.ok = false, .blocked = at, .path = {}};
      result.path.points.insert(result.path.points.end(), round->begin(), round->end());
    }
    result.path.points.push_back(path.points[next]);
    at = next;
  }
  return result;
}

/// Pulls the string tight: every vertex goes towards the line between its neighbours as far as that
/// is free and cheaper. What string pulling leaves are cells of the search's path, not corners.
void tighten(const FreeSpace& space, Path& path, double soft_cost_weight) {
  constexpr int kSweeps = 3;
  constexpr std::array<double, 4> kShares{1.0, 0.5, 0.25, 0.1};
  std::vector<TPoint2D>& p = path.points;
  const auto cost = [&](const TPoint2D& a, const TPoint2D& b) {
    return space.cost(a, b, soft_cost_weight);
  };
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (std::size_t i = 1; i + 1 < p.size(); ++i) {
      const TPoint2D &a = p[i - 1], &b = p[i + 1];
      const TPoint2D along = b - a;
      const double length2 = along.x * along.x + along.y * along.y;
      if (length2 <= 0.0) continue;
      const TPoint2D off = p[i] - a;
      const double f = std::clamp((off.x * along.x + off.y * along.y) / length2, 0.0, 1.0);
      const TPoint2D foot{a.x + f * along.x, a.y + f * along.y};
      const double old_cost = cost(a, p[i]) + cost(p[i], b);
      for (const double share : kShares) {
        const TPoint2D moved{p[i].x + share * (foot.x - p[i].x),
                             p[i].y + share * (foot.y - p[i].y)};
        if (!space.is_free(a, moved) || !space.is_free(moved, b)) continue;
        if (cost(a, moved) + cost(moved, b) >= old_cost) continue;
        p[i] = moved;
        break;
      }
    }
  }
}

}  // namespace

ShortcutResult shortcut(const FreeSpace& space, const Path& path, double soft_cost_weight) {
  ShortcutResult forward = pull(space, path, soft_cost_weight);
  if (!forward.ok || forward.path.points.size() < 3) return forward;
  // A second pass from the other end over divided legs straightens what greed left bent.
  constexpr double kDivision = 8.0;  // cells
  Path back = divided(forward.path, kDivision * space.geometry().resolution_m);
  std::reverse(back.points.begin(), back.points.end());
  ShortcutResult second = pull(space, back, soft_cost_weight);
  if (!second.ok) return forward;
  std::reverse(second.path.points.begin(), second.path.points.end());
  tighten(space, second.path, soft_cost_weight);
  return second;
}

}  // namespace rovigo::planning
