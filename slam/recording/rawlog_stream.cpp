#include "slam/recording/rawlog_stream.h"

#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CRawlog.h>

#include <cmath>
#include <exception>
#include <utility>

#include "maps/error.h"
#include "slam/recording/observations.h"
#include "slam/recording/rawlog_objects.h"

namespace rovigo::slam {
namespace {

using mrpt::obs::CObservation;

constexpr double kLatest_s = 1e10;  // as in text files

bool has_usable_time(const CObservation& observation) {
  if (observation.timestamp == INVALID_TIMESTAMP) return false;
  const double time_s = seconds_of(observation);
  return time_s >= 0.0 && time_s <= kLatest_s;
}

bool is_finite(const mrpt::poses::CPose2D& pose) {
  constexpr double kFarthest_m = 1e6;
  return std::abs(pose.x()) < kFarthest_m && std::abs(pose.y()) < kFarthest_m &&
         std::isfinite(pose.phi());
}

}  // namespace

RawlogStream::RawlogStream(std::filesystem::path path) : path_(std::move(path)), archive_(path_) {}

CObservation::Ptr RawlogStream::next() {
  while (ready_.empty() && !is_done_) read_object();
  if (ready_.empty()) return nullptr;
  CObservation::Ptr observation = std::move(ready_.front());
  ready_.pop_front();
  return observation;
}

void RawlogStream::read_object() {
  if (archive_.at_end()) {
    is_done_ = true;
    if (objects_ == 0 || archive_.is_damaged()) end_with_damage();
    note_left_out();
    return;
  }
  mrpt::serialization::CSerializable::Ptr object;
  try {
    object = read_rawlog_object(archive_);
  } catch (const std::exception&) {  // MRPT's own words are a stack trace
    is_done_ = true;
    end_with_damage();
    note_left_out();
    return;
  }
  ++objects_;
  if (object) take_object(object);
}

void RawlogStream::end_with_damage() {
  if (objects_ == 0) {
    throw maps::InputError(
        path_.string() +
        ": not an MRPT rawlog, or damaged from the start; give a .rawlog file or "
        "a TUM directory");
  }
  is_damaged_ = true;
  // A plain (not compressed) file that is cut just ends; so does one that reads past its end.
  const bool is_cut = archive_.is_cut_short() || (!archive_.is_damaged() && archive_.at_end());
  warnings_.add(path_.filename().string() +
                (is_cut ? " is cut short" : " is damaged or of another kind") + " after " +
                std::to_string(objects_) + " objects (uncompressed byte " +
                std::to_string(archive_.position()) + "); what stands before is used.");
}

void RawlogStream::note_left_out() {
  for (const auto& [name, count] : left_out_) {
    warnings_.add(std::to_string(count) + " observations of the kind " + name +
                  " are left out; Rovigo does not use them.");
  }
}

void RawlogStream::take_object(const mrpt::serialization::CSerializable::Ptr& object) {
  if (const auto observation = std::dynamic_pointer_cast<CObservation>(object)) {
    take_observation(observation);
  } else if (const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object)) {
    take_sensory_frame(*frame);
  } else if (const auto actions = std::dynamic_pointer_cast<mrpt::obs::CActionCollection>(object)) {
    take_actions(*actions);
  } else if (const auto rawlog = std::dynamic_pointer_cast<mrpt::obs::CRawlog>(object)) {
    for (std::size_t i = 0; i < rawlog->size(); ++i) {
      const auto entry = rawlog->getAsGeneric(i);
      if (entry && !std::dynamic_pointer_cast<mrpt::obs::CRawlog>(entry)) take_object(entry);
    }
  } else {
    ++left_out_[object->GetRuntimeClass()->className];
  }
}

void RawlogStream::take_actions(const mrpt::obs::CActionCollection& actions) {
  for (const auto& action : actions) {
    const auto* const movement =
        dynamic_cast<const mrpt::obs::CActionRobotMovement2D*>(action.get_ptr().get());
    if (movement == nullptr || !is_finite(movement->rawOdometryIncrementReading)) continue;
    odometry_ = odometry_ + movement->rawOdometryIncrementReading;
    has_new_odometry_ = true;
  }
}

/// A step of odometry ends where the sensory frame after it was taken.
void RawlogStream::take_sensory_frame(const mrpt::obs::CSensoryFrame& frame) {
  CObservation::Ptr first;
  for (const auto& observation : frame) {
    if (!observation || !has_usable_time(*observation)) continue;
    if (!first || observation->timestamp < first->timestamp) first = observation;
  }
  if (has_new_odometry_ && first && is_finite(odometry_)) {
    ready_.push_back(make_odometry_observation(
        {seconds_of(*first), {odometry_.x(), odometry_.y(), odometry_.phi()}}, std::nullopt));
    has_new_odometry_ = false;
  }
  for (const auto& observation : frame) {
    if (observation) take_observation(observation);
  }
}

void RawlogStream::take_observation(const CObservation::Ptr& observation) {
  if (const auto comment = std::dynamic_pointer_cast<mrpt::obs::CObservationComment>(observation)) {
    if (!header_) header_ = parse_header(comment->text, path_.string());
    return;
  }
  const char* const name = observation->GetRuntimeClass()->className;
  if (const auto scan =
          std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(observation)) {
    take_frame(scan);
  } else if (!has_usable_time(*observation)) {
    ++left_out_[std::string(name) + " without a time"];
  } else if (const auto imu = std::dynamic_pointer_cast<mrpt::obs::CObservationIMU>(observation)) {
    if (const auto sample = imu_sample_of(*imu)) {
      ready_.push_back(make_imu_observation(*sample));
    } else {
      ++left_out_[std::string(name) + " without rates and forces"];
    }
  } else if (const auto odometry =
                 std::dynamic_pointer_cast<mrpt::obs::CObservationOdometry>(observation)) {
    if (is_finite(odometry->odometry)) {
      ready_.push_back(odometry);
    } else {
      ++left_out_[std::string(name) + " that is not finite"];
    }
  } else {
    ++left_out_[name];
  }
}

void RawlogStream::take_frame(const mrpt::obs::CObservation3DRangeScan::Ptr& scan) {
  if (!has_usable_time(*scan)) {
    skip_frame("it has no time");
    return;
  }
  std::string problem;
  if (normalizer_.normalize(*scan, problem)) {
    ready_.push_back(scan);
  } else {
    skip_frame(problem);
  }
}

void RawlogStream::skip_frame(const std::string& problem) {
  ++skipped_frames_;
  if (first_frame_problem_.empty()) first_frame_problem_ = problem;
  warnings_.add("A camera frame (object " + std::to_string(objects_) + ") is left out: " + problem +
                ".");
}

}  // namespace rovigo::slam
