// Measures localisation in saved maps: random starts, kidnaps, black-outs, and the calibration of
// the confidence. Recordings and maps are made by the simulator and kept in a folder; the truth is
// used for scoring only.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>

#include "recordings.h"
#include "score.h"

namespace rovigo::slam_localize {

namespace {

constexpr double kTurnS = 7.5;         // two and a half after the time allowed
constexpr double kRightWithinS = 5.0;  // issue 3
constexpr double kKidnapAtS = 5.0, kKidnapRunS = 12.0;
constexpr double kBlindBeforeS = 0.3, kBlindS = 1.0;  // every other kidnap: carried in a bag
constexpr std::size_t kBlackoutWaypoints = 5;         // of the mapping tour, driven again
constexpr double kBlackoutS = 3.0;
constexpr double kBlackouts[] = {8.0, 15.0};

struct Options {
  std::filesystem::path folder = "runs/localize";
  std::vector<std::string> worlds{"lab", "random:11", "random:12", "random:13", "random:14"};
  int starts = 60;
  int first = 1;
  int kidnaps = 0;
  bool blackouts = false;
  bool remap = false;
  bool record_only = false;
  bool trace = false;
  std::filesystem::path dump;
  double reach_m = 1.0;
  std::vector<std::string> set;
};

std::string folder_name(std::string world) {
  std::replace(world.begin(), world.end(), ':', '_');
  std::replace(world.begin(), world.end(), '/', '_');
  return world;
}

std::string number(const std::optional<double>& value) {
  if (!value) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", *value);
  return text;
}

std::optional<double> quantile(std::vector<double> values, double q) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1,
                         static_cast<std::size_t>(q * static_cast<double>(values.size())))];
}

void print_trace(const Run& run) {
  for (const Answer& a : run.answers) {
    if (!a.is_frame && !a.confidently_wrong()) continue;
    std::printf("    %7.3f %c %-8s confidence %.3f sigma %.3f error %.3f m %.3f rad%s\n", a.time_s,
                a.is_frame ? 'F' : ' ', to_string(a.health), a.confidence, a.sigma_position_m,
                a.error_m, a.error_rad, a.confidently_wrong() ? "  CONFIDENTLY WRONG" : "");
    if (!a.is_frame || !a.evidence) continue;
    const slam::LocalizerEvidence& e = *a.evidence;
    std::printf(
        "            inliers %d matched %.2f depth %.2f scan %.2f surface %.2f (margin %.2f, %d "
        "points) frames %d "
        "recognised %.2f rival %.2f\n",
        e.inliers, e.matched_share, e.depth_share, e.scan_share, e.surface_share, e.shape_margin,
        e.scan_points, e.agreeing_frames, e.recognitions, e.rival_share);
  }
}

/// One line a camera frame with a believed place: right or not, the chance that dead reckoning
/// alone leaves, and the inputs of the confidence. fit_confidence.py reads it.
void dump(const std::vector<Run>& runs, const std::filesystem::path& file) {
  std::ofstream out(file);
  for (const Run& run : runs) {
    for (const Answer& a : run.answers) {
      // A frame in doubt counts for less than its evidence says: that share is not fitted here.
      const bool in_doubt = a.evidence && a.confidence < slam::confidence_of(*a.evidence) - 1e-9;
      if (!a.is_frame || !a.evidence || in_doubt) continue;
      out << a.right() << ','
          << slam::chance_within_limits(a.evidence->sigma_position_m,
                                        a.evidence->sigma_heading_rad);
      for (const double x : slam::confidence_features(*a.evidence)) out << ',' << x;
      out << '\n';
    }
  }
}

class Bench {
 public:
  Bench(const Options& options, const app::RovigoConfig& config)
      : options_(options), config_(config) {}

  void starts(const MappedWorld& world);
  void kidnaps(const MappedWorld& world);
  void blackouts(const MappedWorld& world);
  void report() const;
  const std::vector<Run>& runs() const { return runs_; }

