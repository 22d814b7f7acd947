#include "planning/reference_spline.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

namespace rovigo::planning {

namespace {

constexpr std::size_t kDegree = 3;
constexpr std::size_t kOrder = kDegree + 1;
constexpr double kResidualTolerance = 1e-3;  // relative to the bound
constexpr int kMostPenalties = 20;           // steps of the search for the penalty
constexpr double kInfinity = std::numeric_limits<double>::infinity();

using Point = Eigen::Vector2d;

/// Least squares row by row: Givens rotations into an upper triangle with kOrder off-diagonals, so
/// that the squared condition number of normal equations never arises. Linear in the number of
/// rows when these come in the order of their first columns.
class BandedTriangle {
 public:
  static constexpr int kWidth = static_cast<int>(kOrder) + 1;
  using Row = Eigen::Matrix<double, kWidth, 1>;
  struct Equation {
    Row row = Row::Zero();
    Point rhs = Point::Zero();
  };

  explicit BandedTriangle(std::size_t n) : kept_(n) {}

  /// Adds the equation sum_i row[i] c[first + i] = rhs, of which `count` entries are not zero.
  /// Returns by how much that raises the least sum of squares.
  double add(std::size_t first, std::size_t count, Equation work) {
    end_ = std::min(kept_.size(), std::max(end_, first + count));  // columns used so far
    for (std::size_t column = first; column < end_; ++column) {
      if (work.row[0] != 0.0) rotate(kept_[column], work);
      for (int k = 1; k < kWidth; ++k) work.row[k - 1] = work.row[k];
      work.row[kWidth - 1] = 0.0;
    }
    return work.rhs.squaredNorm();
  }

  const std::vector<Equation>& equations() const { return kept_; }

  std::vector<TPoint2D> solved() const {
    std::vector<TPoint2D> c(kept_.size());
    for (std::size_t i = kept_.size(); i-- > 0;) {
      Point value = kept_[i].rhs;
      for (std::size_t k = 1; k < kWidth && i + k < c.size(); ++k) {
        value -= kept_[i].row[static_cast<int>(k)] * Point(c[i + k].x, c[i + k].y);
      }
      value /= kept_[i].row[0];
      c[i] = {value.x(), value.y()};
    }
    return c;
  }

  double mean_diagonal() const {
    double sum = 0.0;
    for (const Equation& e : kept_) sum += e.row[0];
    return sum / static_cast<double>(kept_.size());
  }

 private:
  /// Makes work's first entry zero; the triangle's diagonal stays positive.
  static void rotate(Equation& kept, Equation& work) {
    const double length = std::sqrt(kept.row[0] * kept.row[0] + work.row[0] * work.row[0]);
    const double c = kept.row[0] / length;
    const double s = work.row[0] / length;
    const Equation before = kept;
    kept.row = c * before.row + s * work.row;
    kept.rhs = c * before.rhs + s * work.rhs;
    work.row = c * work.row - s * before.row;
    work.rhs = c * work.rhs - s * before.rhs;
    work.row[0] = 0.0;
  }

  std::vector<Equation> kept_;  // row [i][k]: entry (i, i + k)
  std::size_t end_ = 0;
};

/// Values of the four B-splines that do not vanish on [t[0], t[1]), by de Boor's recurrence.
std::array<double, kOrder> basis(const double* t, double u) {
  std::array<double, kOrder> b{1.0, 0.0, 0.0, 0.0};
  for (std::size_t degree = 1; degree <= kDegree; ++degree) {
    double carried = 0.0;
    for (std::size_t i = 0; i < degree; ++i) {
      const double right = t[i + 1];
      const double left = *(t + i + 1 - degree);
      const double part = b[i] / (right - left);
      b[i] = carried + (right - u) * part;
      carried = (u - left) * part;
    }
    b[degree] = carried;
  }
  return b;
}

/// One fit's data: sites, knots and what depends on both.
class Fit {
 public:
  Fit(const std::vector<TPoint2D>& points, const std::vector<double>& sites,
      std::vector<double> knots)
      : points_(&points), knots_(std::move(knots)), triangle_(control_count()) {
    span_.reserve(sites.size());
    basis_.reserve(sites.size());
    double left = 0.0;
    std::size_t k = kDegree;
    for (std::size_t i = 0; i < sites.size(); ++i) {
      while (k + 1 < control_count() && sites[i] >= knots_[k + 1]) ++k;
      span_.push_back(k);
      basis_.push_back(basis(knots_.data() + k, sites[i]));
      BandedTriangle::Equation site;
      for (int j = 0; j < static_cast<int>(kOrder); ++j) {
        site.row[j] = basis_.back()[static_cast<std::size_t>(j)];
      }
      site.rhs = Point(points[i].x, points[i].y);
      left += triangle_.add(k - kDegree, kOrder, site);
    }
    set_control(triangle_.solved());
    // Where knots crowd towards an end the control points are hardly determined and carry large
    // errors; the least residual is known all the same.
    residual_ = left;
  }

