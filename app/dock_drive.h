#pragma once
// Docking on a marker with camera and wheels: what is seen, what is believed, what is commanded.

#include <optional>

#include "control/docking.h"
#include "sim/simulator.h"

namespace rovigo::app {

struct DockRequest {
  int marker_id = 0;
  double marker_side_m = 0.2;  ///< of the black square
  double standoff_m = 0.6;     ///< base_link from the marker's middle, along its normal, at the end
  double longest_s = 90.0;
};

struct DockResult {
  control::DockingStatus status = control::DockingStatus::kRunning;  ///< still running: timed out
  bool seen = false;                                                 ///< the marker, ever
  int sightings = 0;  ///< camera frames with the marker
  int attempts = 0;
  double duration_s = 0.0;
  TPose2D dock_from_base;  ///< as believed in the end
};

/// Where base_link is in the dock's frame (control/docking.h), from one sighting of its marker.
TPose2D dock_from_sighting(const mrpt::poses::CPose3D& base_from_camera,
                           const mrpt::poses::CPose3D& camera_from_marker, double standoff_m);

/// Drives the simulated rover by its camera (20 Hz is what the controller is made for) and its
/// wheels to the marker. Between sightings the wheels carry the pose on; unseen for a second, the
/// rover stands. Uses no truth.
DockResult dock_on_marker(sim::Simulator& simulator, const DockRequest& request,
                          const control::DockingConfig& config);

}  // namespace rovigo::app
