#pragma once
// The smoothing spline that SciPy's splprep gives: what the rover thesis smoothed its paths with.

#include <optional>
#include <vector>

#include "planning/bspline.h"

namespace rovigo::planning {

struct ReferenceSpline {
  CubicBSpline curve;             ///< on [0, 1], clamped ends, knots at data sites
  std::vector<double> parameter;  ///< of each point: normalised chord length
  double residual = 0.0;          ///< sum of squared distances from the points to their sites
};

/// SciPy's own choice where none is given: m - sqrt(2 m) for m points.
double default_smoothing(std::size_t points);

/// The parametric cubic smoothing spline of Dierckx (Curve and Surface Fitting with Splines, 1993,
/// chapters 5 and 9). Knots are added at points until the least-squares residual is at most
/// `smoothing`, a bound on the sum of squared distances in the points' unit squared; among the
/// splines with these knots the one with the smallest jumps of the third derivative whose residual
/// is within 0.1% of the bound. 0 interpolates. Knows nothing of obstacles, and moves the ends.
/// Precondition: at least four points, finite, no two in a row the same; smoothing >= 0.
ReferenceSpline reference_spline(const std::vector<TPoint2D>& points, double smoothing);

}  // namespace rovigo::planning
