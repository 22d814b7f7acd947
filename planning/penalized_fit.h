#pragma once
// The linear algebra of the smoother: a uniform cubic B-spline near given points, little bent.

#include <vector>

#include "maps/geometry.h"

namespace rovigo::planning {

/// Site i is where the spline with control points c stands at parameter i: (c[i-1] + 4 c[i] +
/// c[i+1]) / 6. All vectors have one entry per control point.
struct PenalizedFit {
  std::vector<TPoint2D> targets;  ///< where the sites should be
  std::vector<double> weights;    ///< of their squared distances
  std::vector<double> bending;    ///< weights of |c[i-1] - 2 c[i] + c[i+1]|^2
  std::vector<char> fixed;        ///< control points that stay as they are in `control`
  std::vector<TPoint2D> control;  ///< in: the fixed ones; out: all
};

/// Minimises the weighted sum in linear time (banded Cholesky). First and last must be fixed.
void solve(PenalizedFit& fit);

}  // namespace rovigo::planning
