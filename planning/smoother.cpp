#include "planning/smoother.h"

#include <algorithm>
#include <cmath>

#include "planning/penalized_fit.h"

namespace rovigo::planning {

namespace {

constexpr double kSmoothingLengthM = 0.5;  // bends are spread over about this length to each side
constexpr double kMostLevels = 3.5;        // halvings of that length where there is no room
constexpr double kTaperM = 0.25;           // path length per halving, so that lengths change slowly
constexpr double kComfortM = 0.10;         // kept beyond the radius where there is room
constexpr double kCurveMarginM = 5e-4;     // covers the sagitta between samples
constexpr double kUnmovedM = 1e-6;         // per round; the margin above covers all rounds
constexpr double kPivotTurnRad = 2.4;      // sharper vertices are turned at in place at once
constexpr double kPinWeight = 1e6;         // of via points, against the bending weight
constexpr int kPushRounds = 5;
constexpr int kRepairRounds = 16;
constexpr int kRefinements = 2;

double heading(const TPoint2D& a, const TPoint2D& b) { return std::atan2(b.y - a.y, b.x - a.x); }

/// A stretch of the polyline that is to become one curve.
struct Stretch {
  std::vector<TPoint2D> vertices;
  std::vector<char> pinned;  ///< per vertex
  std::optional<double> start_heading;
  double start_curvature = 0.0;
  std::optional<double> goal_heading;
};

Stretch part(const Stretch& whole, std::size_t first, std::size_t last) {
  const auto from = static_cast<std::ptrdiff_t>(first);
  const auto to = static_cast<std::ptrdiff_t>(last) + 1;
  Stretch out;
  out.vertices.assign(whole.vertices.begin() + from, whole.vertices.begin() + to);
  out.pinned.assign(whole.pinned.begin() + from, whole.pinned.begin() + to);
  if (first == 0) {
    out.start_heading = whole.start_heading;
    out.start_curvature = whole.start_curvature;
  }
  if (last + 1 == whole.vertices.size()) out.goal_heading = whole.goal_heading;
  return out;
}

/// Sites at equal distances along the stretch, anew from every pinned vertex.
struct Sites {
  std::vector<TPoint2D> points;
  std::vector<char> pinned;
};

void add_sites(const std::vector<TPoint2D>& vertices, std::size_t first, std::size_t last,
               double spacing, std::size_t least, Sites& sites) {
  double length = 0.0;
  for (std::size_t i = first; i < last; ++i) length += maps::distance(vertices[i], vertices[i + 1]);
  const auto n = std::max(least, static_cast<std::size_t>(std::ceil(length / spacing)));
  const double step = length / static_cast<double>(n);
  std::size_t leg = first;
  double leg_start = 0.0;
  double leg_length = maps::distance(vertices[leg], vertices[leg + 1]);
  for (std::size_t k = 1; k < n; ++k) {
    const double s = step * static_cast<double>(k);
    while (s > leg_start + leg_length && leg + 2 <= last) {
      leg_start += leg_length;
      ++leg;
      leg_length = maps::distance(vertices[leg], vertices[leg + 1]);
    }
    const double f = leg_length > 0.0 ? std::min(1.0, (s - leg_start) / leg_length) : 0.0;
    const TPoint2D& a = vertices[leg];
    const TPoint2D& b = vertices[leg + 1];
    sites.points.push_back({a.x + f * (b.x - a.x), a.y + f * (b.y - a.y)});
    sites.pinned.push_back(0);
  }
  sites.points.push_back(vertices[last]);
  sites.pinned.push_back(1);
}

Sites make_sites(const Stretch& stretch, double spacing) {
  Sites sites;
  sites.points.push_back(stretch.vertices.front());
  sites.pinned.push_back(1);
  std::size_t first = 0;
  for (std::size_t i = 1; i < stretch.vertices.size(); ++i) {
    const bool is_last = i + 1 == stretch.vertices.size();
    if (!is_last && !stretch.pinned[i]) continue;
    add_sites(stretch.vertices, first, i, spacing, 4, sites);
    first = i;
  }
  return sites;
}

/// Moves points that are nearer to an obstacle than comfortable away from it, except on the ridge
/// between two obstacles.
void push_from_obstacles(const FreeSpace& space, Sites& sites) {
  if (space.radius_m() <= 0.0) return;
  for (int round = 0; round < kPushRounds; ++round) {
    for (std::size_t i = 1; i + 1 < sites.points.size(); ++i) {
      if (sites.pinned[i]) continue;
      const FreeSpace::Slope slope = space.slope(sites.points[i]);
      const double missing = kComfortM - slope.room_m;
      const double norm = std::hypot(slope.gradient.x, slope.gradient.y);
      if (!(missing > 0.0) || norm < 0.5) continue;
      const double push = 0.5 * missing / norm;
      sites.points[i].x += push * slope.gradient.x;
      sites.points[i].y += push * slope.gradient.y;
    }
  }
}

/// Fits one stretch with one spacing of control points. The smoothing length is reduced locally
/// where the curve is not free, and eased again where it gets too tight.
class CurveFit {
 public:
  CurveFit(const FreeSpace& space, const SplineConfig& config, const Stretch& stretch,
           double spacing)
      : space_(space), config_(config), spacing_(spacing), sites_(make_sites(stretch, spacing)) {
    const std::size_t n = sites_.points.size();
    fit_.control = sites_.points;
    push_from_obstacles(space, sites_);
    fit_.targets = sites_.points;
    fit_.weights.assign(n, 1.0);
    fit_.bending.assign(n, 1.0);
    levels_.assign(n, 0.0);
    fit_.fixed.assign(n, 0);
    fit_.fixed.front() = fit_.fixed.back() = 1;
    const double reach = maps::distance(fit_.control[0], fit_.control[1]);
    const double reach_back = maps::distance(fit_.control[n - 1], fit_.control[n - 2]);
    if (stretch.start_heading) fix_start(*stretch.start_heading, stretch.start_curvature, reach);
    if (stretch.goal_heading) fix(n - 2, fit_.control.back(), *stretch.goal_heading, -reach_back);
  }

