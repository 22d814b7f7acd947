#include <algorithm>
#include <cctype>
#include <utility>

#include "maps/error.h"
#include "slam/recording/bag_reader.h"
#include "slam/recording/rawlog_reader.h"
#include "slam/recording/recording.h"
#include "slam/recording/rig_check.h"
#include "slam/recording/tum_reader.h"

namespace rovigo::slam {
namespace {

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

/// A reader whose first seconds are compared with what it says of its sensors.
class CheckedReader final : public RecordingReader {
 public:
  explicit CheckedReader(std::unique_ptr<RecordingReader> reader)
      : reader_(std::move(reader)), check_(reader_->info().rig) {}

  const RecordingInfo& info() const override { return reader_->info(); }
  mrpt::obs::CObservation::Ptr next() override {
    auto observation = reader_->next();
    if (observation) check_.add(*observation);
    return observation;
  }
  double progress() const override { return reader_->progress(); }
  int skipped() const override { return reader_->skipped(); }
  std::vector<std::string> warnings() const override {
    std::vector<std::string> all = check_.warnings();
    for (std::string& sentence : reader_->warnings()) all.push_back(std::move(sentence));
    return all;
  }

 private:
  std::unique_ptr<RecordingReader> reader_;
  RigCheck check_;
};

std::unique_ptr<RecordingReader> open_by_kind(const std::filesystem::path& path,
                                              const OpenOptions& options) {
  if (std::filesystem::is_directory(path)) return open_tum_directory(path, options);
  if (lower_extension(path) == ".bag") return open_bag(path, options);
  return open_rawlog(path, options);
}

}  // namespace

std::unique_ptr<RecordingReader> open_recording(const std::filesystem::path& path,
                                                const OpenOptions& options) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    throw maps::InputError(path.string() + ": there is no such file or folder");
  }
  if (!std::filesystem::is_directory(path, error) &&
      !std::filesystem::is_regular_file(path, error)) {
    throw maps::InputError(
        path.string() + ": neither a file nor a folder; give a .rawlog, a .bag or a TUM directory");
  }
  return std::make_unique<CheckedReader>(open_by_kind(path, options));
}

}  // namespace rovigo::slam
