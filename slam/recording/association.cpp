#include "slam/recording/association.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "slam/recording/pose_numbers.h"

namespace rovigo::slam {

std::vector<std::pair<std::size_t, std::size_t>> closest_pairs(
    const std::vector<double>& color_times_s, const std::vector<double>& depth_times_s,
    double max_difference_s) {
  using Candidate = std::tuple<double, std::size_t, std::size_t>;  // difference, colour, depth
  constexpr std::size_t kMostPerImage = 8;  // bounds the work on hostile lists
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < color_times_s.size(); ++i) {
    auto near = std::lower_bound(depth_times_s.begin(), depth_times_s.end(),
                                 color_times_s[i] - max_difference_s);
    for (std::size_t n = 0; near != depth_times_s.end() && n < kMostPerImage; ++near, ++n) {
      const double difference = std::abs(*near - color_times_s[i]);
      if (difference > max_difference_s) break;
      candidates.emplace_back(difference, i,
                              static_cast<std::size_t>(near - depth_times_s.begin()));
    }
  }
  std::sort(candidates.begin(), candidates.end());
  constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::vector<std::size_t> depth_of(color_times_s.size(), kNone);
  std::vector<bool> is_taken(depth_times_s.size(), false);
  for (const auto& [difference, i, j] : candidates) {
    if (depth_of[i] != kNone || is_taken[j]) continue;
    depth_of[i] = j;
    is_taken[j] = true;
  }
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < color_times_s.size(); ++i) {
    if (depth_of[i] != kNone) pairs.emplace_back(i, depth_of[i]);
  }
  return pairs;
}

std::string time_offset_warning(std::vector<double> differences_s) {
  constexpr std::size_t kFewest = 5;
  constexpr double kMost_s = 0.012;  // a third of a frame at 30 Hz; TUM's cameras err by 0.008
  if (differences_s.size() < kFewest) return {};
  const auto middle = differences_s.begin() + static_cast<std::ptrdiff_t>(differences_s.size() / 2);
  std::nth_element(differences_s.begin(), middle, differences_s.end());
  if (std::abs(*middle) <= kMost_s) return {};
  return "Depth images are taken " + fixed(1e3 * std::abs(*middle), 0) + " ms " +
         (*middle > 0.0 ? "after" : "before") +
         " their colour images (median), so that their edges part in turns; synchronise the "
         "cameras "
         "if they can be.";
}

}  // namespace rovigo::slam
