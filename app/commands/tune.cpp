// rovigo tune: controller gains by a relay experiment or by optimisation on a tracking suite.

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "app/commands/options.h"
#include "app/console.h"
#include "app/parallel.h"
#include "app/report/number_text.h"
#include "app/resources.h"
#include "app/tuning.h"
#include "maps/atomic_file.h"
#include "maps/error.h"

namespace rovigo::app {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t kUnseenSeedOffset = 1000;
constexpr double kWidestSearch = 10.0;  // times the start, up and down

/// What was found, and what it is worth.
struct Tuning {
  control::ControlConfig control;
  SuiteScore before, after;
  SuiteScore unseen_before, unseen_after;  ///< same runs, other seeds
  int evaluations = 0;
  Json details;  ///< of the method
  std::vector<Row> rows;
};

std::vector<TrackCase> tunable_cases(const TrackSuite& suite, const std::string& file) {
  std::vector<TrackCase> cases = cases_of(suite);
  std::erase_if(cases, [](const TrackCase& c) { return c.controller != "default"; });
  if (cases.empty()) {
    throw maps::InputError(file +
                           ": no group uses the controller `default`, which is what is tuned");
  }
  return cases;
}

std::vector<TrackCase> with_other_seeds(std::vector<TrackCase> cases) {
  for (TrackCase& c : cases) c.seed += kUnseenSeedOffset;
  return cases;
}

Json relay_json(const control::RelayResult& r) {
  Json object{{"status", r.status == control::RelayStatus::kOk ? "ok" : "no_even_oscillation"},
              {"ultimate_gain_1_s", r.ultimate_gain},
              {"ultimate_period_s", r.ultimate_period_s}};
  const std::pair<const char*, control::ZieglerNicholsRow> table[] = {
      {"p", control::ZieglerNicholsRow::kP},
      {"pi", control::ZieglerNicholsRow::kPi},
      {"pid", control::ZieglerNicholsRow::kPid}};
  if (r.status != control::RelayStatus::kOk) return object;
  for (const auto& [name, row] : table) {
    const auto g = control::ziegler_nichols(row, r.ultimate_gain, r.ultimate_period_s);
    object[name] = {{"kp", g.kp}, {"ki", g.ki}, {"kd", g.kd}};
  }
  return object;
}

Row relay_row(const std::string& loop, const control::RelayResult& r) {
  if (r.status != control::RelayStatus::kOk) return {loop, "does not oscillate evenly"};
  std::string text = "oscillates at gain " + fixed(r.ultimate_gain, 2) + " 1/s with period " +
                     fixed(r.ultimate_period_s, 3) + " s; table:";
  const std::pair<const char*, control::ZieglerNicholsRow> table[] = {
      {"P", control::ZieglerNicholsRow::kP},
      {"PI", control::ZieglerNicholsRow::kPi},
      {"PID", control::ZieglerNicholsRow::kPid}};
  for (const auto& [name, row] : table) {
    const auto g = control::ziegler_nichols(row, r.ultimate_gain, r.ultimate_period_s);
    text += std::string(" ") + name + " " + fixed(g.kp, 2);
    if (g.ki > 0.0) text += ", " + fixed(g.ki, 2);
    if (g.kd > 0.0) text += ", " + fixed(g.kd, 3);
    text += name == std::string("PID") ? "" : ";";
  }
  return {loop, text};
}

/// Relay experiments and the thesis's table; nothing when a loop does not oscillate.
bool tune_by_relay(const TuneOptions& options, const RovigoConfig& config, Tuning& tuning) {
  const RelayTuning relay = relay_on_rover(config, open_scenario(options.scenario));
  tuning.details = {{"heading", relay_json(relay.heading)}, {"speed", relay_json(relay.speed)}};
  tuning.rows = {relay_row("heading loop", relay.heading), relay_row("speed loop", relay.speed)};
  if (!relay.ok()) return false;
  tuning.control = with_ziegler_nichols(config.control, relay);
  for (const TunedSetting& s : tuned_settings(tuning.control)) {
    if (s.value < s.max) continue;
    tuning.rows.emplace_back(
        "at its limit", "control." + s.name + ", which may be " + Json(s.max).dump() + " at most");
  }
  return true;
}

void tune_by_search(const TuneOptions& options, const RovigoConfig& config, const TrackBench& bench,
                    const std::vector<TrackCase>& cases, unsigned threads, Tuning& tuning) {
  std::vector<control::SearchParameter> parameters;
  for (const TunedSetting& s : tuned_settings(config.control)) {
    const double start = std::clamp(s.value, s.min, s.max);
    parameters.push_back(
        {start, std::max(s.min, start / kWidestSearch), std::min(s.max, start * kWidestSearch)});
  }
  control::PatternSearchConfig search;
  search.max_evaluations = options.evaluations;
  search.seed = options.seed;
  Progress progress("tuning");
  double done = 0.0;
  const auto costs = [&](const std::vector<std::vector<double>>& points) {
    std::vector<control::ControlConfig> settings;
    for (const auto& p : points) settings.push_back(with_settings(config.control, p));
    const auto batch = static_cast<double>(points.size());
    std::vector<double> out;
    for (const SuiteScore& s : score_settings(bench, cases, settings, threads, [&](double share) {
           progress.update((done + share * batch) / options.evaluations);
         })) {
      out.push_back(s.cost_mm);
    }
    done += batch;
    return out;
  };
  const control::PatternSearchResult found = control::pattern_search(parameters, costs, search);
  progress.update(1.0);
  tuning.control = with_settings(config.control, found.best);
  tuning.evaluations = found.evaluations;
  tuning.details = {{"evaluations", found.evaluations}, {"converged", found.converged}};
  tuning.rows = {
      {"search", std::to_string(found.evaluations) + " settings tried on " +
                     std::to_string(cases.size()) + " runs each; " +
                     (found.converged ? "no better ones near by" : "stopped at --evaluations")}};
}

Json score_json(const SuiteScore& s) {
  return {{"cost_mm", s.cost_mm},
          {"cross_track_rms_m", s.cross_track_rms_m},
          {"along_track_rms_m", s.along_track_rms_m},
          {"final_position_error_m", s.final_position_error_m},
          {"jerk_rms_m_s3", s.jerk_rms_m_s3},
          {"runs", s.runs},
          {"failed", s.failed}};
}

std::string score_text(const SuiteScore& a, const SuiteScore& b) {
  const auto mm = [](double metres) { return fixed(1000.0 * metres, 1); };
  return "cost " + fixed(a.cost_mm, 2) + " -> " + fixed(b.cost_mm, 2) + "; cross-track " +
         mm(a.cross_track_rms_m) + " -> " + mm(b.cross_track_rms_m) + " mm, along " +
         mm(a.along_track_rms_m) + " -> " + mm(b.along_track_rms_m) + " mm, goal " +
         mm(a.final_position_error_m) + " -> " + mm(b.final_position_error_m) + " mm, jerk " +
         fixed(a.jerk_rms_m_s3, 2) + " -> " + fixed(b.jerk_rms_m_s3, 2) + " m/s3, failed " +
         std::to_string(a.failed) + " -> " + std::to_string(b.failed) + " of " +
         std::to_string(a.runs);
}

/// A config file that `--config` reads.
std::string fragment(const control::ControlConfig& control, const std::string& command) {
  std::string out = "# Found by `" + command + "`.\ncontrol:\n";
  for (const TunedSetting& s : tuned_settings(control)) {
    out += "  " + s.name + ": " + Json(s.value).dump() + "\n";
  }
  return out;
}

Json settings_json(const control::ControlConfig& control) {
  Json out = Json::object();
  for (const TunedSetting& s : tuned_settings(control)) out["control." + s.name] = s.value;
  return out;
}

std::vector<Row> settings_rows(const control::ControlConfig& before,
                               const control::ControlConfig& after) {
  std::vector<Row> rows;
  const auto old = tuned_settings(before), now = tuned_settings(after);
  for (std::size_t i = 0; i < now.size(); ++i) {
    rows.emplace_back("control." + now[i].name,
                      Json(old[i].value).dump() + " -> " + Json(now[i].value).dump());
  }
  return rows;
}

/// Before and after, on the suite's seeds and on seeds that nothing was tuned on.
void measure(const TrackBench& bench, const std::vector<TrackCase>& cases,
             const control::ControlConfig& before, unsigned threads, Tuning& tuning) {
  Progress progress("measuring");
  const std::vector<control::ControlConfig> both{before, tuning.control};
  const auto seen = score_settings(bench, cases, both, threads,
                                   [&](double share) { progress.update(share / 2.0); });
  const auto unseen = score_settings(bench, with_other_seeds(cases), both, threads,
                                     [&](double share) { progress.update((1.0 + share) / 2.0); });
  tuning.before = seen[0];
  tuning.after = seen[1];
  tuning.unseen_before = unseen[0];
  tuning.unseen_after = unseen[1];
}

std::string verdict(const Tuning& t) {
  const bool better = t.after.cost_mm < t.before.cost_mm;
  const bool better_unseen = t.unseen_after.cost_mm < t.unseen_before.cost_mm;
  if (better && better_unseen) return "better gains found, also on seeds they were not tuned on";
  if (better) return "better on the suite, but not on other seeds: keep the old gains";
  if (t.after.cost_mm == t.before.cost_mm) return "nothing better found: the gains stay";
  return "these gains drive worse than the ones there were: a start for finer tuning, no more";
}

}  // namespace

