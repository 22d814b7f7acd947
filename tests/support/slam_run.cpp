#include "tests/support/slam_run.h"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <ctime>
#include <fstream>

#include "slam/heap.h"
#include "slam/recording/recording.h"

namespace rovigo::test {

namespace {

constexpr int kTrimEvery = 500;    // observations, as `rovigo map`
constexpr int kSampleEvery = 100;  // frames
// Between frames that stay out every reading is answered: at two frames a second that is most of
// what a run would hold, and memory is what is measured.
constexpr double kAnswerEveryS = 0.05;

double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double resident_mb() {
  std::ifstream statm("/proc/self/statm");
  double total_pages = 0.0, resident_pages = 0.0;
  statm >> total_pages >> resident_pages;
  return resident_pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1024.0 * 1024.0);
}

double peak_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

double ms_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
      .count();
}

bool is_worth_keeping(const slam::PoseEstimate& answer, bool is_frame,
                      const std::vector<slam::PoseEstimate>& before) {
  return is_frame || before.empty() || answer.health != before.back().health ||
         answer.time_s >= before.back().time_s + kAnswerEveryS;
}

}  // namespace

SlamRun run_slam(const std::filesystem::path& recording) {
  SlamRun run;
  const auto reader = slam::open_recording(recording);
  slam::Slam slam(slam::SlamConfig{}, reader->info().rig);
  const double cpu_before = cpu_seconds();
  int taken = 0;
  while (true) {
    const auto asked = std::chrono::steady_clock::now();
    const auto observation = reader->next();
    if (!observation) break;
    const bool is_frame = IS_CLASS(*observation, mrpt::obs::CObservation3DRangeScan);
    const auto answer = slam.process(*observation);
    if (answer) {
      if (run.answers.empty()) run.first_pose_ms = ms_since(asked);
      if (is_worth_keeping(*answer, is_frame, run.answers)) run.answers.push_back(*answer);
    }
    if (++taken % kTrimEvery == 0) slam::give_back_free_memory();
    if (!is_frame) continue;
    run.frame_times_s.push_back(mrpt::Clock::toDouble(observation->timestamp));
    const int frames = static_cast<int>(run.frame_times_s.size());
    if (frames % kSampleEvery == 0) {
      run.samples.push_back(
          {frames, resident_mb(), cpu_seconds() - cpu_before, slam.summary().keyframes});
    }
  }
  run.map = slam.finish();
  const double cpu = cpu_seconds() - cpu_before;
  run.map.metadata.recording = reader->info().name;
  run.map.metadata.simulation = reader->info().simulation;
  run.summary = slam.summary();
  run.peak_mb = peak_mb();
  if (!run.frame_times_s.empty()) {
    run.cpu_ms_per_frame = 1e3 * cpu / static_cast<double>(run.frame_times_s.size());
  }
  return run;
}

}  // namespace rovigo::test
