#pragma once
// The observations of a rawlog, one after another, whatever its flavour and whoever wrote it.

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "slam/recording/gz_archive.h"
#include "slam/recording/rawlog_header.h"
#include "slam/recording/rgbd_normalizer.h"
#include "slam/recording/warnings.h"

namespace rovigo::slam {

/// Hands out RGB-D (normalised), IMU (in base_link) and odometry observations in the order of the
/// file; odometry steps of the "actions and sensory frames" flavour become absolute odometry. Other
/// observations are left out and counted by kind. Damage ends the stream and is told in
/// `warnings()`; only a file whose first object cannot be read is an error.
class RawlogStream {
 public:
  explicit RawlogStream(std::filesystem::path path);

  /// Null at the end. Throws InputError for a file that is not a rawlog.
  mrpt::obs::CObservation::Ptr next();

  const std::optional<RawlogHeader>& header() const { return header_; }
  std::uint64_t bytes_read() const { return archive_.bytes_read(); }
  /// The file ended, or stopped making sense, before its end.
  bool is_damaged() const { return is_damaged_; }
  int skipped_frames() const { return skipped_frames_; }
  /// Why the first frame that was left out was left out.
  const std::string& first_frame_problem() const { return first_frame_problem_; }
  WarningList& warnings() { return warnings_; }
  const WarningList& warnings() const { return warnings_; }
  void skip_frame(const std::string& problem);

 private:
  void read_object();
  void end_with_damage();
  void note_left_out();
  void take_object(const mrpt::serialization::CSerializable::Ptr& object);
  void take_actions(const mrpt::obs::CActionCollection& actions);
  void take_sensory_frame(const mrpt::obs::CSensoryFrame& frame);
  void take_observation(const mrpt::obs::CObservation::Ptr& observation);
  void take_frame(const mrpt::obs::CObservation3DRangeScan::Ptr& scan);

  std::filesystem::path path_;
  GzReadArchive archive_;
  RgbdNormalizer normalizer_;
  std::deque<mrpt::obs::CObservation::Ptr> ready_;
  std::optional<RawlogHeader> header_;
  mrpt::poses::CPose2D odometry_;  ///< sum of the odometry steps of actions
  bool has_new_odometry_ = false;
  std::map<std::string, int> left_out_;  ///< class name -> how many
  std::uint64_t objects_ = 0;
  int skipped_frames_ = 0;
  std::string first_frame_problem_;
  bool is_done_ = false;
  bool is_damaged_ = false;
  WarningList warnings_;
};

}  // namespace rovigo::slam