  /// The curve, when it can be made free and easy enough; else the place of the first trouble is
  /// left in `trouble()`.
  std::optional<CubicBSpline> run() {
    for (int round = 0; round < kRepairRounds; ++round) {
      set_bending();
      solve(fit_);
      const CubicBSpline curve = CubicBSpline::uniform(fit_.control, start_second_);
      const Mending mending = mend_spans(curve, std::exp2(-(round / 4)));
      if (mending == Mending::kNothingToDo) return curve;
      if (mending == Mending::kHopeless) break;
    }
    return std::nullopt;
  }

  const TPoint2D& trouble() const { return trouble_; }

 private:
  enum class Verdict { kGood, kNotFree, kTooTight };
  enum class Mending { kNothingToDo, kTried, kHopeless };

  void fix(std::size_t index, const TPoint2D& end, double heading_rad, double reach) {
    fit_.fixed[index] = 1;
    fit_.control[index] = {end.x + reach * std::cos(heading_rad),
                           end.y + reach * std::sin(heading_rad)};
  }

  /// First derivative `reach` along the heading, second derivative across it: position, tangent and
  /// curvature at the start are then those asked for.
  void fix_start(double heading_rad, double curvature, double reach) {
    const double bend = curvature * reach * reach;
    start_second_ = {-bend * std::sin(heading_rad), bend * std::cos(heading_rad)};
    TPoint2D& first = fit_.control.front();
    first = {first.x - start_second_.x / 6.0, first.y - start_second_.y / 6.0};
    fix(1, {first.x + 0.5 * start_second_.x, first.y + 0.5 * start_second_.y}, heading_rad, reach);
  }

  void set_bending() {
    const double step = spacing_ / kTaperM;
    for (std::size_t i = 1; i < levels_.size(); ++i) {
      levels_[i] = std::max(levels_[i], levels_[i - 1] - step);
    }
    for (std::size_t i = levels_.size() - 1; i-- > 0;) {
      levels_[i] = std::max(levels_[i], levels_[i + 1] - step);
    }
    for (std::size_t i = 0; i < levels_.size(); ++i) {
      const double length = kSmoothingLengthM * std::exp2(-levels_[i]);
      fit_.bending[i] = std::pow(length / spacing_, 4.0);
      if (sites_.pinned[i]) fit_.weights[i] = kPinWeight * std::max(1.0, fit_.bending[i]);
    }
  }