 private:
  std::optional<Run> run(const MappedWorld& world, const std::filesystem::path& recording);
  void fail(const std::string& what) { failures_.push_back(what); }

  const Options& options_;
  const app::RovigoConfig& config_;
  std::vector<Run> runs_;
  std::vector<std::string> rows_, kidnap_rows_, blackout_rows_, failures_;
  int starts_ = 0, in_time_ = 0;
};

std::optional<Run> Bench::run(const MappedWorld& world, const std::filesystem::path& recording) {
  if (options_.record_only) return std::nullopt;
  Run run = localize(world, config_, recording);
  if (options_.trace) print_trace(run);
  runs_.push_back(run);
  return run;
}

void Bench::starts(const MappedWorld& world) {
  int in_time = 0, never = 0, wrong_frames = 0, wrong_poses = 0, judged = 0;
  double cpu = 0.0;
  std::vector<double> times;
  for (int i = options_.first; i < options_.first + options_.starts; ++i) {
    const auto seed = static_cast<std::uint64_t>(i);
    const TPose2D pose = random_start(world, config_, options_.reach_m, 1000 + seed);
    const auto recording = world.folder / ("start_" + std::to_string(i) + ".rawlog");
    if (!is_made(recording)) {
      record_turn(world.world, world.name, pose, i % 2 ? kTurnRateRadS : -kTurnRateRadS, kTurnS,
                  sim::Scenario{}, seed, config_, recording);
    }
    const auto result = run(world, recording);
    if (!result) continue;
    ++judged;
    const auto first = result->first_right_s();
    if (first) times.push_back(*first);
    never += !first;
    const bool soon = first && *first <= kRightWithinS;
    in_time += soon;
    wrong_frames += result->confidently_wrong_frames();
    wrong_poses += result->confidently_wrong_poses();
    cpu += result->cpu_ms_per_frame;
    if (soon && result->confidently_wrong_poses() == 0) continue;
    char text[240];
    std::snprintf(text, sizeof text,
                  "%s start %d at (%.2f, %.2f, %.2f): right after %s s, %d confidently wrong "
                  "poses; alone: --worlds %s --first %d --starts 1 --trace",
                  world.name.c_str(), i, pose.x, pose.y, pose.phi, number(first).c_str(),
                  result->confidently_wrong_poses(), world.name.c_str(), i);
    fail(text);
  }
  if (judged == 0) return;
  starts_ += judged;
  in_time_ += in_time;
  char text[240];
  std::snprintf(text, sizeof text, "| %s | %d | %.1f%% | %s | %s | %d | %d (%d) | %.1f |",
                world.name.c_str(), judged, 100.0 * in_time / judged,
                number(quantile(times, 0.5)).c_str(), number(quantile(times, 0.9)).c_str(), never,
                wrong_frames, wrong_poses, cpu / judged);
  rows_.push_back(text);
}

