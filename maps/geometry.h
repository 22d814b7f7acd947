#pragma once
// The vocabulary for poses on the floor: MRPT's light value types under one roof.

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>
#include <mrpt/math/TTwist2D.h>

#include <cmath>

namespace rovigo {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;
using mrpt::math::TTwist2D;

namespace maps {

inline constexpr double kPi = 3.14159265358979323846;

/// `angle_rad` brought into (-pi, pi]; NaN and infinity come back as NaN.
double wrap_angle(double angle_rad);

/// Distance in metres between two points.
inline double distance(const TPoint2D& a, const TPoint2D& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

inline TPoint2D position_of(const TPose2D& pose) { return {pose.x, pose.y}; }

/// Pose c with a_from_c = a_from_b * b_from_c; the result's yaw is wrapped.
TPose2D compose(const TPose2D& a_from_b, const TPose2D& b_from_c);

/// b_from_a for a given a_from_b.
TPose2D inverse(const TPose2D& a_from_b);

/// Point in frame a of a point given in frame b.
TPoint2D transform(const TPose2D& a_from_b, const TPoint2D& point_b);

bool is_finite(const TPose2D& pose);

}  // namespace maps
}  // namespace rovigo