  Mending mend_spans(const CubicBSpline& curve, double step) {
    bool any = false;
    bool hope = false;
    std::vector<double> change(levels_.size(), 0.0);
    for (std::size_t span = 0; span + 1 < levels_.size(); ++span) {
      const Verdict verdict = judge_again(curve, span);
      if (verdict == Verdict::kGood) continue;
      if (!any) trouble_ = curve.position(static_cast<double>(span) + 0.5);
      any = true;
      const bool less = verdict == Verdict::kTooTight;
      const double level = std::max(levels_[span], levels_[span + 1]);
      hope |= less ? level > 0.0 : level < kMostLevels;
      for (std::size_t i = span; i <= span + 1; ++i) {
        if (less && change[i] <= 0.0) change[i] = -0.5 * step;
        if (!less) change[i] = step;
      }
    }
    judged_ = curve.control_points();
    for (std::size_t i = 0; i < levels_.size(); ++i) {
      levels_[i] = std::clamp(levels_[i] + change[i], 0.0, kMostLevels);
    }
    if (!any) return Mending::kNothingToDo;
    return hope ? Mending::kTried : Mending::kHopeless;
  }

  /// Far from what is being mended nothing moves: good spans stay good.
  Verdict judge_again(const CubicBSpline& curve, std::size_t span) {
    const auto& c = curve.control_points();
    if (judged_.size() != c.size()) {
      judged_ = c;
      is_good_.assign(c.size(), 0);
    }
    double moved = 0.0;
    for (std::size_t i = span; i < span + 4; ++i) {
      moved = std::max(moved, maps::distance(c[i], judged_[i]));
    }
    if (is_good_[span] && moved < kUnmovedM) return Verdict::kGood;
    const Verdict verdict = judge(curve, span);
    is_good_[span] = verdict == Verdict::kGood ? 1 : 0;
    return verdict;
  }

  Verdict judge(const CubicBSpline& curve, std::size_t span) const {
    const auto& c = fit_.control;
    const double length = maps::distance(c[span], c[span + 1]);
    const int n = std::max(2, static_cast<int>(std::ceil(length / config_.sample_spacing_m)));
    CurvePoint last = curve.at(static_cast<double>(span));
    bool tight = false;
    for (int k = 1; k <= n; ++k) {
      const CurvePoint next = curve.at(static_cast<double>(span) + static_cast<double>(k) / n);
      if (!space_.is_free(last.position, next.position, kCurveMarginM)) return Verdict::kNotFree;
      tight |= std::abs(next.curvature()) > config_.max_curvature_1_m;
      last = next;
    }
    return tight ? Verdict::kTooTight : Verdict::kGood;
  }

  const FreeSpace& space_;
  const SplineConfig& config_;
  double spacing_;
  Sites sites_;
  PenalizedFit fit_;
  TPoint2D start_second_{0.0, 0.0};
  std::vector<double> levels_;    // halvings of the smoothing length, per control point
  std::vector<TPoint2D> judged_;  // control points
  std::vector<char> is_good_;     // per span
  TPoint2D trouble_;
};

class Smoother {
 public:
  Smoother(const FreeSpace& space, const SplineConfig& config) : space_(space), config_(config) {}

  void add(const Stretch& stretch) {
    const std::size_t last = stretch.vertices.size() - 1;
    const bool is_straight = last == 1;
    if (is_straight && !bends(stretch)) {
      pieces_.push_back({.curve = CubicBSpline::uniform(stretch.vertices)});
      return;
    }
    if (!config_.smooth) {
      is_straight ? add_without_headings(stretch) : split(stretch, 1);
      return;
    }
    TPoint2D trouble;
    double spacing = config_.control_spacing_m;
    for (int i = 0; i < kRefinements; ++i, spacing *= 0.5) {
      CurveFit fit(space_, config_, stretch, spacing);
      if (auto curve = fit.run()) {
        pieces_.push_back({.curve = std::move(*curve)});
        return;
      }
      trouble = fit.trouble();
    }
    is_straight ? add_without_headings(stretch) : split(stretch, nearest_vertex(stretch, trouble));
  }

