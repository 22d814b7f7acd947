#pragma once
// Which stored views look like this one? Locality-sensitive hashing of binary descriptors by bit
// sampling (Indyk & Motwani 1998): no vocabulary to download or train.

#include <cstdint>
#include <vector>

#include "slam/descriptor.h"

namespace rovigo::slam {

struct AppearanceScore {
  int view = 0;
  double score = 0.0;  ///< share of the query's descriptors found, rare ones counting more
};

class AppearanceIndex {
 public:
  AppearanceIndex();

  /// Views are numbered by the caller; adding one twice adds to it. Returns the numbers the
  /// descriptors are known by; those of removed ones serve again.
  std::vector<int> add(int view, const std::vector<Descriptor>& descriptors);
  void remove(int view);

  /// Best first; at most `most` views. Ties go to the lower number.
  std::vector<AppearanceScore> query(const std::vector<Descriptor>& descriptors,
                                     std::size_t most) const;

  /// Stored descriptors within `max_bits`, by number. Hashing misses some, the more the farther
  /// they are.
  std::vector<int> similar(const Descriptor& descriptor, int max_bits) const;

 private:
  static constexpr int kTables = 6;
  static constexpr int kKeyBits = 14;

  std::uint32_t key(const Descriptor& d, int table) const;

  std::vector<std::vector<int>> sampled_bits_;
  std::vector<std::vector<std::vector<int>>> tables_;  ///< numbers of descriptors
  std::vector<Descriptor> descriptors_;
  std::vector<int> view_of_;               ///< per descriptor
  std::vector<int> free_;                  ///< numbers of removed descriptors
  std::vector<std::vector<int>> in_view_;  ///< numbers of a view's descriptors
};

}  // namespace rovigo::slam