  std::size_t control_count() const { return knots_.size() - kOrder; }
  const std::vector<double>& knots() const { return knots_; }
  const std::vector<TPoint2D>& control() const { return control_; }
  const std::vector<double>& squared() const { return squared_; }  ///< distances, per point
  double residual() const { return residual_; }
  double mean_diagonal() const { return triangle_.mean_diagonal(); }

  /// Replaces the least-squares control points by those that minimise the residual plus the
  /// squared jumps of the third derivative over `p`.
  void penalize(double p) {
    if (jumps_.empty()) find_jumps();
    BandedTriangle all(control_count());
    for (std::size_t i = 0; i < control_count(); ++i) {
      all.add(i, kOrder, triangle_.equations()[i]);
      if (i < jumps_.size()) all.add(i, kOrder + 1, {.row = jumps_[i] / p, .rhs = Point::Zero()});
    }
    set_control(all.solved());
  }

 private:
  /// The third derivative's jump at an inner knot t_j, over 3!, is a divided difference of the
  /// truncated power: of B-spline i it is (t_{i+4} - t_i) / prod_{l != j} (t_j - t_l), l = i..i+4.
  /// Knot distances are measured in mean intervals, which keeps the penalty's size reasonable.
  void find_jumps() {
    const double mean = 1.0 / static_cast<double>(knots_.size() - 2 * kOrder + 1);
    for (std::size_t j = kOrder; j < control_count(); ++j) {
      BandedTriangle::Row row;
      for (std::size_t k = 0; k <= kOrder; ++k) {
        const std::size_t i = j - kOrder + k;
        double product = 1.0;
        for (std::size_t l = i; l <= i + kOrder; ++l) {
          if (l != j) product *= (knots_[j] - knots_[l]) / mean;
        }
        row[static_cast<int>(k)] = (knots_[i + kOrder] - knots_[i]) / mean / product;
      }
      jumps_.push_back(row);
    }
  }

  void set_control(std::vector<TPoint2D> control) {
    control_ = std::move(control);
    squared_.resize(points_->size());
    residual_ = 0.0;
    for (std::size_t i = 0; i < points_->size(); ++i) {
      double x = -(*points_)[i].x;
      double y = -(*points_)[i].y;
      for (std::size_t k = 0; k < kOrder; ++k) {
        x += basis_[i][k] * control_[span_[i] - kDegree + k].x;
        y += basis_[i][k] * control_[span_[i] - kDegree + k].y;
      }
      squared_[i] = x * x + y * y;
      residual_ += squared_[i];
    }
  }

