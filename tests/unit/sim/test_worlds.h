#pragma once
// Small worlds for tests, and what a rover does in them.

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <memory>
#include <string>
#include <vector>

#include "sim/simulator.h"
#include "sim/world_model.h"

namespace rovigo::sim {

inline WorldModel bare_floor() {
  WorldModel model;
  model.name = "floor";
  Solid floor;
  floor.kind = Solid::Kind::kPlane;
  floor.size = {40.0, 40.0, 1.0};
  floor.name = "floor";
  model.solids.push_back(floor);
  return model;
}

/// A box with its middle at (x, y), standing at height `bottom`.
inline Solid box_at(double x, double y, double bottom, const Eigen::Vector3d& size) {
  Solid box;
  box.name = "box";
  box.size = size;
  box.world_from_solid.translation() << x, y, bottom + size.z() / 2;
  return box;
}

/// A wall across the x axis whose near face is at x = `distance`.
inline WorldModel wall_ahead(double distance) {
  WorldModel model = bare_floor();
  model.solids.push_back(box_at(distance + 0.5, 0.0, 0.0, {1.0, 20.0, 4.0}));
  return model;
}

inline SimulatorOptions blind_options(const Scenario& scenario = ideal_scenario()) {
  SimulatorOptions options;
  options.scenario = scenario;
  options.camera_enabled = false;
  return options;
}

inline void drive(Simulator& simulator, const TTwist2D& command, double seconds) {
  const int steps = static_cast<int>(seconds / Simulator::kStepS + 0.5);
  for (int i = 0; i < steps; ++i) simulator.step(command);
}

inline TPose2D true_pose(const Simulator& simulator) {
  const auto& p = simulator.truth().world_from_base;
  return {p.x(), p.y(), p.yaw()};
}

/// The observations of one kind, in order.
template <class Kind>
std::vector<std::shared_ptr<Kind>> only(
    const std::vector<mrpt::obs::CObservation::Ptr>& observations) {
  std::vector<std::shared_ptr<Kind>> out;
  for (const auto& o : observations) {
    if (auto k = std::dynamic_pointer_cast<Kind>(o)) out.push_back(k);
  }
  return out;
}

}  // namespace rovigo::sim
