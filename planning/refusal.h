#pragma once
// The sentences a person reads when there is no plan.

#include <optional>
#include <string>

#include "maps/geometry.h"
#include "planning/plan_status.h"

namespace rovigo::planning {

/// `0.30 m`.
std::string meters(double value);

/// `(1.25, -0.40) m`.
std::string text_of(const TPoint2D& point);

/// ` The nearest reachable point is (x, y) m.`, or a sentence that there is none.
std::string nearest_hint(const std::optional<TPoint2D>& nearest);

/// `The map covers x from .. to .. and y from .. to .. m.`
std::string extent_of(const TPoint2D& lower_left, const TPoint2D& upper_right);

}  // namespace rovigo::planning
