#pragma once
// What a SLAM run is worth, judged by the truth that only the scorer sees.

#include <array>
#include <optional>
#include <string>

#include "maps/map_file.h"
#include "sim/scenario.h"
#include "slam/trajectory_file.h"
#include "tests/support/slam_run.h"

namespace rovigo::test {

/// The truth beside a simulated recording (`record --truth`), or TUM's (camera poses only).
struct Truth {
  std::vector<slam::StampedPose> poses;
  bool of_camera = false;                   ///< else of base_link, in the map's own frame
  std::optional<maps::OccupancyGrid> grid;  ///< world frame
};
Truth load_truth(const std::filesystem::path& folder);
Truth load_camera_truth(const std::filesystem::path& tum_trajectory);

/// A pose is wrong beyond these (design.md); wrong while health is OK is confidently wrong.
inline constexpr double kWrongBeyondM = 0.20;
inline constexpr double kWrongBeyondRad = 10.0 * 3.14159265358979323846 / 180.0;

/// Every figure of a run; none where it does not apply. What never happened is infinite.
struct SlamScore {
  using Value = std::optional<double>;
  Value ate_m;     ///< all poses of the finished map, SE(3) aligned
  Value ate_ok_m;  ///< of those, camera frames whose health was OK when they came
  Value coverage, tracked, loops;
  Value precision_1, recall_1, precision_2, recall_2;  ///< occupied cells, within 1 and 2 cells
  Value free_iou;          ///< over the whole world, as `rovigo evaluate map`
  Value free_iou_in_view;  ///< over what the camera had in view: other rooms are not asked for
  Value cpu_ms;            ///< per frame, reading and final optimisation included
  Value peak_mb;           ///< resident, of the mapping process
  Value first_pose_ms;     ///< from asking for the first frame to its pose, wall clock
  Value wrong_frames;      ///< confidently wrong, of the poses given online
  Value nees_position;     ///< mean squared error over stated variance, OK poses; honest: 1
  Value nees_heading;      ///< likewise
  Value not_ok_after_s;    ///< worst black-out: from its begin to the first answer that is not OK
  Value ok_after_s;        ///< worst black-out: from its end to the first answer that is OK
  Value lost_after_s;      ///< worst kidnap: from the first frame to LOST (0: during the ride)
  Value right_after_s;     ///< worst kidnap: from the first frame to a right OK pose
  Value ghost_cells;       ///< occupied cells amid free ground (see ghost_cells())
  Value length_error;      ///< of the corridor, wall to wall, relative
  Value low_table_share;   ///< of the cells of low tables, those the map holds occupied
  Value low_table_free;    ///< cells well under a low table that the map calls free
  Value steady_ratio;      ///< ATE over that of the same route in steady light
  Value memory_growth_mb;  ///< resident, from a third of the run to its end
  Value cpu_growth;        ///< CPU per frame, last third over second third
};

/// A figure by name: the columns of the table and of the results kept.
struct Figure {
  const char* name;
  SlamScore::Value SlamScore::*value;
  int digits;
};
const std::vector<Figure>& all_figures();

/// `scenario` tells when the camera went blind and when the rover was carried off.
SlamScore score_run(const SlamRun& run, const Truth& truth, const sim::Scenario& scenario);

}  // namespace rovigo::test
