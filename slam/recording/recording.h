#pragma once
// Recordings: one interface over MRPT rawlogs and TUM directories (read and written) and ROS 1 bags
// (read).

#include <mrpt/obs/CObservation.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "maps/map_file.h"
#include "slam/rig.h"

namespace rovigo::slam {

/// What a recording says about itself before its first observation is read.
struct RecordingInfo {
  std::string name;    ///< base name
  std::string format;  ///< "rawlog", "tum", "bag"
  Rig rig;
  std::optional<maps::SimulationOrigin> simulation;
  /// What each sensor's data are read from, where there was a choice (the topics of a bag).
  std::vector<std::pair<std::string, std::string>> sources;
};

struct OpenOptions {
  std::optional<std::filesystem::path> camera_info;  ///< ROS camera_info YAML that overrides
};

class RecordingReader {
 public:
  virtual ~RecordingReader() = default;
  virtual const RecordingInfo& info() const = 0;
  /// The next observation in time order, images decoded; null at the end. Throws InputError on
  /// damage, naming file and position. `progress()` is the share read so far, 0 .. 1.
  virtual mrpt::obs::CObservation::Ptr next() = 0;
  virtual double progress() const = 0;
  /// Camera frames left out so far because an image was missing or damaged. One bad frame does not
  /// lose a recording: the frame is counted here and named in `warnings()`.
  virtual int skipped() const = 0;
  /// One sentence for each thing a person should know about this recording, so far: frames left
  /// out, a file cut short. At most a few dozen; what comes after is counted in the last one.
  virtual std::vector<std::string> warnings() const = 0;
};

/// Opens a `.rawlog`, a `.bag` or a TUM directory. Throws InputError for anything missing, empty or
/// foreign.
std::unique_ptr<RecordingReader> open_recording(const std::filesystem::path& path,
                                                const OpenOptions& options = {});

class RecordingWriter {
 public:
  virtual ~RecordingWriter() = default;
  virtual void write(const mrpt::obs::CObservation& observation) = 0;
  /// Closes the files and moves them in place: a recording cut short leaves no half file behind.
  virtual void finish() = 0;
};

std::unique_ptr<RecordingWriter> create_rawlog(const std::filesystem::path& path,
                                               const RecordingInfo& info);
std::unique_ptr<RecordingWriter> create_tum_directory(const std::filesystem::path& directory,
                                                      const RecordingInfo& info);

}  // namespace rovigo::slam