void Bench::kidnaps(const MappedWorld& world) {
  int made = 0, lost_in_time = 0, back_in_time = 0, wrong = 0;
  std::vector<double> lost_times, back_times;
  for (int i = options_.first; i < options_.first + options_.kidnaps; ++i) {
    const auto seed = static_cast<std::uint64_t>(i);
    const TPose2D pose = random_start(world, config_, 0.3, 5000 + seed);
    TPose2D then = pose;
    then.phi = maps::wrap_angle(pose.phi + kTurnRateRadS * kKidnapAtS);
    const auto kidnap = random_kidnap(world, config_, then, kKidnapAtS, 5000 + seed);
    if (!kidnap) continue;
    sim::Scenario scenario;
    scenario.kidnaps.push_back(*kidnap);
    double resumes_s = kKidnapAtS;
    if (i % 2 == 0) {
      scenario.blackouts.push_back({kKidnapAtS - kBlindBeforeS, kBlindS, "missing"});
      resumes_s = kKidnapAtS - kBlindBeforeS + kBlindS;
    }
    const auto recording = world.folder / ("kidnap_" + std::to_string(i) + ".rawlog");
    if (!is_made(recording)) {
      record_turn(world.world, world.name, pose, kTurnRateRadS, kKidnapRunS, scenario, seed,
                  config_, recording);
    }
    const auto result = run(world, recording);
    if (!result) continue;
    ++made;
    const int wrong_poses = result->confidently_wrong_poses_but_until_the_frame_after(kKidnapAtS);
    const auto before = result->first_right_s();
    const auto lost = result->first_s(slam::Health::kLost, kKidnapAtS);
    const auto back = result->first_right_s(resumes_s);
    const bool was_found = before && *before < kKidnapAtS;
    const bool in_lost =
        !was_found || (lost && *lost <= resumes_s + 1.0) || (back && *back <= resumes_s + 1.0);
    const bool in_back = back && *back <= resumes_s + 3.0;
    lost_in_time += in_lost;
    back_in_time += in_back;
    if (was_found && lost) lost_times.push_back(*lost - resumes_s);
    if (back) back_times.push_back(*back - resumes_s);
    wrong += wrong_poses;
    if (in_lost && in_back && wrong_poses == 0) continue;
    char text[300];
    std::snprintf(
        text, sizeof text,
        "%s kidnap %d from (%.2f, %.2f, %.2f), resumes at %.2f s: LOST after %s s, right "
        "after %s s, %d confidently wrong poses; alone: --worlds %s --starts 0 --first %d "
        "--kidnaps 1 --trace",
        world.name.c_str(), i, then.x, then.y, then.phi, resumes_s,
        lost ? number(*lost - resumes_s).c_str() : "-",
        back ? number(*back - resumes_s).c_str() : "-", wrong_poses, world.name.c_str(), i);
    fail(text);
  }
  if (made == 0) return;
  char text[240];
  std::snprintf(text, sizeof text, "| %s | %d | %d | %s | %d | %s | %s | %d |", world.name.c_str(),
                made, lost_in_time, number(quantile(lost_times, 1.0)).c_str(), back_in_time,
                number(quantile(back_times, 0.5)).c_str(),
                number(quantile(back_times, 1.0)).c_str(), wrong);
  kidnap_rows_.push_back(text);
}

void Bench::blackouts(const MappedWorld& world) {
  for (const std::string kind : {"missing", "covered"}) {
    const auto recording = world.folder / ("blackouts_" + kind + ".rawlog");
    if (!is_made(recording)) {
      sim::Route route = mapping_route(world.name, world.world, config_);
      route.turns.clear();
      route.waypoints.resize(std::min(route.waypoints.size(), kBlackoutWaypoints));
      sim::Scenario scenario;
      for (const double start : kBlackouts) scenario.blackouts.push_back({start, kBlackoutS, kind});
      record_drive(world.world, world.name, route, scenario, 2, config_, recording);
    }
    const auto result = run(world, recording);
    if (!result) continue;
    std::string row = "| " + world.name + ", " + kind + " |";
    for (const double start : kBlackouts) {
      std::optional<double> doubtful, back;
      double sigma_before = 0.0, sigma_grown = 0.0;
      for (const Answer& a : result->answers) {
        if (a.time_s <= start) sigma_before = a.sigma_position_m;
        if (a.time_s > start && a.time_s < start + kBlackoutS) sigma_grown = a.sigma_position_m;
        if (a.time_s > start && !a.ok() && !doubtful) doubtful = a.time_s - start;
        if (a.time_s > start + kBlackoutS && a.ok() && !back) back = a.time_s - start - kBlackoutS;
      }
      row += " " + number(doubtful) + " | " + number(back) + " | ";
      char text[64];
      std::snprintf(text, sizeof text, "%.3f to %.3f |", sigma_before, sigma_grown);
      row += text;
      if (!doubtful || *doubtful > 0.5 || !back || *back > 2.0) {
        fail(world.name + " black-outs " + kind + " at " + number(start) + " s: DEGRADED after " +
             number(doubtful) + " s, OK " + number(back) + " s after the return");
      }
    }
    row += " " + std::to_string(result->confidently_wrong_poses()) + " |";
    if (result->confidently_wrong_poses() > 0) {
      fail(world.name + " black-outs " + kind + ": confidently wrong");
    }
    blackout_rows_.push_back(row);
  }
}

