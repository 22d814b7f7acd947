#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace rovigo::slam {

/// Which colour image goes with which depth image: each used once, the closest pairs first (as
/// TUM's associate.py does), none further apart than `max_difference_s`. Both lists in time order;
/// the pairs (colour index, depth index) come in the order of the colour images.
std::vector<std::pair<std::size_t, std::size_t>> closest_pairs(
    const std::vector<double>& color_times_s, const std::vector<double>& depth_times_s,
    double max_difference_s);

}  // namespace rovigo::slam
