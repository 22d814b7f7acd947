#include "slam/recording/bag_reader.h"

#include <mrpt/obs/CObservation3DRangeScan.h>

#include <utility>

#include "maps/error.h"
#include "slam/recording/bag_stream.h"
#include "slam/recording/bag_survey.h"

namespace rovigo::slam {
namespace {

namespace fs = std::filesystem;

class BagReader final : public RecordingReader {
 public:
  BagReader(const fs::path& path, const BagLayout& layout) : stream_(path, layout) {
    info_.name = path.stem().string();
    info_.format = "bag";
    info_.rig = layout.rig;
    info_.sources = {{"colour", layout.color_topic}, {"depth", layout.depth_topic}};
    if (layout.imu) {
      info_.sources.emplace_back("IMU", layout.imu->rate_topic);
      if (layout.imu->force_topic != layout.imu->rate_topic) {
        info_.sources.back().second += " and " + layout.imu->force_topic;
      }
    }
    if (layout.wheel_topic) info_.sources.emplace_back("wheels", *layout.wheel_topic);
  }

  const RecordingInfo& info() const override { return info_; }
  mrpt::obs::CObservation::Ptr next() override { return stream_.next(); }
  double progress() const override { return stream_.progress(); }
  int skipped() const override { return stream_.skipped_frames(); }
  std::vector<std::string> warnings() const override { return stream_.warnings(); }

 private:
  BagStream stream_;
  RecordingInfo info_;
};

void require_a_readable_frame(const fs::path& path, const BagLayout& layout) {
  BagStream stream(path, layout);
  while (const auto observation = stream.next()) {
    if (dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(observation.get()) != nullptr) {
      return;
    }
  }
  const std::string topics = layout.color_topic + " and " + layout.depth_topic;
  const std::string& problem = stream.first_frame_problem();
  throw maps::InputError(
      path.string() +
      (problem.empty()
           ? ": no colour image has a depth image within 0.02 s; check the stamps of " + topics
           : ": none of its camera frames can be used; of the first, " + problem));
}

}  // namespace

std::unique_ptr<RecordingReader> open_bag(const fs::path& path, const OpenOptions& options) {
  const BagSurvey survey = survey_bag(path);
  const BagLayout layout = choose_layout(survey, path.string(), options.camera_info);
  require_a_readable_frame(path, layout);
  return std::make_unique<BagReader>(path, layout);
}

}  // namespace rovigo::slam
