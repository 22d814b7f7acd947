#pragma once
// Cubic B-splines in the plane.

#include <vector>

#include "maps/geometry.h"

namespace rovigo::planning {

/// A curve's position and derivatives with respect to its parameter.
struct CurvePoint {
  TPoint2D position;
  TPoint2D first;
  TPoint2D second;
  TPoint2D third;

  /// Signed curvature, 1/m, left positive; 0 where the curve stands still.
  double curvature() const;
  /// Derivative of the curvature by arc length, 1/m^2.
  double curvature_rate() const;
  double heading() const;
};

/// Non-decreasing knots t_0 .. t_{n+3} and control points c_0 .. c_{n-1}, defined on [t_3, t_n];
/// with simple knots twice continuously differentiable.
class CubicBSpline {
 public:
  /// Precondition: knots.size() == control.size() + 4, control.size() >= 4.
  CubicBSpline(std::vector<double> knots, std::vector<TPoint2D> control);

  /// The spline with uniform knots whose interior control points these are, at least two: it begins
  /// at the first and ends at the last, with zero second derivative and tangents along the first
  /// and last leg. Domain [0, points.size() - 1].
  /// With a second derivative at the start it begins a sixth of that beyond the first point.
  static CubicBSpline uniform(const std::vector<TPoint2D>& points,
                              const TPoint2D& start_second = {0.0, 0.0});

  double begin() const { return knots_[3]; }
  double end() const { return knots_[knots_.size() - 4]; }
  /// Parameters outside the domain are clamped to it.
  CurvePoint at(double parameter) const;
  TPoint2D position(double parameter) const { return at(parameter).position; }

  const std::vector<double>& knots() const { return knots_; }
  const std::vector<TPoint2D>& control_points() const { return control_; }

 private:
  CurvePoint at_uniform(double parameter) const;

  std::vector<double> knots_;
  std::vector<TPoint2D> control_;
  bool is_uniform_ = false;  ///< knots are whole numbers from -3 on
};

}  // namespace rovigo::planning
