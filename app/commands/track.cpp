// rovigo track: the repeatable trajectory-tracking tests.

#include "app/commands/options.h"
#include "app/parallel.h"
#include "app/report/track_report.h"
#include "app/resources.h"
#include "app/simulated_drive.h"
#include "app/track/track_result.h"
#include "app/track/track_run.h"
#include "app/track/version_comparison.h"
#include "maps/atomic_file.h"
#include "maps/error.h"

namespace rovigo::app {

namespace {

constexpr std::size_t kMaxSuiteBytes = std::size_t{1} << 20U;

/// Shards belong together only when suite, settings and pose source are the same.
std::string suite_hash(const std::filesystem::path& file, const RovigoConfig& config,
                       const std::optional<std::string>& pose) {
  std::string text = maps::read_file(file, kMaxSuiteBytes) + "\npose " + pose.value_or("") + "\n";
  for (const SettingRow& row : list_settings(config)) text += row.key + " " + row.value + "\n";
  return sha256(text);
}

/// Drives and judges; with a report, keeps what it draws.
TrackPageInput drive_suite(const TrackOptions& options) {
  const RovigoConfig config = load_config(options.config, options.set);
  const std::filesystem::path file = find_suite(options.suite);
  const TrackBench bench(load_suite(file), config, options.pose);
  TrackPageInput out;
  TrackResult& result = out.result;
  result.suite = bench.suite().name;
  result.suite_hash = suite_hash(file, config, options.pose);
  if (options.shard) result.shard = parse_shard(*options.shard);

  const std::vector<TrackCase> all = cases_of(bench.suite());
  result.total_runs = all.size();
  std::vector<TrackCase> mine;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!result.shard || result.shard->holds(i)) mine.push_back(all[i]);
  }
  result.runs.resize(mine.size());
  if (options.report) out.series.resize(mine.size());
  Progress progress("tracking");
  run_parallel(
      mine.size(), options.threads.value_or(machine_threads()),
      [&](std::size_t i) {
        const TrackRun run = bench.run(mine[i]);
        result.runs[i] = run_json(run);
        if (!options.report) return;
        out.series[i] = series_of(run);
        write_trajectories(*options.report, run);
      },
      [&](double share) { progress.update(share); });
  return out;
}

TrackPageInput merge_shards(const TrackOptions& options) {
  TrackPageInput out;
  out.result = merge_results(options.merge);
  if (options.report) out.series = gather_drives(options.merge, out.result, *options.report);
  return out;
}

}  // namespace

int run_track(const TrackOptions& options) {
  const Console console(options.json);
  if (!options.merge.empty() && options.shard) {
    throw maps::InputError(
        "--shard drives a share of a suite and --merge puts shares together; "
        "give one of them");
  }
  std::optional<TrackResult> against;
  if (options.against) against = read_result(*options.against);
  if (options.report) make_track_folder(*options.report);
  TrackPageInput done = options.merge.empty() ? drive_suite(options) : merge_shards(options);
  const TrackResult& result = done.result;
  auto object = result_json(result);
  std::vector<Row> rows = result_rows(result);
  if (against) {
    const auto versions = compare_versions(result, *against);
    object["against"] = comparison_json(versions);
    for (Row& row : comparison_rows(versions, options.against->string())) rows.push_back(row);
  }
  if (options.report) {
    if (against) done.against_name = options.against->string();
    done.against = std::move(against);
    write_track_report(*options.report, done);
    console.say("report: " + (*options.report / "index.html").string());
  }
  console.result(object, result_message(result), rows);
  return failed_runs(result) == 0 ? kDone : kDidNotSucceed;
}

}  // namespace rovigo::app
