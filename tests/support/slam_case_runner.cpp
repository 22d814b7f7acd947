#include "tests/support/slam_case_runner.h"

#include <algorithm>
#include <stdexcept>

#include "app/resources.h"
#include "tests/support/run_rovigo.h"

namespace rovigo::test {

namespace fs = std::filesystem;

namespace {

std::string resolved(const std::string& name) {
  return name.find('/') == std::string::npos ? name : std::string(ROVIGO_SOURCE_DIR) + "/" + name;
}

}  // namespace

RecordedDrive record_drive(const Drive& drive, const fs::path& folder, const std::string& name) {
  RecordedDrive out{folder / (name + ".rawlog"), folder / (name + ".truth"),
                    app::open_scenario(resolved(drive.scenario))};
  const ProcessResult r =
      run_rovigo({"record", "--world", drive.world, "--route", resolved(drive.route), "--scenario",
                  resolved(drive.scenario), "--seed", std::to_string(drive.seed), "--fps",
                  std::to_string(drive.fps), "-o", out.recording.string(), "--truth",
                  out.truth.string(), "--json"});
  if (r.exit_code != 0) {
    throw std::runtime_error("recording " + drive.world + ", " + drive.route + ", " +
                             drive.scenario + ": " + r.err + r.out);
  }
  return out;
}

SlamScore score_drive(const RecordedDrive& drive) {
  const SlamRun run = run_slam(drive.recording);
  return score_run(run, load_truth(drive.truth), drive.scenario);
}

SlamScore score_tum(const fs::path& recording) {
  return score_run(run_slam(recording), load_camera_truth(recording / "groundtruth.txt"), {});
}

Drive steady(Drive drive) {
  drive.scenario = "default";
  return drive;
}

bool compares_with_steady_light(const SlamCase& c) {
  return std::any_of(c.checks.begin(), c.checks.end(),
                     [](const Check& check) { return check.figure == &SlamScore::steady_ratio; });
}

}  // namespace rovigo::test
