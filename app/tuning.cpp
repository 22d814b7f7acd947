#include "app/tuning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>

#include "app/console.h"
#include "app/parallel.h"
#include "app/pose_source.h"
#include "app/simulated_drive.h"
#include "app/text.h"
#include "app/track/shapes.h"
#include "sim/simulator.h"

namespace rovigo::app {

namespace {

constexpr std::array kTuned{"heading_kp_1_s", "heading_ki_1_s2", "speed_kp_1_s", "speed_ki_1_s2",
                            "cross_track_rate_1_s"};
constexpr double kLeastGain = 0.01;  // what is searched by factors cannot be zero
constexpr double kFailedRunMm = 1000.0;

constexpr double kCommandS = kStepsPerCommand * sim::Simulator::kStepS;
constexpr double kCruiseMS = 0.3;
constexpr double kSpeedRelayMS = 0.1, kTurnRelayRadS = 0.3;
constexpr double kCruiseBeforeS = 3.0;

/// Calls `visit` with each tuned setting, in the order of kTuned.
class GainVisitor final : public maps::SettingsVisitor {
 public:
  using Visit = std::function<void(std::size_t, const maps::SettingInfo&, double&)>;
  explicit GainVisitor(Visit visit) : visit_(std::move(visit)) {}
  void real(const maps::SettingInfo& info, double& value) override {
    const auto* it = std::find(kTuned.begin(), kTuned.end(), info.name);
    if (it != kTuned.end()) visit_(static_cast<std::size_t>(it - kTuned.begin()), info, value);
  }
  void integer(const maps::SettingInfo&, int&) override {}
  void flag(const maps::SettingInfo&, bool&) override {}
  void text(const maps::SettingInfo&, std::string&) override {}

 private:
  Visit visit_;
};

double four_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return parse_number(text).value_or(value);
}

/// The rover cruising in the hall, with one command left to the relay.
class Cruise {
 public:
  Cruise(const RovigoConfig& config, const sim::Scenario& scenario)
      : simulator_(empty_hall(), options_of(config, scenario)),
        poses_(perturbed_poses(simulator_, TPose2D(), scenario, 1)),
        loop_(simulator_, TPose2D(), *poses_, config, hooks_) {
    for (double t = 0.0; t < kCruiseBeforeS; t += kCommandS) advance({kCruiseMS, 0.0, 0.0});
  }

  control::PoseInput advance(const TTwist2D& command) {
    loop_.advance(command);
    return poses_->pose(simulator_.time_s());
  }

 private:
  static sim::SimulatorOptions options_of(const RovigoConfig& config,
                                          const sim::Scenario& scenario) {
    sim::SimulatorOptions options;
    options.robot = config.robot;
    options.scenario = scenario;
    options.camera_enabled = false;
    return options;
  }

  sim::Simulator simulator_;
  std::unique_ptr<PoseSource> poses_;
  DriveHooks hooks_;
  DriveLoop loop_;
};

sim::Scenario without_noise(sim::Scenario scenario) {
  scenario.pose.sigma_position_m = scenario.pose.sigma_heading_rad = 0.0;
  scenario.pose.latency_s += scenario.pose.jitter_s / 2.0;  // its mean
  scenario.pose.jitter_s = 0.0;
  scenario.wheels.slip_events_per_minute = 0.0;
  return scenario;
}

SuiteScore mean_of(const std::vector<TrackRun>& runs) {
  SuiteScore sum;
  const auto n = static_cast<double>(runs.size());
  for (const TrackRun& run : runs) {
    const control::DriveMetrics& m = run.metrics;
    sum.cross_track_rms_m += m.cross_track_rms_m / n;
    sum.along_track_rms_m += m.along_track_rms_m / n;
    sum.final_position_error_m += m.final_position_error_m / n;
    sum.jerk_rms_m_s3 += m.jerk_rms_m_s3 / n;
    sum.failed += run.failures.empty() ? 0 : 1;
  }
  sum.runs = runs.size();
  sum.cost_mm = 1000.0 * (sum.cross_track_rms_m + 0.3 * sum.along_track_rms_m +
                          0.3 * sum.final_position_error_m) +
                2.0 * sum.jerk_rms_m_s3 + kFailedRunMm * static_cast<double>(sum.failed) / n;
  return sum;
}

}  // namespace

