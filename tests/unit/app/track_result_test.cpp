#include "app/track/track_result.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/track/track_run.h"
#include "maps/error.h"
#include "tests/support/run_rovigo.h"

namespace rovigo::app {
namespace {

using ::testing::HasSubstr;

TrackResult result_of(std::initializer_list<const char*> names) {
  TrackResult result;
  result.suite = "s";
  result.suite_hash = "h";
  result.total_runs = 3;
  for (const char* name : names) {
    TrackRun run;
    run.what.name = name;
    result.runs.push_back(run_json(run));
  }
  return result;
}

std::string refusal_of(const std::vector<std::filesystem::path>& files) {
  try {
    merge_results(files);
  } catch (const maps::InputError& e) {
    return e.what();
  }
  return "taken";
}

class TrackMerge : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const TrackResult& result) {
    return write_text(name, result_json(result).dump(2));
  }
  std::filesystem::path write_text(const std::string& name, const std::string& text) {
    test::write_text(folder_ / name, text);
    return folder_ / name;
  }
  test::TemporaryFolder folder_;
};

TEST_F(TrackMerge, SharesInAnyOrderGiveTheWholeByteForByte) {
  const auto one = write("1", result_of({"a", "c"}));
  const auto two = write("2", result_of({"b"}));
  const std::string whole = result_json(result_of({"a", "b", "c"})).dump(2);
  EXPECT_EQ(result_json(merge_results({one, two})).dump(2), whole);
  EXPECT_EQ(result_json(merge_results({two, one})).dump(2), whole);
}

TEST_F(TrackMerge, MissingRepeatedAndForeignSharesAreRefused) {
  const auto one = write("1", result_of({"a", "c"}));
  const auto two = write("2", result_of({"b"}));
  TrackResult other = result_of({"b"});
  other.suite_hash = "x";
  EXPECT_THAT(refusal_of({one}), HasSubstr("2 of the suite's 3 runs"));
  EXPECT_THAT(refusal_of({one, two, two}), HasSubstr("there twice"));
  EXPECT_THAT(refusal_of({one, write("3", other)}), HasSubstr("of another suite"));
}

TEST_F(TrackMerge, DamagedFilesAreRefusedInOneSentence) {
  const std::string good = result_json(result_of({"a", "b", "c"})).dump();
  for (std::size_t length = 0; length < good.size(); length += 37) {
    EXPECT_THROW(merge_results({write_text("cut", good.substr(0, length))}), maps::InputError);
  }
  auto object = nlohmann::ordered_json::parse(good);
  object["runs"][1]["duration_s"] = "long";
  EXPECT_THAT(refusal_of({write_text("typed", object.dump())}), HasSubstr("run 2 is not complete"));
  EXPECT_THAT(refusal_of({folder_ / "none"}), HasSubstr("none"));
}

TEST(TrackShard, SharesCoverEveryRunOnce) {
  for (std::size_t run = 0; run < 20; ++run) {
    int held = 0;
    for (std::size_t i = 1; i <= 7; ++i) held += Shard{i, 7}.holds(run) ? 1 : 0;
    EXPECT_EQ(held, 1);
  }
}

TEST(TrackShard, OnlyAShareOfAWholeIsTaken) {
  EXPECT_EQ(parse_shard("2/8").index, 2U);
  for (const char* bad : {"", "1", "0/3", "4/3", "1/0", "a/b", "1/2/3", "1.5/2", "-1/2", "1/1e9"}) {
    EXPECT_THROW(parse_shard(bad), maps::InputError) << bad;
  }
}

}  // namespace
}  // namespace rovigo::app
