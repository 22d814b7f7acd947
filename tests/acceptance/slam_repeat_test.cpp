// Same recording, same settings: the same map, byte for byte, whatever the number of threads.

#include <gtest/gtest.h>
#include <sched.h>

#include "tests/support/run_rovigo.h"
#include "tests/support/slam_case_runner.h"

namespace {

using namespace rovigo::test;

/// Children inherit it: what counts processors to start threads finds one.
class OnOneProcessor {
 public:
  OnOneProcessor() {
    sched_getaffinity(0, sizeof before_, &before_);
    cpu_set_t one;
    CPU_ZERO(&one);
    for (int i = 0; i < CPU_SETSIZE && CPU_COUNT(&one) == 0; ++i) {
      if (CPU_ISSET(i, &before_)) CPU_SET(i, &one);
    }
    sched_setaffinity(0, sizeof one, &one);
  }
  ~OnOneProcessor() { sched_setaffinity(0, sizeof before_, &before_); }
  OnOneProcessor(const OnOneProcessor&) = delete;
  OnOneProcessor& operator=(const OnOneProcessor&) = delete;

 private:
  cpu_set_t before_{};
};

std::string map_bytes(const std::filesystem::path& recording, const std::string& map) {
  const ProcessResult r = run_rovigo({"map", recording.string(), "-o", map});
  EXPECT_EQ(r.exit_code, 0) << r.err;
  return read_text(map);
}

TEST(SlamRepeats, GivesTheSameBytesOnOneProcessorAndOnAll) {
  const TemporaryFolder folder;
  const Drive drive{"random:12", "loop:6:12", "people", 12, 10.0};
  const auto recorded = record_drive(drive, folder.path(), "drive");
  const std::string on_all = map_bytes(recorded.recording, folder / "a.rovigo");
  ASSERT_GT(on_all.size(), 10000U);
  const OnOneProcessor limit;
  EXPECT_TRUE(on_all == map_bytes(recorded.recording, folder / "b.rovigo"));
}

}  // namespace
