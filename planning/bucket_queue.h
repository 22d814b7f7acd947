#pragma once
// A priority queue for priorities that hardly fall: Dial's ring of buckets.

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

namespace rovigo::planning {

/// Entries leave by the bucket that their priority falls into; inside a bucket the last in is the
/// first out (on grids that goes on towards the goal instead of sweeping all that is equally near).
template <typename Entry>
class BucketQueue {
 public:
  /// Empties it. Buckets are 2^shift wide; no entry's priority will be more than `span` above that
  /// of the bucket which is due, and `first` is the least.
  void restart(std::uint32_t first, std::uint32_t span, int shift) {
    shift_ = shift;
    due_ = first >> shift;
    waiting_ = 0;
    const std::size_t ring = std::bit_ceil((span >> shift) + std::size_t{2});
    if (buckets_.size() < ring) buckets_.resize(ring);
    for (auto& bucket : buckets_) bucket.clear();
  }

  /// What should have left already leaves next.
  void push(std::uint32_t priority, const Entry& entry) {
    const std::uint32_t bucket = std::max(priority >> shift_, due_);
    buckets_[bucket & (buckets_.size() - 1)].push_back(entry);
    ++waiting_;
  }

  /// False when nothing waits in the bucket that `limit` falls into or in one below.
  bool pop(std::uint32_t limit, Entry& entry) {
    for (; waiting_ > 0 && due_ <= limit >> shift_; ++due_) {
      auto& bucket = buckets_[due_ & (buckets_.size() - 1)];
      if (bucket.empty()) continue;
      entry = bucket.back();
      bucket.pop_back();
      --waiting_;
      return true;
    }
    return false;
  }

  /// Does an entry of this priority leave before the next bucket's turn?
  bool is_due(std::uint32_t priority) const { return priority >> shift_ <= due_; }

  std::size_t memory_bytes() const {
    std::size_t bytes = 0;
    for (const auto& bucket : buckets_) bytes += bucket.capacity() * sizeof(Entry);
    return bytes;
  }

 private:
  int shift_ = 0;
  std::uint32_t due_ = 0;  ///< the bucket that is, counted from priority 0
  std::size_t waiting_ = 0;
  std::vector<std::vector<Entry>> buckets_;
};

}  // namespace rovigo::planning
