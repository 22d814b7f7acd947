#include "slam/descriptor.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "slam/appearance_index.h"

namespace rovigo::slam {
namespace {

Descriptor random_descriptor(std::mt19937_64& random) {
  return {random(), random(), random(), random()};
}

Descriptor with_flipped_bits(Descriptor d, int bits, std::mt19937_64& random) {
  for (int i = 0; i < bits; ++i) {
    const auto bit = random() % 256;
    d[bit / 64] ^= std::uint64_t{1} << (bit % 64);
  }
  return d;
}

TEST(Descriptor, DistanceCountsTheBitsThatDiffer) {
  const Descriptor zero{};
  EXPECT_EQ(hamming_distance(zero, zero), 0);
  EXPECT_EQ(hamming_distance(zero, {1, 0, 0x8000000000000000u, 3}), 4);
  EXPECT_EQ(hamming_distance(zero, {~0ull, ~0ull, ~0ull, ~0ull}), 256);
}

TEST(Descriptor, NearestTwoAgreesWithComparingOneByOne) {
  std::mt19937_64 random(5);
  std::vector<Descriptor> all;
  for (int i = 0; i < 200; ++i) all.push_back(random_descriptor(random));
  const Descriptor query = with_flipped_bits(all[77], 20, random);
  const NearestTwo n = nearest_two(query, all.data(), all.size());
  EXPECT_EQ(n.index, 77);
  EXPECT_EQ(n.best, hamming_distance(query, all[77]));
  int second = 257;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i != 77) second = std::min(second, hamming_distance(query, all[i]));
  }
  EXPECT_EQ(n.second, second);
}

TEST(Descriptor, NothingToCompareWithGivesNoIndex) {
  EXPECT_EQ(nearest_two(Descriptor{}, nullptr, 0).index, -1);
}

TEST(AppearanceIndex, FindsTheViewWhoseDescriptorsComeBackNoisy) {
  std::mt19937_64 random(6);
  AppearanceIndex index;
  std::vector<std::vector<Descriptor>> views(40);
  for (int v = 0; v < 40; ++v) {
    for (int i = 0; i < 300; ++i)
      views[static_cast<std::size_t>(v)].push_back(random_descriptor(random));
    index.add(v, views[static_cast<std::size_t>(v)]);
  }
  std::vector<Descriptor> query;
  for (const Descriptor& d : views[23]) query.push_back(with_flipped_bits(d, 25, random));
  const auto found = index.query(query, 5);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found.front().view, 23);
  if (found.size() > 1) {
    EXPECT_GT(found[0].score, 5.0 * found[1].score);
  }
}

TEST(AppearanceIndex, ARemovedViewIsNotFoundAndItsNumbersServeAgain) {
  std::mt19937_64 random(8);
  const auto view = [&] {
    std::vector<Descriptor> out(50);
    for (Descriptor& d : out) d = {random(), random(), random(), random()};
    return out;
  };
  const auto first = view(), second = view(), third = view();
  AppearanceIndex index;
  const auto numbers = index.add(0, first);
  index.add(1, second);
  index.remove(0);
  EXPECT_TRUE(index.query(first, 5).empty());
  EXPECT_EQ(index.query(second, 5).front().view, 1);
  for (const int number : index.add(2, third)) EXPECT_LT(number, 50);
  EXPECT_EQ(index.query(third, 5).front().view, 2);
}

TEST(AppearanceIndex, AnEmptyIndexFindsNothing) {
  EXPECT_TRUE(AppearanceIndex().query({Descriptor{}}, 5).empty());
}

}  // namespace
}  // namespace rovigo::slam
