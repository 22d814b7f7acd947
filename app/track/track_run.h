#pragma once
// One run of a suite: drive a trajectory in the simulator, measure, judge.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/config.h"
#include "app/track/shapes.h"
#include "app/track/suite.h"
#include "control/drive_log.h"
#include "control/tracking_metrics.h"
#include "sim/scenario.h"

namespace rovigo::app {

struct TrackRun {
  TrackCase what;
  std::shared_ptr<const PlannedTrack> track;
  control::DriveLog log;
  control::DriveMetrics metrics;
  std::vector<std::string> failures;  ///< each names figure, value and limit; empty: passed
};

/// A suite with everything its runs need opened and, missions aside, planned, so that no run ends
/// in bad input.
class TrackBench {
 public:
  /// `pose` overrides the groups' pose source. Throws InputError.
  TrackBench(TrackSuite suite, const RovigoConfig& config, const std::optional<std::string>& pose);

  const TrackSuite& suite() const { return suite_; }
  /// The same runs under other controller settings.
  TrackBench with_control(const control::ControlConfig& control) const;
  /// May be called from several threads at once.
  TrackRun run(const TrackCase& what) const;

 private:
  RovigoConfig config_at(double speed_m_s) const;
  PlannedTrack plan_ahead(const std::string& trajectory, const RovigoConfig& config) const;
  void open_ground(const TrackGroup& group, const std::string& trajectory);
  std::shared_ptr<const PlannedTrack> plan(const TrackCase& what) const;
  /// Leaves in `track` what was followed in the end.
  control::DriveLog drive(const TrackCase& what, PlannedTrack& track) const;

  TrackSuite suite_;
  RovigoConfig config_;
  std::map<std::string, sim::Scenario> scenarios_;
  std::map<std::string, std::shared_ptr<const maps::SavedMap>> maps_;  ///< of goals and missions
  /// All but missions, which are drawn by the seed.
  std::map<std::pair<std::string, double>, std::shared_ptr<const PlannedTrack>> planned_;
};

/// What a run misses, by its group's limits.
std::vector<std::string> failures_of(const TrackLimits& limits, const control::DriveLog& log,
                                     const control::DriveMetrics& m);

/// design.md's keys of a run, and the further figures.
nlohmann::ordered_json run_json(const TrackRun& run);

}  // namespace rovigo::app
