#pragma once
// The YAML files of a TUM directory: camera_info.yaml, extrinsics.yaml, simulation.yaml.

#include <mrpt/img/TCamera.h>
#include <mrpt/poses/CPose3D.h>

#include <filesystem>
#include <optional>
#include <string>

#include "maps/map_file.h"

namespace rovigo::slam {

/// ROS camera_info, as camera_calibration writes it (`camera_matrix`, `distortion_coefficients`) or
/// as the message prints (`K`, `D`). Throws InputError for anything missing or impossible.
mrpt::img::TCamera read_camera_info(const std::filesystem::path& path);
std::string camera_info_text(const mrpt::img::TCamera& camera);

/// One sentence when the camera model cannot be used; empty when it can.
std::string camera_problem(const mrpt::img::TCamera& camera);

/// base_from_camera: `translation: [x, y, z]`, `rotation_xyzw: [x, y, z, w]`.
mrpt::poses::CPose3D read_extrinsics(const std::filesystem::path& path);
std::string extrinsics_text(const mrpt::poses::CPose3D& base_from_camera);

/// `world`, `seed`, `world_from_map: [x, y, yaw]`.
maps::SimulationOrigin read_simulation(const std::filesystem::path& path);
std::string simulation_text(const maps::SimulationOrigin& simulation);

/// The calibration TUM publishes for its folders: freiburg1, 2 or 3 in the name; else nothing.
std::optional<mrpt::img::TCamera> tum_camera_by_name(const std::string& folder);
/// How long their cameras take from an image's first row to its last, s; 0: not known.
double tum_rolling_shutter_by_name(const std::string& folder);

}  // namespace rovigo::slam