void print_rows(const char* head, const std::vector<std::string>& rows) {
  if (rows.empty()) return;
  std::printf("\n%s\n", head);
  for (const std::string& row : rows) std::printf("%s\n", row.c_str());
}

void Bench::report() const {
  print_rows(
      "| world | starts | right within 5 s | median s | 90% s | never | confidently wrong frames "
      "(poses) | CPU ms/frame |\n|---|---|---|---|---|---|---|---|",
      rows_);
  if (starts_ > 0) {
    std::printf("\n%d of %d starts (%.1f%%) right within %.0f s\n", in_time_, starts_,
                100.0 * in_time_ / starts_, kRightWithinS);
  }
  print_rows(
      "| world | kidnaps | LOST or right within 1 s | worst LOST s | right within 3 s | median s | "
      "worst s | confidently wrong poses |\n|---|---|---|---|---|---|---|---|",
      kidnap_rows_);
  print_rows(
      "| black-outs of 3 s | not OK after s | OK after s | sigma m | not OK after s | OK after s | "
      "sigma m | confidently wrong poses |\n|---|---|---|---|---|---|---|---|",
      blackout_rows_);
  const auto bins = calibration_curve(runs_);
  std::printf("\n| said confidence | frames | mean said | share right |\n|---|---|---|---|\n");
  for (const CalibrationBin& b : bins) {
    if (b.frames == 0) continue;
    std::printf("| %.2f - %.2f | %d | %.3f | %.3f |\n", b.from, b.to, b.frames, b.mean_confidence,
                b.share_right);
  }
  std::printf("\nmean |said - true|: %.4f\n", calibration_error(bins));
  for (const std::string& f : failures_) std::printf("FAILED %s\n", f.c_str());
}

}  // namespace

int run_all(int argc, char** argv) {
  Options options;
  CLI::App cli("Localisation in saved maps, measured");
  cli.add_option("folder", options.folder, "where recordings and maps are kept");
  cli.add_option("--worlds", options.worlds, "lab, random:SEED, ...")->delimiter(',');
  cli.add_option("--starts", options.starts, "random starts a world");
  cli.add_option("--first", options.first, "number of the first start or kidnap");
  cli.add_option("--kidnaps", options.kidnaps, "kidnaps a world");
  cli.add_flag("--blackouts", options.blackouts, "drives with two black-outs");
  cli.add_option("--reach", options.reach_m, "starts lie within this of the mapping tour, metres");
  cli.add_flag("--remap", options.remap, "make the maps again from the kept tours");
  cli.add_flag("--record-only", options.record_only, "make recordings, localise nothing");
  cli.add_flag("--trace", options.trace, "print every frame");
  cli.add_option("--dump", options.dump, "CSV of the evidence, for fit_confidence.py");
  cli.add_option("--set", options.set, "a setting, as on every command");
  CLI11_PARSE(cli, argc, argv);
  const app::RovigoConfig config = app::load_config(std::nullopt, options.set);
  Bench bench(options, config);
  for (const std::string& name : options.worlds) {
    const MappedWorld world =
        open_mapped_world(name, options.folder / folder_name(name), config, options.remap);
    bench.starts(world);
    bench.kidnaps(world);
    if (options.blackouts) bench.blackouts(world);
  }
  bench.report();
  if (!options.dump.empty()) dump(bench.runs(), options.dump);
  return 0;
}

}  // namespace rovigo::slam_localize

int main(int argc, char** argv) {
  try {
    return rovigo::slam_localize::run_all(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "slam_localize: %s\n", e.what());
    return 2;
  }
}
