#include "tests/support/slam_score.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/resources.h"
#include "maps/map_evaluation.h"
#include "maps/ros_map.h"
#include "sim/simulator.h"
#include "slam/trajectory_evaluation.h"
#include "tests/support/grid_checks.h"

namespace rovigo::test {

using slam::Health;
using slam::PoseEstimate;
using slam::StampedPose;

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kSameTimeS = 1e-3;
constexpr double kTallSliceM = 0.03;  // what reaches into it stops the rays at every height
constexpr TPoint2D kCorridorMiddle{15.0, 2.5};  // of sim/worlds/corridor.sdf
constexpr double kCorridorSpreadM = 0.3;        // within its doors

/// An answer beside the truth of the same moment.
struct Judged {
  const PoseEstimate* said = nullptr;
  double error_m = 0.0;
  double error_rad = 0.0;
  bool ok() const { return said->health == Health::kOk; }
  bool right() const { return error_m <= kWrongBeyondM && error_rad <= kWrongBeyondRad; }
};

const StampedPose* truth_at(const Truth& truth, double time_s) {
  const auto at = std::lower_bound(truth.poses.begin(), truth.poses.end(), time_s - kSameTimeS,
                                   [](const StampedPose& p, double t) { return p.time_s < t; });
  return at != truth.poses.end() && at->time_s <= time_s + kSameTimeS ? &*at : nullptr;
}

/// Answers at camera frames: there is truth for those.
std::vector<Judged> judged(const SlamRun& run, const Truth& truth) {
  std::vector<Judged> out;
  for (const PoseEstimate& said : run.answers) {
    const StampedPose* true_pose = truth_at(truth, said.time_s);
    if (!true_pose) continue;
    const auto& a = said.map_from_base;
    const auto& b = true_pose->pose;
    out.push_back({&said, std::hypot(a.x() - b.x(), a.y() - b.y()),
                   std::abs(maps::wrap_angle(a.yaw() - b.yaw()))});
  }
  return out;
}

/// How long after `begin_s` something was first said, looking from `from_s` on.
template <class Answers, class Predicate>
double first_after(const Answers& answers, double from_s, double begin_s, Predicate holds) {
  for (const auto& a : answers) {
    if (a.time_s >= from_s && holds(a)) return std::max(0.0, a.time_s - begin_s);
  }
  return kNever;
}

void keep_worst(SlamScore::Value& worst, double value) {
  worst = std::max(worst.value_or(0.0), value);
}

void score_trajectory(const SlamRun& run, const Truth& truth, SlamScore& score) {
  std::vector<StampedPose> all, ok;
  std::size_t answer = 0;
  for (const auto& p : run.map.trajectory) {
    const StampedPose pose{p.time_s, truth.of_camera
                                         ? p.map_from_base + run.map.metadata.base_from_camera
                                         : p.map_from_base};
    all.push_back(pose);
    while (answer < run.answers.size() && run.answers[answer].time_s < p.time_s - kSameTimeS) {
      ++answer;
    }
    const bool answered = answer < run.answers.size() &&
                          std::abs(run.answers[answer].time_s - p.time_s) <= kSameTimeS;
    if (p.is_camera_frame && answered && run.answers[answer].health == Health::kOk) {
      ok.push_back(pose);
    }
  }
  constexpr std::size_t kLeast = 3;  // poses an alignment needs
  if (all.size() >= kLeast) {
    const auto errors = slam::evaluate_trajectory(all, truth.poses);
    score.ate_m = errors.ate_rmse_m;
    score.coverage = errors.coverage;
  }
  score.ate_ok_m =
      ok.size() >= kLeast ? slam::evaluate_trajectory(ok, truth.poses).ate_rmse_m : kNever;
}

void score_answers(const std::vector<Judged>& answers, SlamScore& score) {
  int wrong = 0, ok = 0;
  double position = 0.0, heading = 0.0;
  for (const Judged& a : answers) {
    if (!a.ok()) continue;
    ++ok;
    wrong += !a.right();
    position += std::pow(a.error_m / std::max(1e-6, a.said->sigma_position_m), 2);
    heading += std::pow(a.error_rad / std::max(1e-6, a.said->sigma_heading_rad), 2);
  }
  score.wrong_frames = wrong;
  if (ok == 0) return;
  score.nees_position = position / ok;
  score.nees_heading = heading / ok;
}

void score_events(const SlamRun& run, const std::vector<Judged>& answers, double origin_s,
                  const sim::Scenario& scenario, SlamScore& score) {
  for (const auto& b : scenario.blackouts) {
    const double begin = origin_s + b.start_s, end = begin + b.duration_s;
    if (run.frame_times_s.back() < end) continue;
    const double not_ok = first_after(run.answers, begin, begin,
                                      [](const auto& a) { return a.health != Health::kOk; });
    keep_worst(score.not_ok_after_s, not_ok <= b.duration_s ? not_ok : kNever);
    keep_worst(score.ok_after_s, first_after(run.answers, end, end, [](const auto& a) {
                 return a.health == Health::kOk;
               }));
  }
  for (const auto& k : scenario.kidnaps) {
    const double begin = origin_s + k.time_s, resumes = begin + k.carry_s;
    if (run.frame_times_s.back() < resumes) continue;
    double right = kNever;
    for (const Judged& a : answers) {
      if (a.said->time_s < resumes || !a.ok() || !a.right()) continue;
      right = a.said->time_s - resumes;
      break;
    }
    const double lost = first_after(run.answers, begin, resumes,
                                    [](const auto& a) { return a.health == Health::kLost; });
    keep_worst(score.lost_after_s, std::min(lost, right));  // right at once needs no LOST
    keep_worst(score.right_after_s, right);
  }
}

/// Where the camera truly was, thinned out: neighbouring frames see the same ground.
std::vector<maps::View> true_views(const SlamRun& run, const Truth& truth) {
  constexpr std::size_t kEvery = 5;
  const mrpt::poses::CPose3D world_from_map(run.map.metadata.simulation->world_from_map);
  std::vector<maps::View> views;
  for (std::size_t i = 0; i < truth.poses.size(); i += kEvery) {
    const auto world_from_camera =
        world_from_map + truth.poses[i].pose + run.map.metadata.base_from_camera;
    const auto ahead = world_from_camera.composePoint({0.0, 0.0, 1.0});  // along the optical axis
    views.push_back(
        {TPose2D(world_from_camera.x(), world_from_camera.y(),
                 std::atan2(ahead.y - world_from_camera.y(), ahead.x - world_from_camera.x()))});
  }
  return views;
}

maps::FieldOfView field_of(const maps::MapMetadata& map, const sim::Scenario& scenario) {
  const mrpt::img::TCamera& camera = map.camera;
  const double steepest = scenario.camera.max_incidence_deg * maps::kPi / 180.0;
  return {std::atan2(camera.cx(), camera.fx()),
          std::atan2(static_cast<double>(camera.ncols) - camera.cx(), camera.fx()),
          scenario.camera.max_range_m, map.base_from_camera.z() * std::tan(steepest)};
}

void score_grid(const SlamRun& run, const Truth& all_truth, const sim::Scenario& scenario,
                SlamScore& score) {
  const maps::OccupancyGrid& truth = *all_truth.grid;
  const auto& simulation = *run.map.metadata.simulation;
  const TPose2D truth_from_map = simulation.world_from_map;
  const auto within_1 = maps::evaluate_map(run.map.grid, truth, truth_from_map, 1);
  const auto within_2 = maps::evaluate_map(run.map.grid, truth, truth_from_map, 2);
  score.precision_1 = within_1.precision;
  score.recall_1 = within_1.recall;
  score.precision_2 = within_2.precision;
  score.recall_2 = within_2.recall;
  score.free_iou = within_2.free_iou;
  const sim::World world = app::open_world(simulation.world);
  const slam::GridConfig heights;
  const maps::OccupancyGrid tall =
      sim::true_grid(world, truth.geometry.resolution_m,
                     heights.obstacle_max_height_m - kTallSliceM, heights.obstacle_max_height_m);
  const auto in_view = maps::cells_in_view(truth, tall, true_views(run, all_truth),
                                           field_of(run.map.metadata, scenario));
  score.free_iou_in_view = maps::free_iou_in_view(run.map.grid, truth, truth_from_map, in_view);
  score.ghost_cells = ghost_cells(run.map.grid, truth, truth_from_map);
  score.low_table_share = low_table_share(run.map.grid, truth, truth_from_map, world);
  score.low_table_free = low_table_free_cells(run.map.grid, truth_from_map, world);
  if (world.name() != "corridor") return;
  const auto asked = wall_to_wall_m(truth, {}, kCorridorMiddle, kCorridorSpreadM);
  const auto found = wall_to_wall_m(run.map.grid, maps::inverse(truth_from_map), kCorridorMiddle,
                                    kCorridorSpreadM);
  if (asked) score.length_error = found ? std::abs(*found / *asked - 1.0) : kNever;
}

void score_cost(const SlamRun& run, SlamScore& score) {
  score.cpu_ms = run.cpu_ms_per_frame;
  score.peak_mb = run.peak_mb;
  score.first_pose_ms = run.first_pose_ms;
  const auto& s = run.samples;
  if (s.size() < 6) return;
  const auto& first = s[s.size() / 3];
  const auto& second = s[2 * s.size() / 3];
  const auto& last = s.back();
  score.memory_growth_mb = last.resident_mb - first.resident_mb;
  const auto pace = [](const auto& a, const auto& b) {
    return (b.cpu_s - a.cpu_s) / (b.frames - a.frames);
  };
  score.cpu_growth = pace(second, last) / pace(first, second);
}

}  // namespace

