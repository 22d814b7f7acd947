// maps/SCHEMA.md describes what the program writes.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "maps/map_database.h"
#include "maps/map_file.h"
#include "tests/unit/maps/random_map.h"
#include "tests/unit/maps/test_support.h"

namespace rovigo::maps {
namespace {

using test::ScratchFolder;

TEST(MapSchema, PageHoldsEveryTable) {
  const std::string page = test::bytes_of(ROVIGO_SOURCE_DIR "/maps/SCHEMA.md");
  for (const auto& table : detail::all_tables()) {
    EXPECT_THAT(page, testing::HasSubstr(table.create_sql() + ";"));
  }
}

TEST(MapSchema, FitsIntoTheFirstPage) {
  // Recovery rests on it: the second page must already be a table's, not more schema.
  const ScratchFolder folder;
  save_map(SavedMap{}, folder / "a.rovigo");
  SQLite::Database db((folder / "a.rovigo").string());
  EXPECT_EQ(db.execAndGet("SELECT min(rootpage) FROM sqlite_master").getInt(), 2);
  EXPECT_EQ(db.execAndGet("SELECT max(rootpage) FROM sqlite_master").getInt(),
            static_cast<int>(detail::all_tables().size()) + 1);
}

TEST(MapSchema, AnotherProgramFindsWhatThePageSays) {
  const ScratchFolder folder;
  SavedMap map = test::random_map(1);
  map.places = {{"dock", {1.5, -2.0, 0.25}}};
  save_map(map, folder / "a.rovigo");
  SQLite::Database db((folder / "a.rovigo").string());
  EXPECT_EQ(db.execAndGet("PRAGMA application_id").getInt(), 0x5256474F);
  EXPECT_EQ(db.execAndGet("PRAGMA user_version").getInt(), 1);
  EXPECT_EQ(db.execAndGet("PRAGMA integrity_check").getString(), "ok");
  EXPECT_EQ(db.execAndGet("SELECT x_m FROM places WHERE name = 'dock'").getDouble(), 1.5);
  EXPECT_EQ(db.execAndGet("SELECT length(cells) FROM grid").getInt(),
            static_cast<int>(map.grid.cells.size()));
}

}  // namespace
}  // namespace rovigo::maps
