#pragma once
// Small text helpers of the command line: strict numbers, points, lists.

#include <optional>
#include <string>
#include <vector>

#include "maps/geometry.h"

namespace rovigo::app {

/// The whole text as a finite number, or nothing.
std::optional<double> parse_number(const std::string& text);

/// "X,Y" or "X,Y,YAW" (metres, radians).
struct PoseArgument {
  TPose2D pose;
  bool has_heading = false;
};
/// Throws InputError naming `option`, what was written and what is expected.
PoseArgument parse_pose(const std::string& option, const std::string& text);
TPoint2D parse_point(const std::string& option, const std::string& text);

std::string join(const std::vector<std::string>& parts, const std::string& separator);
std::vector<std::string> split(const std::string& text, char separator);

}  // namespace rovigo::app
