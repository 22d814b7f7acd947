#include "planning/penalized_fit.h"

#include <array>
#include <cassert>

namespace rovigo::planning {

namespace {

/// Normal equations with two off-diagonals on each side, and two right-hand sides.
class BandedSystem {
 public:
  explicit BandedSystem(std::size_t n) : band_(n), rhs_(n) {}

  /// Adds weight * |sum_k coefficient[k] c[first + k] - target|^2; fixed points count as known.
  void add(std::size_t first, const std::array<double, 3>& coefficient, double weight,
           TPoint2D target, const PenalizedFit& fit) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!fit.fixed[first + k]) continue;
      target.x -= coefficient[k] * fit.control[first + k].x;
      target.y -= coefficient[k] * fit.control[first + k].y;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      if (fit.fixed[first + k]) continue;
      rhs_[first + k].x += weight * coefficient[k] * target.x;
      rhs_[first + k].y += weight * coefficient[k] * target.y;
      for (std::size_t m = k; m < 3; ++m) {
        if (!fit.fixed[first + m])
          band_[first + k][m - k] += weight * coefficient[k] * coefficient[m];
      }
    }
  }

  /// LDL^T in place; fixed rows are given the identity.
  void solve_into(PenalizedFit& fit) {
    const std::size_t n = band_.size();
    for (std::size_t i = 0; i < n; ++i) {
      if (fit.fixed[i]) {
        band_[i] = {1.0, 0.0, 0.0};
        rhs_[i] = fit.control[i];
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 1; k < 3 && i + k < n; ++k) {
        const double factor = band_[i][k] / band_[i][0];
        for (std::size_t m = k; m < 3; ++m) band_[i + k][m - k] -= factor * band_[i][m];
        rhs_[i + k].x -= factor * rhs_[i].x;
        rhs_[i + k].y -= factor * rhs_[i].y;
      }
    }
    for (std::size_t i = n; i-- > 0;) {
      TPoint2D value = rhs_[i];
      for (std::size_t k = 1; k < 3 && i + k < n; ++k) {
        value.x -= band_[i][k] * fit.control[i + k].x;
        value.y -= band_[i][k] * fit.control[i + k].y;
      }
      fit.control[i] = {value.x / band_[i][0], value.y / band_[i][0]};
    }
  }

 private:
  std::vector<std::array<double, 3>> band_;  // [i][k]: entry (i, i + k) of the symmetric matrix
  std::vector<TPoint2D> rhs_;
};

}  // namespace

void solve(PenalizedFit& fit) {
  const std::size_t n = fit.control.size();
  assert(n >= 2 && fit.fixed.front() && fit.fixed.back());
  BandedSystem system(n);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    system.add(i - 1, {1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0}, fit.weights[i], fit.targets[i], fit);
    system.add(i - 1, {1.0, -2.0, 1.0}, fit.bending[i], {0.0, 0.0}, fit);
  }
  system.solve_into(fit);
}

}  // namespace rovigo::planning
