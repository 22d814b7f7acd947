#pragma once
// Binary descriptors of 256 bits and the distance between them.

#include <array>
#include <cstddef>
#include <cstdint>

namespace rovigo::slam {

using Descriptor = std::array<std::uint64_t, 4>;

/// Number of bits that differ.
int hamming_distance(const Descriptor& a, const Descriptor& b);

struct NearestTwo {
  int index = -1;  ///< -1 when there is nothing to compare with
  int best = 257;
  int second = 257;
};

/// Best and second best of `count` descriptors by brute force; ties go to the lower index.
NearestTwo nearest_two(const Descriptor& query, const Descriptor* candidates, std::size_t count);

}  // namespace rovigo::slam
