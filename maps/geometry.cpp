#include "maps/geometry.h"

namespace rovigo::maps {

double wrap_angle(double angle_rad) {
  if (angle_rad > -kPi && angle_rad <= kPi) return angle_rad;
  const double wrapped = std::remainder(angle_rad, 2.0 * kPi);
  return wrapped <= -kPi ? wrapped + 2.0 * kPi : wrapped;
}

TPoint2D transform(const TPose2D& a_from_b, const TPoint2D& point_b) {
  const double c = std::cos(a_from_b.phi);
  const double s = std::sin(a_from_b.phi);
  return {a_from_b.x + c * point_b.x - s * point_b.y, a_from_b.y + s * point_b.x + c * point_b.y};
}

TPose2D compose(const TPose2D& a_from_b, const TPose2D& b_from_c) {
  const TPoint2D origin = transform(a_from_b, position_of(b_from_c));
  return {origin.x, origin.y, wrap_angle(a_from_b.phi + b_from_c.phi)};
}

TPose2D inverse(const TPose2D& a_from_b) {
  const double c = std::cos(a_from_b.phi);
  const double s = std::sin(a_from_b.phi);
  return {-c * a_from_b.x - s * a_from_b.y, s * a_from_b.x - c * a_from_b.y,
          wrap_angle(-a_from_b.phi)};
}

bool is_finite(const TPose2D& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.phi);
}

}  // namespace rovigo::maps
