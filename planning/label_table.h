#pragma once
// What a search knows of the few cells it labels, close together in memory.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace rovigo::planning {

/// A hash table by cell (linear probing, at most half full). A search that leaps labels a cell in
/// thousands: an array with a place for each would miss every cache, every time.
class LabelTable {
 public:
  static constexpr std::uint32_t kNoCost = 0xFFFFFFFFU;
  struct Label {
    std::uint32_t cell = 0;
    std::uint32_t cost = kNoCost;  ///< kNoCost: this place is empty
    std::uint32_t before = 0;
  };

  LabelTable() { places_.resize(std::size_t{1} << bits_); }

  /// nullptr where there is none.
  const Label* find(std::uint32_t cell) const {
    const Label& label = places_[place_of(cell)];
    return label.cost == kNoCost ? nullptr : &label;
  }

  /// The new label takes the place of the old one.
  void set(const Label& label) {
    const std::size_t place = place_of(label.cell);
    const bool is_new = places_[place].cost == kNoCost;
    places_[place] = label;
    if (!is_new) return;
    taken_.push_back(static_cast<std::uint32_t>(place));
    if (2 * taken_.size() > places_.size()) grow();
  }

  void clear() {
    for (const std::uint32_t place : taken_) places_[place].cost = kNoCost;
    taken_.clear();
  }

  std::size_t memory_bytes() const {
    return places_.capacity() * sizeof(Label) + taken_.capacity() * sizeof(std::uint32_t);
  }

 private:
  /// Where the cell's label is, or would be.
  std::size_t place_of(std::uint32_t cell) const {
    std::size_t place = (cell * 2654435769U) >> (32U - bits_);  // Knuth's multiplicative hashing
    while (places_[place].cost != kNoCost && places_[place].cell != cell) {
      place = (place + 1) & (places_.size() - 1);
    }
    return place;
  }

  void grow() {
    std::vector<Label> old(places_.size() * 2);
    old.swap(places_);
    ++bits_;
    for (std::uint32_t& place : taken_) {
      const Label label = old[place];
      const std::size_t now = place_of(label.cell);
      places_[now] = label;
      place = static_cast<std::uint32_t>(now);
    }
  }

  unsigned bits_ = 8;
  std::vector<Label> places_;
  std::vector<std::uint32_t> taken_;
};

}  // namespace rovigo::planning
