#include "maps/map_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>

#include "maps/error.h"
#include "tests/unit/maps/random_map.h"
#include "tests/unit/maps/test_support.h"

namespace rovigo::maps {
namespace {

using test::bytes_of;
using test::difference;
using test::put_bytes;
using test::random_map;
using test::ScratchFolder;
using testing::HasSubstr;

std::string refusal(const std::filesystem::path& path) {
  try {
    load_map(path);
  } catch (const InputError& e) {
    return e.what();
  }
  return "loaded";
}

TEST(MapFile, ComesBackToTheLastBit) {
  const ScratchFolder folder;
  const SavedMap map = random_map(1);
  save_map(map, folder / "a.rovigo");
  EXPECT_EQ(difference(load_map(folder / "a.rovigo"), map), "");
  EXPECT_TRUE(is_map_file(folder / "a.rovigo"));
  EXPECT_EQ(folder.count_entries(), 1u) << "no journal may stay behind";
}

TEST(MapFile, SameMapGivesTheSameBytes) {
  const ScratchFolder folder;
  save_map(random_map(3), folder / "a.rovigo");
  save_map(random_map(3), folder / "b.rovigo");
  EXPECT_EQ(bytes_of(folder / "a.rovigo"), bytes_of(folder / "b.rovigo"));
  save_map(load_map(folder / "a.rovigo"), folder / "c.rovigo");
  EXPECT_EQ(bytes_of(folder / "a.rovigo"), bytes_of(folder / "c.rovigo"));
}

TEST(MapFile, EmptyMapIsFine) {
  const ScratchFolder folder;
  save_map(SavedMap{}, folder / "a.rovigo");
  EXPECT_EQ(difference(load_map(folder / "a.rovigo"), SavedMap{}), "");
}

TEST(MapFile, NamesWithOddCharactersOpen) {
  const ScratchFolder folder;
  const auto path = folder / "my lab? 100% #2.rovigo";
  save_map(random_map(2), path);
  EXPECT_EQ(difference(load_map(path), random_map(2)), "");
}

TEST(MapFile, SaysWhatIsWrongWithOtherFiles) {
  const ScratchFolder folder;
  EXPECT_THAT(refusal(folder / "none.rovigo"), HasSubstr("no such file"));
  EXPECT_THAT(refusal(folder.path()), HasSubstr("folder"));
  put_bytes(folder / "empty.rovigo", "");
  EXPECT_THAT(refusal(folder / "empty.rovigo"), HasSubstr("empty"));
  put_bytes(folder / "text.rovigo", "this is some text, quite long, but no map at all");
  EXPECT_THAT(refusal(folder / "text.rovigo"), HasSubstr("no Rovigo map"));
  std::string sqlite(200, '\0');
  sqlite.replace(0, 15, "SQLite format 3");
  put_bytes(folder / "other.rovigo", sqlite);
  EXPECT_THAT(refusal(folder / "other.rovigo"), HasSubstr("application id"));
}

TEST(MapFile, NewerSchemaIsNamed) {
  const ScratchFolder folder;
  save_map(random_map(1), folder / "a.rovigo");
  std::string bytes = bytes_of(folder / "a.rovigo");
  bytes[63] = 2;  // SQLite's user_version, big-endian
  put_bytes(folder / "a.rovigo", bytes);
  EXPECT_THAT(refusal(folder / "a.rovigo"), HasSubstr("schema 2"));
}

TEST(MapFile, CutOffFileIsNamed) {
  const ScratchFolder folder;
  save_map(random_map(1), folder / "a.rovigo");
  const std::string bytes = bytes_of(folder / "a.rovigo");
  put_bytes(folder / "a.rovigo", bytes.substr(0, bytes.size() - 5000));
  EXPECT_THAT(refusal(folder / "a.rovigo"),
              HasSubstr("instead of " + std::to_string(bytes.size())));
}

TEST(MapFile, DamagedBlobIsNamedWithTableAndRow) {
  const ScratchFolder folder;
  SavedMap map = random_map(1);
  map.keyframes = {{7, 0.0, {}, Blob(50000, 0xab), {}, {}}};
  map.edges.clear();
  save_map(map, folder / "a.rovigo");
  std::string bytes = bytes_of(folder / "a.rovigo");
  const std::size_t inside = bytes.find(std::string(2000, '\xab')) + 1000;
  bytes[inside] = '\x2b';
  put_bytes(folder / "a.rovigo", bytes);
  EXPECT_THAT(refusal(folder / "a.rovigo"),
              testing::AllOf(HasSubstr("keyframes row 1"), HasSubstr("color_jpeg"),
                             HasSubstr("--recover")));
}

TEST(MapFile, MapsThatCannotBeAreNotSaved) {
  const ScratchFolder folder;
  put_bytes(folder / "a.rovigo", "old");
  SavedMap twice = random_map(1);
  twice.keyframes = {StoredKeyframe{}, StoredKeyframe{}};
  EXPECT_THROW(save_map(twice, folder / "a.rovigo"), InputError);
  SavedMap dangling = random_map(1);
  dangling.edges.emplace_back();
  dangling.edges[0].to = 78;
  EXPECT_THROW(save_map(dangling, folder / "a.rovigo"), InputError);
  SavedMap not_finite = random_map(1);
  not_finite.places = {{"x", {NAN, 0.0, 0.0}}};
  EXPECT_THROW(save_map(not_finite, folder / "a.rovigo"), InputError);
  SavedMap misfit = random_map(1);
  misfit.grid.cells.push_back(0);
  EXPECT_THROW(save_map(misfit, folder / "a.rovigo"), InputError);
  EXPECT_EQ(bytes_of(folder / "a.rovigo"), "old");
  EXPECT_EQ(folder.count_entries(), 1u);
}

TEST(MapFile, FullDiskLeavesTheOldMap) {
  const ScratchFolder folder;
  save_map(random_map(1), folder / "a.rovigo");
  const std::string old = bytes_of(folder / "a.rovigo");
  SavedMap big = random_map(2);
  big.keyframes = {{0, 0.0, {}, Blob(4 << 20, 1), {}, {}}};
  big.edges.clear();
  rlimit limit = {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &limit), 0);
  const rlimit small = {1 << 20, limit.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  EXPECT_THROW(save_map(big, folder / "a.rovigo"), InputError);
  ::setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(bytes_of(folder / "a.rovigo"), old);
  EXPECT_EQ(folder.count_entries(), 1u);
}

TEST(MapFile, UnwritableFolderIsNamed) {
  EXPECT_THROW(save_map(random_map(1), "/proc/none/a.rovigo"), InputError);
}

TEST(RecoverMap, WholeMapComesBackWhole) {
  const ScratchFolder folder;
  save_map(random_map(5), folder / "a.rovigo");
  const RecoveredMap recovered = recover_map(folder / "a.rovigo");
  EXPECT_EQ(difference(recovered.map, random_map(5)), "");
  EXPECT_TRUE(recovered.lost.empty());
}

TEST(RecoverMap, DestroyedFirstPageCostsNothing) {
  const ScratchFolder folder;
  save_map(random_map(5), folder / "a.rovigo");
  std::string bytes = bytes_of(folder / "a.rovigo");
  bytes.replace(0, 4096, 4096, 'x');
  put_bytes(folder / "a.rovigo", bytes);
  EXPECT_EQ(difference(recover_map(folder / "a.rovigo").map, random_map(5)), "");
}

TEST(RecoverMap, OneDamagedPageCostsOnlyWhatLiesInIt) {
  const ScratchFolder folder;
  SavedMap map = random_map(6);
  map.keyframes.clear();
  map.edges.clear();
  for (int i = 0; i < 10; ++i) map.keyframes.push_back({i, 0.0, {}, Blob(30000, 0xcd), {}, {}});
  save_map(map, folder / "a.rovigo");
  std::string bytes = bytes_of(folder / "a.rovigo");
  const std::size_t at = bytes.find(std::string(4000, '\xcd'));
  ASSERT_NE(at, std::string::npos);
  bytes[at + 2000] = 0;
  put_bytes(folder / "a.rovigo", bytes);
  EXPECT_THROW(load_map(folder / "a.rovigo"), InputError);
  const RecoveredMap recovered = recover_map(folder / "a.rovigo");
  ASSERT_EQ(recovered.map.keyframes.size(), 10u);
  EXPECT_TRUE(recovered.map.keyframes[0].color_jpeg.empty());
  EXPECT_EQ(recovered.map.keyframes[1].color_jpeg, map.keyframes[1].color_jpeg);
  EXPECT_EQ(recovered.map.grid.cells, map.grid.cells);
  ASSERT_EQ(recovered.lost.size(), 1u);
  EXPECT_THAT(recovered.lost[0], HasSubstr("keyframes row 1: color_jpeg"));
  save_map(recovered.map, folder / "b.rovigo");
  EXPECT_EQ(difference(load_map(folder / "b.rovigo"), recovered.map), "");
}

TEST(RecoverMap, ForeignFileHoldsNothing) {
  const ScratchFolder folder;
  put_bytes(folder / "a.rovigo", std::string(20000, 'z'));
  EXPECT_THROW(recover_map(folder / "a.rovigo"), InputError);
  EXPECT_THROW(recover_map(folder / "none.rovigo"), InputError);
}

}  // namespace
}  // namespace rovigo::maps
