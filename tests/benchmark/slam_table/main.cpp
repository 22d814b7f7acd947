// The table of SLAM's hard cases: records each drive, maps it in a process of its own, judges it.

#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/resources.h"
#include "tests/benchmark/slam_table/table.h"
#include "tests/support/run_rovigo.h"
#include "tests/support/slam_case_runner.h"

namespace rovigo::slam_table {

namespace fs = std::filesystem;
using nlohmann::json;
using test::SlamScore;

namespace {

struct Options {
  fs::path folder = "runs/bench";
  std::vector<std::string> cases;
  bool quick = false;
  bool keep = false;
  bool list = false;
};

json to_json(const SlamScore& score) {
  json object = json::object();
  for (const auto& f : test::all_figures()) {
    if (!(score.*f.value)) continue;
    const double value = *(score.*f.value);
    if (std::isfinite(value))
      object[f.name] = value;
    else
      object[f.name] = "never";
  }
  return object;
}

SlamScore from_json(const json& object) {
  SlamScore score;
  for (const auto& f : test::all_figures()) {
    if (!object.contains(f.name)) continue;
    const json& value = object[f.name];
    score.*f.value = value.is_number() ? value.get<double>() : INFINITY;
  }
  return score;
}

/// In a process of its own, so that peak memory and crashes are its own too.
SlamScore scored_apart(const std::function<SlamScore()>& score, const fs::path& results) {
  fs::remove(results);
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("cannot start a process to map in");
  if (child == 0) {
    try {
      std::ofstream(results) << to_json(score()).dump(2) << "\n";
      _exit(0);
    } catch (const std::exception& e) {
      std::fprintf(stderr, "%s\n", e.what());
      _exit(1);
    }
  }
  int status = 0;
  waitpid(child, &status, 0);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw std::runtime_error("mapping failed");
  return from_json(json::parse(std::ifstream(results)));
}

/// Results and truth stay; the recording goes, for it is large.
SlamScore run_drive(const test::Drive& drive, const fs::path& folder, const std::string& name,
                    const Options& options) {
  const auto recorded = test::record_drive(drive, folder, name);
  const SlamScore score =
      scored_apart([&] { return test::score_drive(recorded); }, folder / (name + ".json"));
  if (!options.keep) fs::remove(recorded.recording);
  return score;
}

CaseResult run_case(const test::SlamCase& c, const Options& options) {
  CaseResult result{&c, {}, {}};
  const auto& drives = options.quick ? c.quick : c.full;
  for (std::size_t i = 0; i < drives.size(); ++i) {
    const test::Drive& d = drives[i];
    const std::string name = c.name + "_" + std::to_string(i + 1);
    std::fprintf(stderr, "%s: %s, %s, %s, seed %llu\n", name.c_str(), d.world.c_str(),
                 d.route.c_str(), d.scenario.c_str(), static_cast<unsigned long long>(d.seed));
    try {
      SlamScore score = run_drive(d, options.folder, name, options);
      if (test::compares_with_steady_light(c)) {
        const auto other = run_drive(test::steady(d), options.folder, name + "_steady", options);
        score.steady_ratio = *score.ate_m / *other.ate_m;
      }
      std::fprintf(stderr, "  %s\n", to_json(score).dump().c_str());
      result.scores.push_back(score);
    } catch (const std::exception& e) {
      result.failures.push_back(name + ": " + e.what());
      std::fprintf(stderr, "  %s\n", e.what());
    }
  }
  if (!c.recording) return result;
  const fs::path recording = test::test_data() / *c.recording;
  if (!fs::exists(recording)) {
    result.failures.push_back(c.name + ": skipped, " + recording.string() + " is not there");
    return result;
  }
  std::fprintf(stderr, "%s\n", c.name.c_str());
  result.scores.push_back(scored_apart([&] { return test::score_tum(recording); },
                                       options.folder / (c.name + ".json")));
  return result;
}

}  // namespace

int run_table(int argc, char** argv) {
  Options options;
  CLI::App cli("The hard cases of SLAM, measured");
  cli.add_option("cases", options.cases, "names of cases; all of them when none is given");
  cli.add_option("--folder", options.folder, "where truth and results are kept");
  cli.add_flag("--quick", options.quick, "the short drives of the quick tests");
  cli.add_flag("--keep", options.keep, "keep the recordings");
  cli.add_flag("--list", options.list, "print the cases' names");
  std::string recording, truth, scenario = "default";
  auto* judged = cli.add_option("--recording", recording, "judge this recording, no case");
  cli.add_option("--truth", truth, "its truth, a folder")->needs(judged);
  cli.add_option("--scenario", scenario, "its scenario: when the camera was blind")->needs(judged);
  CLI11_PARSE(cli, argc, argv);
  if (!recording.empty()) {
    const SlamScore score = test::score_drive({recording, truth, app::open_scenario(scenario)});
    std::printf("%s\n", to_json(score).dump(2).c_str());
    return 0;
  }
  std::vector<const test::SlamCase*> chosen;
  for (const auto& name : options.cases) chosen.push_back(&test::slam_case(name));
  if (options.cases.empty()) {
    for (const auto& c : test::slam_cases()) chosen.push_back(&c);
  }
  if (options.list) {
    for (const auto* c : chosen) std::printf("%s\n", c->name.c_str());
    return 0;
  }
  fs::create_directories(options.folder);
  std::vector<CaseResult> results;
  for (const auto* c : chosen) results.push_back(run_case(*c, options));
  std::printf("\n%s\n%s\n", overview(results).c_str(), verdicts(results).c_str());
  return 0;
}

}  // namespace rovigo::slam_table

int main(int argc, char** argv) {
  try {
    return rovigo::slam_table::run_table(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "slam_table: %s\n", e.what());
    return 2;
  }
}