  const std::vector<TPoint2D>* points_;
  std::vector<double> knots_;
  std::vector<std::size_t> span_;
  std::vector<std::array<double, kOrder>> basis_;
  BandedTriangle triangle_;
  std::vector<BandedTriangle::Row> jumps_;
  std::vector<TPoint2D> control_;
  std::vector<double> squared_;
  double residual_ = 0.0;
};

std::vector<double> chord_lengths(const std::vector<TPoint2D>& points) {
  std::vector<double> u(points.size(), 0.0);
  for (std::size_t i = 1; i < u.size(); ++i) {
    u[i] = u[i - 1] + maps::distance(points[i - 1], points[i]);
  }
  for (double& v : u) v /= u.back() > 0.0 ? u.back() : 1.0;
  u.back() = 1.0;
  return u;
}

/// Knots of the interpolating spline: every site but the second from either end.
std::vector<double> interpolating_knots(const std::vector<double>& sites) {
  std::vector<double> knots(kOrder, sites.front());
  knots.insert(knots.end(), sites.begin() + 2, sites.end() - 2);
  knots.insert(knots.end(), kOrder, sites.back());
  return knots;
}

/// Which sites carry a knot, and where the next ones belong (Dierckx 5.3): into the interval with
/// the largest share of the residual that still holds a site, at its middle one.
class KnotChooser {
 public:
  explicit KnotChooser(const std::vector<double>& sites)
      : sites_(sites), border_{0, sites.size() - 1} {}

  std::vector<double> knots() const {
    std::vector<double> knots(kOrder, sites_.front());
    for (std::size_t i = 1; i + 1 < border_.size(); ++i) knots.push_back(sites_[border_[i]]);
    knots.insert(knots.end(), kOrder, sites_.back());
    return knots;
  }

  /// True when as many control points as sites are reached: time to interpolate.
  bool add(const std::vector<double>& squared, std::size_t count) {
    share_residual(squared);
    for (std::size_t i = 0; i < count; ++i) {
      split_worst();
      if (border_.size() + 2 >= sites_.size()) return true;
    }
    return false;
  }

 private:
  /// What lies on a border counts half on either side.
  void share_residual(const std::vector<double>& squared) {
    share_.assign(border_.size() - 1, 0.0);
    for (std::size_t i = 0; i + 1 < border_.size(); ++i) {
      for (std::size_t k = border_[i] + 1; k < border_[i + 1]; ++k) share_[i] += squared[k];
      share_[i] += (i == 0 ? 1.0 : 0.5) * squared[border_[i]];
      share_[i] += (i + 2 == border_.size() ? 1.0 : 0.5) * squared[border_[i + 1]];
    }
  }

  std::size_t sites_inside(std::size_t interval) const {
    return border_[interval + 1] - border_[interval] - 1;
  }

  void split_worst() {
    std::size_t worst = share_.size();
    for (std::size_t i = 0; i < share_.size(); ++i) {
      if (sites_inside(i) > 0 && (worst == share_.size() || share_[i] > share_[worst])) worst = i;
    }
    if (worst == share_.size()) return;
    const std::size_t inside = sites_inside(worst);
    const double share = share_[worst] / static_cast<double>(inside);
    const auto after = static_cast<std::ptrdiff_t>(worst) + 1;
    border_.insert(border_.begin() + after, border_[worst] + inside / 2 + 1);
    share_[worst] = share * static_cast<double>(sites_inside(worst));
    share_.insert(share_.begin() + after, share * static_cast<double>(sites_inside(worst + 1)));
  }

