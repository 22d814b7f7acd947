#pragma once
// Poses as the seven numbers of TUM files, and numbers as text that reads back to the same double.

#include <mrpt/poses/CPose3D.h>

#include <array>
#include <optional>
#include <string>

namespace rovigo::slam {

using PoseNumbers = std::array<double, 7>;  ///< tx ty tz qx qy qz qw

/// Empty when a number is not finite, beyond 1e6 m, or the quaternion's length is not 1 within 1%
/// (files print a few digits; within that it is normalised).
std::optional<mrpt::poses::CPose3D> pose_from_numbers(const PoseNumbers& numbers);
/// qw >= 0, so that one pose always gives the same numbers.
PoseNumbers numbers_of(const mrpt::poses::CPose3D& pose);

/// The shortest text that reads back to exactly this value; the same on every machine and locale.
std::string shortest(double value);
/// A fixed number of decimals, independent of the locale.
std::string fixed(double value, int decimals);

}  // namespace rovigo::slam
