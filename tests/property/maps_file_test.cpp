// The map file under attack: random content, cut files, flipped bits, a killed writer.

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <random>

#include "maps/error.h"
#include "maps/map_file.h"
#include "tests/unit/maps/random_map.h"
#include "tests/unit/maps/test_support.h"

namespace rovigo::maps {
namespace {

using test::bytes_of;
using test::difference;
using test::put_bytes;
using test::random_map;
using test::ScratchFolder;

/// Runs `check(seed, folder, path, map)` on random maps; failures name the seed.
template <class Check>
void on_random_maps(Check check) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const ScratchFolder folder;
    check(seed, folder, folder / "a.rovigo", random_map(seed));
  }
}

/// Refused with a clear error, or the very map that was saved: never something else.
void expect_refused_or_same(const std::filesystem::path& path, const SavedMap& map,
                            const std::string& context) {
  try {
    EXPECT_EQ(difference(load_map(path), map), "") << context << ": loaded, but changed";
  } catch (const InputError&) {
  }
}

/// Whatever comes out can be saved again, and holds no keyframe that was not there.
void expect_recovery_is_sound(const std::filesystem::path& path, const SavedMap& map,
                              const ScratchFolder& folder) {
  try {
    const RecoveredMap recovered = recover_map(path);
    EXPECT_LE(recovered.map.keyframes.size(), map.keyframes.size());
    if (difference(recovered.map, map) != "") {
      EXPECT_FALSE(recovered.lost.empty()) << "lost something silently";
    }
    save_map(recovered.map, folder / "recovered.rovigo");
  } catch (const InputError&) {
  }
}

TEST(RandomMaps, RoundTrip) {
  on_random_maps([](std::uint64_t, const ScratchFolder&, const std::filesystem::path& file,
                    const SavedMap& map) {
    save_map(map, file);
    EXPECT_EQ(difference(load_map(file), map), "");
  });
}

TEST(RandomMaps, CutFilesAreRefused) {
  on_random_maps([](std::uint64_t seed, const ScratchFolder& folder,
                    const std::filesystem::path& file, const SavedMap& map) {
    save_map(map, file);
    const std::string whole = bytes_of(file);
    std::mt19937_64 rng(seed);
    for (int i = 0; i < 15; ++i) {
      put_bytes(file, whole.substr(0, rng() % whole.size()));
      EXPECT_THROW(load_map(file), InputError);
      expect_recovery_is_sound(file, map, folder);
    }
  });
}

TEST(RandomMaps, FlippedBitsAreFoundOrHarmless) {
  on_random_maps([](std::uint64_t seed, const ScratchFolder& folder,
                    const std::filesystem::path& file, const SavedMap& map) {
    save_map(map, file);
    const std::string whole = bytes_of(file);
    std::mt19937_64 rng(seed);
    for (int i = 0; i < 150; ++i) {
      std::string damaged = whole;
      // Half of them where the structure is: in the headers of pages.
      std::size_t at = rng() % whole.size();
      if (i % 2 == 0) at = std::min(at / 4096 * 4096 + rng() % 64, whole.size() - 1);
      damaged[at] = static_cast<char>(damaged[at] ^ (1 << rng() % 8));
      put_bytes(file, damaged);
      expect_refused_or_same(file, map, "bit flipped at byte " + std::to_string(at));
      if (i % 10 == 0) expect_recovery_is_sound(file, map, folder);
    }
  });
}

TEST(RandomMaps, OverwrittenStretchesAreFoundOrHarmless) {
  on_random_maps([](std::uint64_t seed, const ScratchFolder& folder,
                    const std::filesystem::path& file, const SavedMap& map) {
    save_map(map, file);
    const std::string whole = bytes_of(file);
    std::mt19937_64 rng(seed + 1000);
    for (int i = 0; i < 40; ++i) {
      std::string damaged = whole;
      const std::size_t at = rng() % whole.size();
      const std::size_t count = std::min<std::size_t>(rng() % 6000, whole.size() - at);
      for (std::size_t k = 0; k < count; ++k) damaged[at + k] = static_cast<char>(rng());
      put_bytes(file, damaged);
      expect_refused_or_same(file, map, "overwritten at byte " + std::to_string(at));
      expect_recovery_is_sound(file, map, folder);
    }
  });
}

TEST(KilledWriter, OldOrNewMapOpensWhole) {
  const ScratchFolder folder;
  const auto path = folder / "a.rovigo";
  const SavedMap maps[2] = {random_map(21, 12), random_map(22, 12)};
  save_map(maps[0], path);
  std::mt19937_64 rng(7);
  int seen[2] = {0, 0};
  for (int i = 0; i < 60; ++i) {
    int saved_once[2];
    ASSERT_EQ(::pipe(saved_once), 0);
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      save_map(maps[i % 2], path);
      if (::write(saved_once[1], "x", 1) != 1) ::_exit(1);
      for (int k = i + 1;; ++k) save_map(maps[k % 2], path);
    }
    ::close(saved_once[1]);
    // Every third is killed at once, the others somewhere in a later save.
    char byte = 0;
    if (i % 3 != 0) {
      ASSERT_EQ(::read(saved_once[0], &byte, 1), 1);
    }
    ::usleep(static_cast<useconds_t>(rng() % 20000));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    ::close(saved_once[0]);
    const SavedMap found = load_map(path);
    const bool first = difference(found, maps[0]) == "";
    EXPECT_TRUE(first || difference(found, maps[1]) == "") << "after kill " << i;
    ++seen[first ? 0 : 1];
  }
  EXPECT_GT(seen[0], 0);
  EXPECT_GT(seen[1], 0);
}

}  // namespace
}  // namespace rovigo::maps
