#pragma once
// The localizer's state, and its three halves: looking for a place (localizer_search.cpp),
// following it from frame to frame (localizer_follow.cpp), and what may be said about it
// (localizer.cpp).

#include "slam/grid_match.h"
#include "slam/local_map.h"
#include "slam/localizer.h"
#include "slam/motion_model.h"
#include "slam/place_finder.h"
#include "slam/relocalizer.h"
#include "slam/view_check.h"
#include "slam/view_continuity.h"
#include "slam/view_slide.h"
#include "slam/view_trail.h"

namespace rovigo::slam {

struct Localizer::Impl {
  enum class State { kSearching, kConfirming, kTracking };

  /// `start`: how wheels and gyro are calibrated, as far as that is known.
  Impl(const SlamConfig& settings, const Rig& r, const LandmarkMap& known,
       const maps::OccupancyGrid& grid, DepthMemory depths, const MotionModel& start)
      : config(settings),
        rig(r),
        map(known),
        motion(start),
        odometry(start),
        continuity(map.camera(), map.base_from_camera()),
        finder(motion.planar() ? grid : maps::OccupancyGrid{}, std::move(depths)),
        relocalizer(map),
        checker(map, finder.has_grid() ? &finder.field() : nullptr,
                relocalizer.repeated_landmarks(map), motion.planar()),
        slide(map),
        trail(map) {}

  void expect_near(const PosePrior& given);
  void begin(double time_s);
  void believe_prior();
  void on_frame(const mrpt::obs::CObservation3DRangeScan& scan);
  void on_frame(const CameraFrame& frame, FeatureSet features);
  void note_interval(double time_s);
  bool look_everywhere(const SeenView& view);
  void judge_places(const SeenView& view, bool is_new);
  void recognize(const SeenView& view, const Se3& map_from_base, double weight);
  void look_beside(const SeenView& view, bool recognized);
  bool fits_as_well(double time_s, const Se3& here, const Slide& aside);
  void put(double time_s, const Se3& map_from_base);
  void step_aside(double time_s, const Se3& map_from_base);
  void adopt(double time_s, const Se3& map_from_base);
  bool hold_by_scan(const SeenView& view, const std::vector<int>& local_landmarks);
  void follow(const SeenView& view);
  void move_as_seen(const SeenView& view);
  void leave_trail(const SeenView& view, const Se3& before);
  void take_in(const SeenView& view, const TrackResult& result, const ViewCheck& seen);
  void note_agreement(double time_s, int inliers, const ViewCheck& seen);
  void miss(const SeenView& view, const std::vector<int>& local_landmarks,
            const MotionPrediction& prediction);
  void weigh_support(double time_s);
  Se3 odom_from_base(double time_s) { return odometry.predict(time_s).prior.map_from_base; }
  Se3 believed(double time_s) { return motion.predict(time_s).prior.map_from_base; }
  bool is_convincing() const;
  bool matches_here() const;
  double frames_to_be_sure() const;
  void believe_nothing();
  void lose(double time_s);
  void drop_guess(double time_s);
  bool within_reach(double time_s, const Se3& map_from_base);
  bool camera_is_silent(double time_s) const;
  PoseEstimate estimate(double time_s);

  SlamConfig config;
  Rig rig;
  const LandmarkMap& map;
  MotionModel motion;
  MotionModel odometry;  ///< never corrected: ties together what is seen while searching
  ViewContinuity continuity;
  PlaceFinder finder;
  Relocalizer relocalizer;
  ViewChecker checker;
  ViewSlide slide;
  ViewTrail trail;
  std::optional<PoseRegion> prior;
  double prior_sigma_m = 0.0, prior_sigma_rad = 0.0;
  bool vouched = false;  ///< the prior speaks for the pose believed, or for the view known there

  State state = State::kSearching;
  bool begun = false;
  bool has_pose = false;  ///< some pose to carry on from, right or not
  std::vector<int> tracked;
  LocalizerEvidence evidence;
  int frames = 0;
  int inliers_now = 0;     ///< of the newest frame; what earlier ones had fades in the evidence
  int misses = 0;          ///< frames in a row that matched nothing
  bool broken = false;     ///< the view has jumped since a frame last agreed
  double jumped_s = -1e9;  ///< when it last did
  bool was_sure = false;   ///< of this place, before the camera was blind
  bool doubt = false;      ///< the newest frame shows plenty and does not fit
  std::optional<double> contradicted_since_s;
  std::optional<double> unvouched_since_s;
  double last_fix_s = -1e9;
  double last_frame_s = -1e9;
  double frame_interval_s = 0.1;  ///< usual one
};

}  // namespace rovigo::slam
