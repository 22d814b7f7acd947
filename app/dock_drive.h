#pragma once
// Docking on a marker with camera and wheels: what is seen, what is believed, what is commanded.

#include <mrpt/poses/CPose3D.h>

#include "app/simulated_drive.h"

namespace rovigo::app {

struct DockDrive {
  control::DriveLog log;  ///< in the dock's frame (control/docking.h)
  int sightings = 0;      ///< camera frames with the marker
  int attempts = 0;
};

/// base_from_face, on the floor, x out of the marker's face, from one sighting.
TPose2D face_from_sighting(const mrpt::poses::CPose3D& base_from_camera,
                           const mrpt::poses::CPose3D& camera_from_marker);

/// Drives the simulated rover by its camera and its wheels to the marker. Between sightings the
/// wheels carry the pose on; unseen for a second, the rover stands. `world_from_dock` is used for
/// the log's true poses only.
DockDrive dock_on_marker(sim::Simulator& simulator, const TPose2D& world_from_dock, int marker_id,
                         const RovigoConfig& config, const DriveHooks& hooks = {});

}  // namespace rovigo::app