Truth load_truth(const std::filesystem::path& folder) {
  Truth truth;
  truth.poses = slam::read_tum_trajectory(folder / "base_groundtruth.txt");
  std::vector<std::string> warnings;
  truth.grid = maps::load_any_map(folder / "world_grid.yaml", warnings).grid;
  return truth;
}

Truth load_camera_truth(const std::filesystem::path& tum_trajectory) {
  Truth truth;
  truth.poses = slam::read_tum_trajectory(tum_trajectory);
  truth.of_camera = true;
  return truth;
}

const std::vector<Figure>& all_figures() {
  using S = SlamScore;
  static const std::vector<Figure> figures{
      {"ate_m", &S::ate_m, 4},
      {"ate_ok_m", &S::ate_ok_m, 4},
      {"coverage", &S::coverage, 3},
      {"tracked", &S::tracked, 3},
      {"loops", &S::loops, 0},
      {"precision_1", &S::precision_1, 3},
      {"recall_1", &S::recall_1, 3},
      {"precision_2", &S::precision_2, 3},
      {"recall_2", &S::recall_2, 3},
      {"free_iou", &S::free_iou, 3},
      {"free_iou_in_view", &S::free_iou_in_view, 3},
      {"cpu_ms", &S::cpu_ms, 1},
      {"peak_mb", &S::peak_mb, 0},
      {"first_pose_ms", &S::first_pose_ms, 0},
      {"wrong_frames", &S::wrong_frames, 0},
      {"nees_position", &S::nees_position, 2},
      {"nees_heading", &S::nees_heading, 2},
      {"not_ok_after_s", &S::not_ok_after_s, 2},
      {"ok_after_s", &S::ok_after_s, 2},
      {"lost_after_s", &S::lost_after_s, 2},
      {"right_after_s", &S::right_after_s, 2},
      {"ghost_cells", &S::ghost_cells, 0},
      {"length_error", &S::length_error, 4},
      {"low_table_share", &S::low_table_share, 3},
      {"low_table_free", &S::low_table_free, 0},
      {"steady_ratio", &S::steady_ratio, 2},
      {"memory_growth_mb", &S::memory_growth_mb, 1},
      {"cpu_growth", &S::cpu_growth, 2},
  };
  return figures;
}

SlamScore score_run(const SlamRun& run, const Truth& truth, const sim::Scenario& scenario) {
  SlamScore score;
  score_trajectory(run, truth, score);
  score.tracked = static_cast<double>(run.summary.tracked_frames) / run.summary.camera_frames;
  score.loops = run.summary.loop_closures;
  score_cost(run, score);
  if (truth.of_camera) return score;  // TUM's frame is its own: online poses cannot be compared
  const std::vector<Judged> answers = judged(run, truth);
  score_answers(answers, score);
  score_events(run, answers, truth.poses.front().time_s, scenario, score);
  if (truth.grid && run.map.metadata.simulation) score_grid(run, truth, scenario, score);
  return score;
}

}  // namespace rovigo::test
