#pragma once
// The closed loop: simulator, pose source, controller. `record`, `drive` and `track` run on it.

#include <mrpt/obs/CObservation.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "app/pose_faults.h"
#include "app/pose_source.h"
#include "app/sensor_faults.h"
#include "control/drive_controller.h"
#include "control/drive_log.h"
#include "sim/simulator.h"

namespace rovigo::app {

/// For poses that a rover can find by itself: a drive without a good pose at its start looks around
/// first, and one that loses its pose on the way looks around, plans anew and goes on.
struct DriveRecovery {
  double start_heading_rad = 0.0;  ///< map frame: faced again before the drive begins
  /// The controller of the way that is left, from here. Null: there is none.
  std::function<std::unique_ptr<control::DriveController>(const TPose2D& map_from_base,
                                                          const control::DriveLog& so_far)>
      plan_anew;
};

struct DriveHooks {
  std::function<void(double share)> progress;  ///< of the planned duration
  std::function<void(const mrpt::obs::CObservation&)> observation;
  std::optional<DriveRecovery> recovery = std::nullopt;
};

inline constexpr int kStepsPerCommand = 2;    ///< 120 Hz on a 240 Hz simulator
inline constexpr double kStandBeforeS = 1.0;  ///< the gyro's bias can be learned
inline constexpr double kStandAfterS = 0.5;
inline constexpr double kDriveCameraHz = 15.0;  ///< while it drives on poses from the camera

/// One simulated drive, advanced a command period (1/120 s of simulated time) at a time. Between
/// controller and simulator stands the drive side's guard; the scenario's faults are played in.
class DriveLoop {
 public:
  /// Simulator, poses and hooks must outlive this.
  DriveLoop(sim::Simulator& simulator, const TPose2D& world_from_map, PoseSource& poses,
            const RovigoConfig& config, const DriveHooks& hooks)
      : simulator_(simulator),
        map_from_world_(maps::inverse(world_from_map)),
        poses_(poses),
        guard_(config.control, config.robot.battery_low_v),
        hooks_(hooks) {}

  void advance(const TTwist2D& command);
  void stand_still(double seconds);
  /// What the motors are to do now, as a step of the log whose time counts from `begin_s`; `log`
  /// takes the step, and how the drive stands.
  void step(control::DriveController& controller, double begin_s, control::DriveLog& log);
  /// Turns in place until the pose is good, then to `facing_rad`, if given; the drive side needs no
  /// pose meanwhile. `log` as for step(). True when the pose is good in the end.
  bool look_around(std::optional<double> facing_rad, double begin_s, control::DriveLog& log);
  /// Where the rover truly is, in the map frame.
  TPose2D true_pose() const;

 private:
  sim::Simulator& simulator_;
  TPose2D map_from_world_;
  PoseSource& poses_;
  SensorFaults sensor_faults_;
  PoseFaults pose_faults_;
  control::DriveGuard guard_;
  control::TrackerOutput last_;  ///< of the controller, while it was alive
  bool looks_around_ = false;
  const DriveHooks& hooks_;
};

/// Stands still for a second (the gyro's bias can be learned), drives until the controller ends the
/// drive or the drive side has held the rover for too long, stands still for half a second. Control
/// runs at 120 Hz of simulated time. With hooks.recovery a lost pose is looked for, on the way a
/// few times at most.
control::DriveLog drive_in_simulator(sim::Simulator& simulator, const TPose2D& world_from_map,
                                     PoseSource& poses, control::DriveController& controller,
                                     double planned_duration_s, const RovigoConfig& config,
                                     const DriveHooks& hooks);

/// SHA-256, hex, over the steps (index, true pose, estimate, command) as little-endian doubles.
std::string log_hash(const control::DriveLog& log);

/// SHA-256 of these bytes, hex.
std::string sha256(std::string_view bytes);

}  // namespace rovigo::app
