#include "maps/error.h"
#include "slam/recording/recording.h"
#include "slam/recording/tum_reader.h"

namespace rovigo::slam {

std::unique_ptr<RecordingReader> open_recording(const std::filesystem::path& path,
                                                const OpenOptions& options) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    throw maps::InputError(path.string() + ": there is no such file or folder");
  }
  if (std::filesystem::is_directory(path, error)) return open_tum_directory(path, options);
  throw maps::InputError(path.string() +
                         ": not a recording; a .rawlog file or a TUM directory is expected");
}

}  // namespace rovigo::slam
