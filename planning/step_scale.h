#pragma once
// Costs of grid moves as integers: sums are exact, and no order depends on rounding.

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>

namespace rovigo::planning {

/// Of a straight and a diagonal step: convergents of sqrt 2, or even multiples of them, so that
/// halves are whole.
struct StepScale {
  std::uint32_t straight;
  std::uint32_t diagonal;

  /// Cost of the shortest way between two cells `dx`, `dy` apart when nothing stands between.
  std::uint32_t octile(int dx, int dy) const {
    const auto ax = static_cast<std::uint32_t>(std::abs(dx));
    const auto ay = static_cast<std::uint32_t>(std::abs(dy));
    const std::uint32_t lo = std::min(ax, ay);
    const std::uint32_t hi = std::max(ax, ay);
    return (hi - lo) * straight + lo * diagonal;
  }
};

/// The first is off by 2e-9 of a diagonal step; the coarser ones serve where 32 bits would
/// overflow. The first alone is no multiple of an even one.
inline constexpr std::array<StepScale, 6> kStepScales{
    {{13860, 19601}, {11482, 16238}, {1970, 2786}, {338, 478}, {58, 82}, {10, 14}}};

}  // namespace rovigo::planning