std::vector<TunedSetting> tuned_settings(const control::ControlConfig& control) {
  control::ControlConfig copy = control;
  std::vector<TunedSetting> out(kTuned.size());
  GainVisitor visitor([&out](std::size_t i, const maps::SettingInfo& info, double& value) {
    out[i] = {info.name, value, std::max(info.min, kLeastGain), info.max};
  });
  copy.describe(visitor);
  return out;
}

control::ControlConfig with_settings(control::ControlConfig control,
                                     const std::vector<double>& values) {
  GainVisitor visitor([&values](std::size_t i, const maps::SettingInfo& info, double& value) {
    value = std::clamp(four_digits(values[i]), info.min, info.max);
  });
  control.describe(visitor);
  return control;
}

RelayTuning relay_on_rover(const RovigoConfig& config, const sim::Scenario& scenario) {
  const sim::Scenario quiet = without_noise(scenario);
  control::RelayConfig relay;
  relay.step_s = kCommandS;
  const auto heading = [&] {
    auto cruise = std::make_shared<Cruise>(config, quiet);
    const double first = cruise->advance({kCruiseMS, 0.0, 0.0}).map_from_base.phi;
    return control::Plant([cruise, first](double turn_rate) {
      const auto pose = cruise->advance({kCruiseMS, 0.0, turn_rate});
      return maps::wrap_angle(pose.map_from_base.phi - first);
    });
  };
  const auto speed = [&] {
    auto cruise = std::make_shared<Cruise>(config, quiet);
    const control::PoseInput first = cruise->advance({kCruiseMS, 0.0, 0.0});
    return control::Plant([cruise, first](double faster) {
      const control::PoseInput pose = cruise->advance({kCruiseMS + faster, 0.0, 0.0});
      const double expected = kCruiseMS * (pose.time_s - first.time_s);
      return pose.map_from_base.x - first.map_from_base.x - expected;
    });
  };
  RelayTuning out;
  relay.amplitude = kTurnRelayRadS;
  out.heading = control::relay_experiment(heading, relay);
  relay.amplitude = kSpeedRelayMS;
  out.speed = control::relay_experiment(speed, relay);
  return out;
}

control::ControlConfig with_ziegler_nichols(const control::ControlConfig& control,
                                            const RelayTuning& relay) {
  const auto gains = [](const control::RelayResult& r) {
    return control::ziegler_nichols(control::ZieglerNicholsRow::kPi, r.ultimate_gain,
                                    r.ultimate_period_s);
  };
  const control::PidGains heading = gains(relay.heading), speed = gains(relay.speed);
  return with_settings(control,
                       {heading.kp, heading.ki, speed.kp, speed.ki, control.cross_track_rate_1_s});
}

std::vector<SuiteScore> score_settings(const TrackBench& bench, const std::vector<TrackCase>& cases,
                                       const std::vector<control::ControlConfig>& settings,
                                       unsigned threads,
                                       const std::function<void(double share)>& progress) {
  std::vector<TrackBench> benches;
  std::vector<std::vector<TrackRun>> runs(settings.size(), std::vector<TrackRun>(cases.size()));
  for (const auto& control : settings) benches.push_back(bench.with_control(control));
  run_parallel(
      settings.size() * cases.size(), threads,
      [&](std::size_t i) {
        TrackRun run = benches[i / cases.size()].run(cases[i % cases.size()]);
        run.log = {};  // only the figures are needed
        runs[i / cases.size()][i % cases.size()] = std::move(run);
      },
      progress);
  std::vector<SuiteScore> scores;
  for (const auto& of_one : runs) scores.push_back(mean_of(of_one));
  return scores;
}

}  // namespace rovigo::app