  const std::vector<double>& sites_;
  std::vector<std::size_t> border_;  // indices of sites: both ends and the knots
  std::vector<double> share_;        // of the residual, per interval
};

/// Adds knots until the least-squares residual falls below the bound. Twice as many from step to
/// step, fewer when the last ones promise that fewer suffice.
Fit fit_with_few_knots(const std::vector<TPoint2D>& points, const std::vector<double>& sites,
                       double smoothing, double& residual_of_cubic) {
  KnotChooser chooser(sites);
  const double tolerance = kResidualTolerance * smoothing;
  Fit fit(points, sites, chooser.knots());
  residual_of_cubic = fit.residual();
  std::size_t count = 1;
  while (fit.residual() - smoothing >= tolerance && fit.control_count() < sites.size()) {
    const double before = fit.residual();
    const bool full = chooser.add(fit.squared(), count);
    fit = Fit(points, sites, full ? interpolating_knots(sites) : chooser.knots());
    const double gained = before - fit.residual();
    const double missing = fit.residual() - smoothing;
    if (missing < tolerance) break;
    const auto n = static_cast<double>(count);
    const double wanted = gained > tolerance ? std::floor(n * missing / gained) : 2.0 * n;
    count =
        static_cast<std::size_t>(std::min(2.0 * n, std::max({wanted, std::floor(0.5 * n), 1.0})));
  }
  return fit;
}

/// A penalty p and by how much the residual exceeds the bound there.
struct Trial {
  double p = 0.0;
  double excess = 0.0;
};

/// Where (u p + v) / (p + w) through three trials vanishes: residuals fall with p much like this.
double rational_root(const Trial& low, const Trial& middle, const Trial& high) {
  const double f1 = low.excess;
  const double f2 = middle.excess;
  const double f3 = high.excess;
  if (high.p == kInfinity) {
    return (low.p * (f1 - f3) * f2 - middle.p * (f2 - f3) * f1) / ((f1 - f2) * f3);
  }
  const double h1 = f1 * (f2 - f3);
  const double h2 = f2 * (f3 - f1);
  const double h3 = f3 * (f1 - f2);
  return -(low.p * middle.p * h3 + middle.p * high.p * h1 + high.p * low.p * h2) /
         (low.p * h1 + middle.p * h2 + high.p * h3);
}

/// Finds the penalty that makes the residual the bound. `low` (p = 0: one cubic, the third
/// derivative never jumps) is above it, `high` (no penalty: least squares) below.
void smooth_to(Fit& fit, double smoothing, double residual_of_cubic) {
  constexpr double kFar = 25.0;  // step while nothing encloses the root
  Trial low{0.0, residual_of_cubic - smoothing};
  Trial high{kInfinity, fit.residual() - smoothing};
  const double tolerance = kResidualTolerance * smoothing;
  double p = 1.0 / fit.mean_diagonal();
  bool low_is_close = false;
  bool high_is_close = false;
  for (int step = 0; step < kMostPenalties; ++step) {
    fit.penalize(p);
    const Trial now{p, fit.residual() - smoothing};
    if (std::abs(now.excess) < tolerance) return;
    // Ends too far out to say anything about the residual's shape are drawn in first.
    if (!high_is_close && now.excess - high.excess <= tolerance) {
      high = now;
      p = p / kFar > low.p ? p / kFar : 0.9 * low.p + 0.1 * p;
      continue;
    }
    if (!low_is_close && low.excess - now.excess <= tolerance) {
      low = now;
      p = p * kFar < high.p ? p * kFar : 0.1 * p + 0.9 * high.p;
      continue;
    }
    high_is_close |= now.excess < 0.0;
    low_is_close |= now.excess > 0.0;
    if (now.excess >= low.excess || now.excess <= high.excess) return;  // rounding: good enough
    p = rational_root(low, now, high);
    (now.excess < 0.0 ? high : low) = now;
  }
}

}  // namespace

double default_smoothing(std::size_t points) {
  const auto m = static_cast<double>(points);
  return m - std::sqrt(2.0 * m);
}

ReferenceSpline reference_spline(const std::vector<TPoint2D>& points, double smoothing) {
  assert(points.size() >= kOrder && smoothing >= 0.0);
  std::vector<double> sites = chord_lengths(points);
  if (smoothing <= 0.0) {
    const Fit fit(points, sites, interpolating_knots(sites));
    return {CubicBSpline(fit.knots(), fit.control()), std::move(sites), fit.residual()};
  }
  double residual_of_cubic = 0.0;
  Fit fit = fit_with_few_knots(points, sites, smoothing, residual_of_cubic);
  const bool has_inner_knots = fit.knots().size() > 2 * kOrder;
  const double spare = smoothing - fit.residual();
  if (has_inner_knots && spare > kResidualTolerance * smoothing) {
    smooth_to(fit, smoothing, residual_of_cubic);
  }
  CubicBSpline curve(fit.knots(), fit.control());
  const double residual = fit.residual();
  return {std::move(curve), std::move(sites), residual};
}

}  // namespace rovigo::planning
