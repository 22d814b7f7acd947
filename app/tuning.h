#pragma once
// Controller gains for the simulated rover: by a relay experiment, or by what a suite measures.

#include <functional>
#include <string>
#include <vector>

#include "app/track/track_run.h"
#include "control/control_config.h"
#include "control/pattern_search.h"
#include "control/relay_experiment.h"
#include "sim/scenario.h"

namespace rovigo::app {

/// A setting of the controller that `tune` may change.
struct TunedSetting {
  std::string name;  ///< as in the section `control`
  double value = 0.0;
  double min = 0.0;
  double max = 0.0;
};
/// The gains of both loops and how fast the path is approached.
std::vector<TunedSetting> tuned_settings(const control::ControlConfig& control);
/// `control` with these values, brought within their ranges and rounded to four digits, so that a
/// file that says them in as many gives the same drives.
control::ControlConfig with_settings(control::ControlConfig control,
                                     const std::vector<double>& values);

/// A relay in each loop of the simulated rover, in an empty hall, at a cruising speed that is well
/// above the dead zone: turn rate moves the heading, speed the way driven. The outputs are poses at
/// the scenario's rate and latency; its motors count, its noise and slips are left out, because
/// they would only blur the switching.
struct RelayTuning {
  control::RelayResult heading;
  control::RelayResult speed;
  bool ok() const {
    return heading.status == control::RelayStatus::kOk && speed.status == control::RelayStatus::kOk;
  }
};
RelayTuning relay_on_rover(const RovigoConfig& config, const sim::Scenario& scenario);
/// The PI row of the thesis's table in both loops. Precondition: ok().
control::ControlConfig with_ziegler_nichols(const control::ControlConfig& control,
                                            const RelayTuning& relay);

/// Means over the runs of a suite.
struct SuiteScore {
  /// What is minimised, mm: cross-track RMS + 0.3 along-track RMS + 0.3 goal error + 2 for each
  /// m/s^3 of jerk RMS; 1000 for a run that misses its limits.
  double cost_mm = 0.0;
  double cross_track_rms_m = 0.0;
  double along_track_rms_m = 0.0;
  double final_position_error_m = 0.0;
  double jerk_rms_m_s3 = 0.0;
  std::size_t failed = 0;
  std::size_t runs = 0;
};

/// Drives these runs under each of the settings, side by side; the threads change no byte.
std::vector<SuiteScore> score_settings(const TrackBench& bench, const std::vector<TrackCase>& cases,
                                       const std::vector<control::ControlConfig>& settings,
                                       unsigned threads,
                                       const std::function<void(double share)>& progress);

}  // namespace rovigo::app
