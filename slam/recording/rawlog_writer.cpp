#include <mrpt/obs/CObservationComment.h>

#include <stdexcept>

#include "maps/error.h"
#include "slam/recording/gz_archive.h"
#include "slam/recording/observations.h"
#include "slam/recording/pending_path.h"
#include "slam/recording/rawlog_header.h"
#include "slam/recording/recording.h"

namespace rovigo::slam {
namespace {

/// MRPT keeps how it encodes images in global flags; this sets them for one object and puts them
/// back. Colour as JPEG at quality 95 takes a tenth of the raw bytes.
class JpegEncoding {
 public:
  JpegEncoding()
      : was_disabled_(mrpt::img::CImage::DISABLE_JPEG_COMPRESSION()),
        old_quality_(mrpt::img::CImage::SERIALIZATION_JPEG_QUALITY()) {
    constexpr int kQuality = 95;
    mrpt::img::CImage::DISABLE_JPEG_COMPRESSION(false);
    mrpt::img::CImage::SERIALIZATION_JPEG_QUALITY(kQuality);
  }
  ~JpegEncoding() {
    mrpt::img::CImage::DISABLE_JPEG_COMPRESSION(was_disabled_);
    mrpt::img::CImage::SERIALIZATION_JPEG_QUALITY(old_quality_);
  }
  JpegEncoding(const JpegEncoding&) = delete;
  JpegEncoding& operator=(const JpegEncoding&) = delete;

 private:
  bool was_disabled_;
  int old_quality_;
};

class RawlogWriter final : public RecordingWriter {
 public:
  RawlogWriter(const std::filesystem::path& path, const RecordingInfo& info)
      : pending_(path), archive_(pending_.temporary()) {
    mrpt::obs::CObservationComment comment;
    // The default time of an observation is now, which would make every file another one.
    comment.timestamp = timestamp_from_seconds(0.0);
    comment.sensorLabel = "rovigo";
    comment.text = header_text(info);
    archive_.WriteObject(&comment);
  }

  void write(const mrpt::obs::CObservation& observation) override {
    if (is_finished_) throw std::logic_error("a finished recording was written to");
    const JpegEncoding encoding;
    archive_.WriteObject(&observation);
  }

  void finish() override {
    if (is_finished_) return;
    is_finished_ = true;
    archive_.close();
    pending_.commit();
  }

 private:
  PendingPath pending_;
  GzWriteArchive archive_;
  bool is_finished_ = false;
};

}  // namespace

std::unique_ptr<RecordingWriter> create_rawlog(const std::filesystem::path& path,
                                               const RecordingInfo& info) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    throw maps::InputError("cannot write " + path.string() + ": it is a folder; give a file name");
  }
  return std::make_unique<RawlogWriter>(path, info);
}

}  // namespace rovigo::slam
