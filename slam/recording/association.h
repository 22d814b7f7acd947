#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace rovigo::slam {

/// Which colour image goes with which depth image: each used once, the closest pairs first (as
/// TUM's associate.py does), none further apart than `max_difference_s`. Both lists in time order;
/// the pairs (colour index, depth index) come in the order of the colour images.
std::vector<std::pair<std::size_t, std::size_t>> closest_pairs(
    const std::vector<double>& color_times_s, const std::vector<double>& depth_times_s,
    double max_difference_s);

/// One sentence when depth images are as a rule (median of `differences_s`, depth minus colour)
/// taken so far from their colour images that a turning rover would see their edges apart; else
/// empty.
std::string time_offset_warning(std::vector<double> differences_s);

}  // namespace rovigo::slam
