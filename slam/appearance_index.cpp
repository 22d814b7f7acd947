#include "slam/appearance_index.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace rovigo::slam {

namespace {

constexpr int kSimilarBits = 52;       // of 256: descriptors nearer than this are one corner
constexpr std::size_t kCrowded = 400;  // a fuller bucket tells nothing apart

}  // namespace

AppearanceIndex::AppearanceIndex() {
  // The sampled bits are part of the method: a fixed seed makes every index the same.
  std::mt19937_64 random(20260101);
  for (int t = 0; t < kTables; ++t) {
    std::vector<int> bits;
    while (static_cast<int>(bits.size()) < kKeyBits) {
      const int bit = static_cast<int>(random() % 256);
      if (std::find(bits.begin(), bits.end(), bit) == bits.end()) bits.push_back(bit);
    }
    sampled_bits_.push_back(bits);
    tables_.emplace_back(std::size_t{1} << kKeyBits);
  }
}

std::uint32_t AppearanceIndex::key(const Descriptor& d, int table) const {
  std::uint32_t k = 0;
  for (const int bit : sampled_bits_[static_cast<std::size_t>(table)]) {
    k = (k << 1) |
        static_cast<std::uint32_t>((d[static_cast<std::size_t>(bit / 64)] >> (bit % 64)) & 1);
  }
  return k;
}

std::vector<int> AppearanceIndex::add(int view, const std::vector<Descriptor>& descriptors) {
  const auto v = static_cast<std::size_t>(view);
  if (in_view_.size() <= v) in_view_.resize(v + 1);
  std::vector<int> numbers;
  numbers.reserve(descriptors.size());
  for (const Descriptor& d : descriptors) {
    if (free_.empty()) {
      free_.push_back(static_cast<int>(descriptors_.size()));
      if (descriptors_.size() == descriptors_.capacity()) {
        descriptors_.reserve(descriptors_.size() + descriptors_.size() / 8 + 1024);
      }
      descriptors_.emplace_back();
      view_of_.push_back(-1);
    }
    const int number = free_.back();
    free_.pop_back();
    descriptors_[static_cast<std::size_t>(number)] = d;
    view_of_[static_cast<std::size_t>(number)] = view;
    numbers.push_back(number);
    for (int t = 0; t < kTables; ++t) {
      tables_[static_cast<std::size_t>(t)][key(d, t)].push_back(number);
    }
  }
  in_view_[v].insert(in_view_[v].end(), numbers.begin(), numbers.end());
  return numbers;
}

void AppearanceIndex::remove(int view) {
  if (static_cast<std::size_t>(view) >= in_view_.size()) return;
  std::vector<int>& numbers = in_view_[static_cast<std::size_t>(view)];
  for (const int number : numbers) {
    const Descriptor& d = descriptors_[static_cast<std::size_t>(number)];
    for (int t = 0; t < kTables; ++t) {
      std::erase(tables_[static_cast<std::size_t>(t)][key(d, t)], number);
    }
    free_.push_back(number);
  }
  numbers = {};
}

std::vector<AppearanceScore> AppearanceIndex::query(const std::vector<Descriptor>& descriptors,
                                                    std::size_t most) const {
  std::vector<double> votes(in_view_.size(), 0.0);
  std::vector<int> voted_for(in_view_.size(), -1);  // each descriptor votes once for a view
  std::vector<int> found;
  const auto views = std::count_if(in_view_.begin(), in_view_.end(),
                                   [](const auto& numbers) { return !numbers.empty(); });
  for (std::size_t q = 0; q < descriptors.size(); ++q) {
    found.clear();
    for (int t = 0; t < kTables; ++t) {
      const auto& bucket = tables_[static_cast<std::size_t>(t)][key(descriptors[q], t)];
      if (bucket.size() > kCrowded) continue;
      for (const int number : bucket) {
        const int view_number = view_of_[static_cast<std::size_t>(number)];
        const auto view = static_cast<std::size_t>(view_number);
        if (voted_for[view] == static_cast<int>(q)) continue;
        const Descriptor& d = descriptors_[static_cast<std::size_t>(number)];
        if (hamming_distance(descriptors[q], d) > kSimilarBits) continue;
        voted_for[view] = static_cast<int>(q);
        found.push_back(view_number);
      }
    }
    if (found.empty()) continue;
    // What many views show says little about which one this is.
    const double rarity =
        std::log(1.0 + static_cast<double>(views) / static_cast<double>(found.size()));
    for (const int view : found) votes[static_cast<std::size_t>(view)] += rarity;
  }
  std::vector<AppearanceScore> out;
  for (std::size_t v = 0; v < votes.size(); ++v) {
    if (votes[v] <= 0) continue;
    const double norm =
        std::sqrt(static_cast<double>(in_view_[v].size()) *
                  static_cast<double>(std::max<std::size_t>(1, descriptors.size())));
    out.push_back({static_cast<int>(v), votes[v] / norm});
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const auto& a, const auto& b) { return a.score > b.score; });
  if (out.size() > most) out.resize(most);
  return out;
}

std::vector<int> AppearanceIndex::similar(const Descriptor& descriptor, int max_bits) const {
  std::vector<int> out;
  for (int t = 0; t < kTables; ++t) {
    for (const int number : tables_[static_cast<std::size_t>(t)][key(descriptor, t)]) {
      const Descriptor& d = descriptors_[static_cast<std::size_t>(number)];
      if (hamming_distance(descriptor, d) <= max_bits) out.push_back(number);
    }
  }
  return out;
}

}  // namespace rovigo::slam
