#include "app/query_batch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "maps/error.h"
#include "tests/support/run_rovigo.h"

namespace rovigo::app {
namespace {

using test::TemporaryFolder;
using test::write_text;

const maps::GridGeometry kGrid{1.0, {0.0, 0.0}, 20, 10};

TEST(QueryBatch, ReadsCsvWithAndWithoutHeader) {
  const TemporaryFolder folder;
  write_text(folder / "a.csv", "start_x,start_y,goal_x,goal_y\n1,2,3,4\n\n-1,0.5,2,2\r\n");
  const auto queries = read_query_batch(folder / "a.csv", kGrid);
  ASSERT_EQ(queries.size(), 2u);
  EXPECT_EQ(queries[1].start.x, -1.0);
  EXPECT_EQ(queries[1].goal.y, 2.0);
}

TEST(QueryBatch, AScenarioCellIsTheCentreOfACellCountedFromTheTop) {
  const TemporaryFolder folder;
  write_text(folder / "a.scen", "version 1\n0\tmap\t20\t10\t3\t0\t5\t9\t9.0\n");
  const auto queries = read_query_batch(folder / "a.scen", kGrid);
  ASSERT_EQ(queries.size(), 1u);
  EXPECT_EQ(queries[0].start.x, 3.5);
  EXPECT_EQ(queries[0].start.y, 9.5);
  EXPECT_EQ(queries[0].goal.y, 0.5);
  EXPECT_THROW(read_query_batch(folder / "a.scen", {1.0, {0.0, 0.0}, 21, 10}), maps::InputError);
}

TEST(QueryBatch, ABadLineIsNamed) {
  const TemporaryFolder folder;
  for (const std::string line : {"1,2,3", "1,2,3,x", "1,2,3,4,5", "nan,0,0,0"}) {
    write_text(folder / "a.csv", "0,0,1,1\n" + line + "\n");
    try {
      read_query_batch(folder / "a.csv", kGrid);
      FAIL() << line;
    } catch (const maps::InputError& e) {
      EXPECT_THAT(e.what(), testing::HasSubstr("line 2"));
    }
  }
  EXPECT_THROW(read_query_batch(folder / "missing.csv", kGrid), maps::InputError);
}

}  // namespace
}  // namespace rovigo::app