  std::vector<PathPiece> take() { return std::move(pieces_); }

 private:
  /// Does a two-point stretch have to leave its line to keep the headings asked for?
  static bool bends(const Stretch& s) {
    const double along = heading(s.vertices.front(), s.vertices.back());
    const auto differs = [along](const std::optional<double>& h) {
      return h && std::abs(maps::wrap_angle(*h - along)) > 1e-4;
    };
    return differs(s.start_heading) || differs(s.goal_heading) || s.start_curvature != 0.0;
  }

  void add_without_headings(Stretch stretch) {
    stretch.start_heading.reset();
    stretch.start_curvature = 0.0;
    stretch.goal_heading.reset();
    add(stretch);
  }

  void split(const Stretch& stretch, std::size_t at) {
    add(part(stretch, 0, at));
    add(part(stretch, at, stretch.vertices.size() - 1));
  }

  static std::size_t nearest_vertex(const Stretch& stretch, const TPoint2D& place) {
    std::size_t best = 1;
    for (std::size_t i = 2; i + 1 < stretch.vertices.size(); ++i) {
      if (maps::distance(stretch.vertices[i], place) <
          maps::distance(stretch.vertices[best], place)) {
        best = i;
      }
    }
    return best;
  }

  const FreeSpace& space_;
  const SplineConfig& config_;
  std::vector<PathPiece> pieces_;
};

bool is_pivot(const std::vector<TPoint2D>& v, std::size_t i) {
  return std::abs(maps::wrap_angle(heading(v[i], v[i + 1]) - heading(v[i - 1], v[i]))) >
         kPivotTurnRad;
}

}  // namespace

std::vector<PathPiece> smooth(const FreeSpace& space, const SmoothingProblem& problem,
                              const SplineConfig& config) {
  Stretch whole;
  whole.vertices = problem.polyline.points;
  whole.pinned.assign(whole.vertices.size(), 0);
  for (const std::size_t i : problem.pinned) whole.pinned[i] = 1;
  whole.start_heading = problem.start_heading_rad;
  if (whole.start_heading) whole.start_curvature = problem.start_curvature_1_m;
  whole.goal_heading = problem.goal_heading_rad;

  Smoother smoother(space, config);
  std::size_t first = 0;
  for (std::size_t i = 1; i + 1 < whole.vertices.size(); ++i) {
    if (!is_pivot(whole.vertices, i)) continue;
    smoother.add(part(whole, first, i));
    first = i;
  }
  smoother.add(part(whole, first, whole.vertices.size() - 1));
  return smoother.take();
}

std::vector<double> sample_parameters(const CubicBSpline& curve, double spacing_m) {
  std::vector<double> out{curve.begin()};
  const auto& knots = curve.knots();
  for (std::size_t k = 3; k + 4 < knots.size(); ++k) {
    const double width = knots[k + 1] - knots[k];
    if (width <= 0.0) continue;
    // The derivative is a mix of these three; with uniform knots, of the control polygon's legs.
    const auto& c = curve.control_points();
    double leg = 0.0;
    for (std::size_t i = k - 3; i < k; ++i) {
      const double share = 3.0 * width / (knots[i + 4] - knots[i + 1]);
      leg = std::max(leg, share * maps::distance(c[i], c[i + 1]));
    }
    const int n = std::max(1, static_cast<int>(std::ceil(leg / spacing_m)));
    for (int i = 1; i <= n; ++i) out.push_back(knots[k] + width * i / n);
  }
  return out;
}

Path sampled(const std::vector<PathPiece>& pieces, double spacing_m) {
  Path path;
  for (const PathPiece& piece : pieces) {
    for (const double u : sample_parameters(piece.curve, spacing_m)) {
      if (u == piece.curve.begin() && !path.points.empty()) continue;
      path.points.push_back(piece.curve.position(u));
    }
  }
  return path;
}

}  // namespace rovigo::planning
