#include "slam/recording/pending_path.h"

#include <fcntl.h>
#include <unistd.h>

#include <string>
#include <system_error>
#include <utility>

#include "maps/error.h"

namespace rovigo::slam {
namespace {

namespace fs = std::filesystem;

fs::path without_trailing_slash(const fs::path& path) {
  return path.has_filename() ? path : path.parent_path();
}

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

fs::path hidden_sibling(const fs::path& path, const char* ending) {
  std::string name(1, '.');
  name += path.filename().string();
  name += ending;
  return path.parent_path() / name;
}

/// Best effort: some file systems refuse to sync folders.
void sync_to_disk(const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

/// A folder's thousands of images are synced in one call for their file system; one call for each
/// would take longer than writing them.
void sync_content(const fs::path& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) {
    sync_to_disk(path);
    return;
  }
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::syncfs(descriptor);
  ::close(descriptor);
}

}  // namespace

PendingPath::PendingPath(const fs::path& target)
    : target_(without_trailing_slash(target)), temporary_(hidden_sibling(target_, ".part")) {
  std::error_code error;
  if (target_.filename().empty() || !fs::is_directory(folder_of(target_), error)) {
    throw maps::InputError("cannot write " + target_.string() +
                           ": its folder does not exist; make it first");
  }
  fs::remove_all(temporary_, error);  // left by a run that was killed
}

PendingPath::~PendingPath() {
  std::error_code ignored;
  if (!is_committed_) fs::remove_all(temporary_, ignored);
}

void PendingPath::commit() {
  sync_content(temporary_);
  std::error_code error;
  const fs::path old = hidden_sibling(target_, ".old");
  const bool replaces_folder = fs::is_directory(target_, error);
  if (replaces_folder) {
    fs::remove_all(old, error);
    fs::rename(target_, old, error);
  }
  fs::rename(temporary_, target_, error);
  if (error) {
    if (replaces_folder) {
      std::error_code ignored;
      fs::rename(old, target_, ignored);
    }
    throw maps::InputError("cannot write " + target_.string() + ": " + error.message());
  }
  is_committed_ = true;
  if (replaces_folder) fs::remove_all(old, error);
  sync_to_disk(folder_of(target_));
}

}  // namespace rovigo::slam
