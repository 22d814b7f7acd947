#include "slam/recording/pose_numbers.h"

#include <charconv>
#include <cmath>

namespace rovigo::slam {

std::optional<mrpt::poses::CPose3D> pose_from_numbers(const PoseNumbers& n) {
  constexpr double kFarthest_m = 1e6;
  for (int i = 0; i < 3; ++i) {
    if (!(std::abs(n[static_cast<std::size_t>(i)]) <= kFarthest_m)) return std::nullopt;
  }
  const double length = std::sqrt(n[3] * n[3] + n[4] * n[4] + n[5] * n[5] + n[6] * n[6]);
  if (!(std::abs(length - 1.0) < 0.01)) return std::nullopt;
  const mrpt::math::CQuaternionDouble rotation(n[6] / length, n[3] / length, n[4] / length,
                                               n[5] / length);
  return mrpt::poses::CPose3D(rotation, n[0], n[1], n[2]);
}

PoseNumbers numbers_of(const mrpt::poses::CPose3D& pose) {
  mrpt::math::CQuaternionDouble q;
  pose.getAsQuaternion(q);
  const double sign = q.r() < 0.0 ? -1.0 : 1.0;
  return {pose.x(), pose.y(), pose.z(), sign * q.x(), sign * q.y(), sign * q.z(), sign * q.r()};
}

std::string shortest(double value) {
  std::array<char, 32> text{};
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), result.ptr};
}

std::string fixed(double value, int decimals) {
  std::array<char, 400> text{};
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value,
                                    std::chars_format::fixed, decimals);
  return {text.data(), result.ptr};
}

}  // namespace rovigo::slam
