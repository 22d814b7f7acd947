// rovigo identify: first-order models from logged set-points and responses.

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "app/commands/options.h"
#include "app/config.h"
#include "app/console.h"
#include "app/report/number_text.h"
#include "app/report/page_parts.h"
#include "app/report/svg_plot.h"
#include "app/resources.h"
#include "app/signal_log.h"
#include "maps/atomic_file.h"

namespace rovigo::app {

namespace {

using control::ConfidenceInterval;
using control::IdentificationResult;
using control::IdentificationStatus;

constexpr std::size_t kMostPlotPoints = 3000;

bool is_ok(const IdentificationResult& r) { return r.status == IdentificationStatus::kOk; }

std::string percent(double share) { return fixed(100.0 * share, 1) + " %"; }

/// What is wrong with the log, and the way out.
std::string refusal(const SignalLog& log, const IdentificationResult& r) {
  switch (r.status) {
    case IdentificationStatus::kTooFewSamples:
      return std::to_string(r.samples) + " measured responses are too few; 20 are the least";
    case IdentificationStatus::kNoExcitation:
      return log.setpoint_column + " never changes, so the log says nothing about how " +
             log.response_column + " follows; log a drive with changes of it";
    case IdentificationStatus::kNoResponse:
      return log.response_column + " does not follow " + log.setpoint_column +
             "; are these the right columns?";
    case IdentificationStatus::kVague:
      return log.response_column + " follows, but the log does not tell how fast; log steps of " +
             log.setpoint_column + ", or for longer";
    case IdentificationStatus::kNotFirstOrder:
      return log.response_column + " is not what a first-order model of " + log.setpoint_column +
             " describes (fit " + percent(r.fit_share) +
             "): it swings, or something else moves it as well, such as wheels that slip";
    case IdentificationStatus::kOk:
      break;
  }
  return "";
}

nlohmann::ordered_json interval_json(const ConfidenceInterval& i) { return {i.low, i.high}; }

nlohmann::ordered_json model_json(const SignalLog& log, const IdentificationResult& r) {
  nlohmann::ordered_json object{{"name", log.name},
                                {"setpoint", log.setpoint_column},
                                {"response", log.response_column},
                                {"status", to_string(r.status)},
                                {"message", refusal(log, r)},
                                {"samples", r.samples}};
  if (!is_ok(r)) return object;
  object.update(nlohmann::ordered_json{{"gain", r.model.gain},
                                       {"gain_95", interval_json(r.gain_95)},
                                       {"time_constant_s", r.model.time_constant_s},
                                       {"time_constant_95_s", interval_json(r.time_constant_95_s)},
                                       {"dead_time_s", r.model.dead_time_s},
                                       {"dead_time_95_s", interval_json(r.dead_time_95_s)},
                                       {"fit_share", r.fit_share},
                                       {"residual_rms", r.residual_rms},
                                       {"validation_fit_share", nullptr}});
  if (std::isfinite(r.validation_fit_share)) {
    object["validation_fit_share"] = r.validation_fit_share;
  }
  return object;
}

std::string with_interval(double value, const ConfidenceInterval& i, const std::string& unit) {
  return with_unit(value, 4, unit) + "  (95 %: " + fixed(std::max(i.low, -1e6), 4) + " to " +
         fixed(std::min(i.high, 1e6), 4) + ")";
}

std::vector<Row> model_rows(const SignalLog& log, const IdentificationResult& r) {
  if (!is_ok(r)) return {{log.name, refusal(log, r)}};
  std::string fit = percent(r.fit_share) + " of the response";
  if (std::isfinite(r.validation_fit_share)) {
    fit += "; " + percent(r.validation_fit_share) + " of the second half by a model of the first";
  }
  std::vector<Row> rows{
      {log.name, std::to_string(r.samples) + " samples, residual " +
                     with_unit(r.residual_rms, 4, log.unit) + " RMS"},
      {"  gain", with_interval(r.model.gain, r.gain_95, "")},
      {"  time constant", with_interval(r.model.time_constant_s, r.time_constant_95_s, "s")},
      {"  dead time", with_interval(r.model.dead_time_s, r.dead_time_95_s, "s")},
      {"  fit", fit}};
  if (log.setpoint_column == "command_v_m_s") {
    rows.emplace_back(
        "  as settings",
        "--set control.drive_lag_s=" + fixed(std::min(r.model.time_constant_s, 1.0), 3) +
            " --set control.command_delay_s=" + fixed(std::min(r.model.dead_time_s, 0.5), 3));
  }
  return rows;
}

/// Every so many rows only: a page must stay small.
PlotSeries series(const SignalLog& log, const std::string& name, int color,
                  const std::vector<double>& values) {
  PlotSeries out;
  out.name = name;
  out.color = color;
  const std::size_t stride = (log.samples.size() + kMostPlotPoints - 1) / kMostPlotPoints;
  for (std::size_t i = 0; i < log.samples.size(); i += stride) {
    out.x.push_back(log.samples[i].time_s - log.samples.front().time_s);
    out.y.push_back(values[i]);
  }
  return out;
}

Plot plot_of(const SignalLog& log, const IdentificationResult& r) {
  std::vector<double> setpoints, responses;
  for (const auto& s : log.samples) {
    setpoints.push_back(s.setpoint);
    responses.push_back(s.response);
  }
  Plot plot;
  plot.title = log.name;
  plot.x_label = "time (s)";
  plot.y_label = log.unit.empty() ? log.response_column : log.unit;
  plot.width_px = 960;
  plot.series = {series(log, "set-point", 3, setpoints), series(log, "response", 1, responses)};
  if (is_ok(r)) {
    plot.series.push_back(
        series(log, "model", 0, control::simulate(r.model, log.samples, r.initial_response)));
    plot.series.back().dashed = true;
  }
  return plot;
}

std::string page_of(const std::string& title, const std::vector<SignalLog>& logs,
                    const std::vector<IdentificationResult>& results) {
  const bool good = std::any_of(results.begin(), results.end(), is_ok);
  std::string page = page_begin(title) + page_title(title, good, good ? "identified" : "refused");
  for (std::size_t i = 0; i < logs.size(); ++i) {
    page += "<h2>" + escaped(logs[i].name) + "</h2>\n";
    if (is_ok(results[i])) {
      page += "<table>";
      for (const auto& [label, value] : model_rows(logs[i], results[i])) {
        page += page_cells({label == logs[i].name ? "log" : label, value});
      }
      page += "</table>\n";
    } else {
      page += "<p class=\"summary\">" + escaped(refusal(logs[i], results[i])) + "</p>\n";
    }
    page += plot_svg(plot_of(logs[i], results[i]));
  }
  return page + "</main></body></html>\n";
}

}  // namespace

int run_identify(const IdentifyOptions& options) {
  const Console console(options.json);
  load_config(options.config, options.set);  // nothing of it is used, but mistakes in it are told
  if (options.report) require_writable(*options.report);
  const std::vector<SignalLog> logs =
      read_signal_logs(options.log, {options.setpoint, options.response});
  std::vector<IdentificationResult> results;
  for (const auto& log : logs) results.push_back(control::identify_first_order(log.samples));

  const auto found = static_cast<std::size_t>(std::count_if(results.begin(), results.end(), is_ok));
  std::vector<Row> rows;
  nlohmann::ordered_json models = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < logs.size(); ++i) {
    models.push_back(model_json(logs[i], results[i]));
    for (auto& row : model_rows(logs[i], results[i])) rows.push_back(std::move(row));
  }
  const std::string message = std::to_string(found) + " of " + std::to_string(logs.size()) +
                              (logs.size() == 1 ? " signal" : " signals") + " identified";
  if (options.report) {
    maps::write_file_atomically(
        *options.report,
        std::string_view(
            page_of("Identification of " + options.log.filename().string(), logs, results)));
    console.say("report: " + options.report->string());
  }
  console.result({{"status", found > 0 ? "ok" : to_string(results.front().status)},
                  {"code", found > 0 ? 0 : 1},
                  {"message", message},
                  {"models", models}},
                 message, rows);
  return found > 0 ? kDone : kDidNotSucceed;
}

}  // namespace rovigo::app