int run_tune(const TuneOptions& options) {
  const Console console(options.json);
  const RovigoConfig config = load_config(options.config, options.set);
  if (options.out) require_writable(*options.out);
  const std::filesystem::path file = find_suite(options.suite);
  const TrackBench bench(load_suite(file), config, options.pose);
  const std::vector<TrackCase> cases = tunable_cases(bench.suite(), file.string());
  const unsigned threads = options.threads.value_or(machine_threads());

  Tuning tuning;
  if (options.method == "relay") {
    if (!tune_by_relay(options, config, tuning)) {
      console.result({{"status", "no_oscillation"},
                      {"code", 1},
                      {"message", "a loop does not oscillate evenly under the relay"},
                      {"relay", tuning.details}},
                     "a loop does not oscillate evenly under the relay; no gains", tuning.rows);
      return kDidNotSucceed;
    }
  } else {
    tune_by_search(options, config, bench, cases, threads, tuning);
  }
  measure(bench, cases, config.control, threads, tuning);

  const std::string text =
      fragment(tuning.control, "rovigo tune " + options.suite + " --method " + options.method);
  if (options.out) maps::write_file_atomically(*options.out, std::string_view(text));
  std::vector<Row> rows = std::move(tuning.rows);
  for (auto& row : settings_rows(config.control, tuning.control)) rows.push_back(std::move(row));
  rows.emplace_back("on the suite", score_text(tuning.before, tuning.after));
  rows.emplace_back("on other seeds", score_text(tuning.unseen_before, tuning.unseen_after));
  if (options.out) rows.emplace_back("written", options.out->string() + " (use: --config)");
  const std::string message = verdict(tuning);
  console.result(
      {{"status", "ok"},
       {"code", 0},
       {"message", message},
       {"method", options.method},
       {"settings", settings_json(tuning.control)},
       {"before", score_json(tuning.before)},
       {"after", score_json(tuning.after)},
       {"other_seeds",
        {{"before", score_json(tuning.unseen_before)}, {"after", score_json(tuning.unseen_after)}}},
       {options.method == "relay" ? "relay" : "search", tuning.details}},
      message, rows);
  if (!options.out) console.say("\n" + text);
  return kDone;
}

}  // namespace rovigo::app
