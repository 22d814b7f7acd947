#include "planning/refusal.h"

#include <cstdio>

namespace rovigo::planning {

std::string meters(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f m", value);
  return text;
}

std::string text_of(const TPoint2D& point) {
  char text[96];
  std::snprintf(text, sizeof text, "(%.2f, %.2f) m", point.x, point.y);
  return text;
}

std::string nearest_hint(const std::optional<TPoint2D>& nearest) {
  if (!nearest) return " No other point can be reached from the start either.";
  return " The nearest reachable point is " + text_of(*nearest) + ".";
}

std::string extent_of(const TPoint2D& lower_left, const TPoint2D& upper_right) {
  char text[160];
  std::snprintf(text, sizeof text, "the map covers x from %.2f to %.2f m and y from %.2f to %.2f m",
                lower_left.x, upper_right.x, lower_left.y, upper_right.y);
  return text;
}

}  // namespace rovigo::planning
