#include <algorithm>
#include <cctype>

#include "maps/error.h"
#include "slam/recording/bag_reader.h"
#include "slam/recording/rawlog_reader.h"
#include "slam/recording/recording.h"
#include "slam/recording/tum_reader.h"

namespace rovigo::slam {
namespace {

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace

std::unique_ptr<RecordingReader> open_recording(const std::filesystem::path& path,
                                                const OpenOptions& options) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    throw maps::InputError(path.string() + ": there is no such file or folder");
  }
  if (std::filesystem::is_directory(path, error)) return open_tum_directory(path, options);
  if (!std::filesystem::is_regular_file(path, error)) {
    throw maps::InputError(
        path.string() + ": neither a file nor a folder; give a .rawlog, a .bag or a TUM directory");
  }
  if (lower_extension(path) == ".bag") return open_bag(path, options);
  return open_rawlog(path, options);
}

}  // namespace rovigo::slam
