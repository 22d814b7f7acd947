#pragma once
// The rover in its world: physics, sensors, faults. Deterministic: same inputs, same bytes.

#include <mrpt/img/TCamera.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/poses/CPose3D.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "maps/occupancy_grid.h"
#include "maps/robot_model.h"
#include "sim/fault_script.h"
#include "sim/scenario.h"
#include "sim/world.h"

namespace rovigo::sim {

struct SensorRig {
  mrpt::img::TCamera camera;              ///< 640x480, pinhole
  mrpt::poses::CPose3D base_from_camera;  ///< optical frame
};

/// What only the scorer may see.
struct Truth {
  mrpt::poses::CPose3D world_from_base;
  TTwist2D twist;             ///< of base_link, in base_link
  int contact_events = 0;     ///< times the rover began to touch anything but the floor
  bool carried = false;       ///< somebody holds it: its wheels stand whatever is commanded
  int kidnaps = 0;            ///< times it was carried away, the present one included
  bool camera_blind = false;  ///< covered, or no frames
};

struct SimulatorOptions {
  maps::RobotModel robot;
  Scenario scenario;        ///< sensors' noise, faults, disturbances
  TPose2D world_from_base;  ///< where it is put down
  std::uint64_t seed = 1;
  bool camera_enabled = true;
  double camera_rate_hz = 30.0;
};

class Simulator {
 public:
  static constexpr double kStepS = 1.0 / 240.0;

  /// Throws InputError when the rover would stand in an obstacle or on no floor, or when the camera
  /// rate is outside (0, 240].
  Simulator(const World& world, const SimulatorOptions& options);
  ~Simulator();

  /// One physics step of kStepS under this commanded twist (vx, omega; vy is ignored).
  void step(const TTwist2D& command);

  /// Simulated seconds; the recording's clock starts at 1 s because MRPT takes 0 for "no time".
  double time_s() const;

  /// Observations that fell due since the last call, in time order: CObservation3DRangeScan
  /// (label "camera"), CObservationIMU ("imu"), CObservationOdometry ("wheels"). They carry only
  /// what the rover's sensors would see.
  std::vector<mrpt::obs::CObservation::Ptr> take_observations();

  /// What the rover's voltmeter reads.
  double battery_v() const;
  /// The scripted fault of this kind that rules now, or none. The simulator itself applies
  /// kBatteryLow; whoever closes the loop applies the others.
  const Fault* fault(FaultKind kind) const;

  const Truth& truth() const;
  const SensorRig& rig() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The true grid in the world frame: obstacle = any surface between the two heights (design.md,
/// "The grid's meaning"); free elsewhere inside the world, unknown outside it.
maps::OccupancyGrid true_grid(const World& world, double resolution_m, double min_height_m,
                              double max_height_m);

/// Marks which surfaces the camera saw, to judge a map only by them.
class SeenSurfaces {
 public:
  SeenSurfaces(const World& world, double resolution_m, double min_height_m, double max_height_m);
  ~SeenSurfaces();
  /// Adds what this noise-free view of the world would show, up to the camera's range.
  void add_view(const mrpt::poses::CPose3D& world_from_camera, const mrpt::img::TCamera& camera);
  /// The true grid with occupied cells that were never seen set to unknown.
  maps::OccupancyGrid grid() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rovigo::sim
