#include "slam/descriptor.h"

#include <bit>

// Debian's baseline x86-64 has no popcnt; these two loops are chosen at load time. The file holds
// nothing else, so that no header of a library is compiled with other flags.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define ROVIGO_POPCNT_CLONES __attribute__((target_clones("popcnt", "default")))
#else
#define ROVIGO_POPCNT_CLONES
#endif

namespace rovigo::slam {

ROVIGO_POPCNT_CLONES
int hamming_distance(const Descriptor& a, const Descriptor& b) {
  return std::popcount(a[0] ^ b[0]) + std::popcount(a[1] ^ b[1]) + std::popcount(a[2] ^ b[2]) +
         std::popcount(a[3] ^ b[3]);
}

ROVIGO_POPCNT_CLONES
NearestTwo nearest_two(const Descriptor& query, const Descriptor* candidates, std::size_t count) {
  NearestTwo out;
  for (std::size_t i = 0; i < count; ++i) {
    const Descriptor& c = candidates[i];
    const int d = std::popcount(query[0] ^ c[0]) + std::popcount(query[1] ^ c[1]) +
                  std::popcount(query[2] ^ c[2]) + std::popcount(query[3] ^ c[3]);
    if (d < out.best) {
      out.second = out.best;
      out.best = d;
      out.index = static_cast<int>(i);
    } else if (d < out.second) {
      out.second = d;
    }
  }
  return out;
}

}  // namespace rovigo::slam
