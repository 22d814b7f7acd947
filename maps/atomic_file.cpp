#include "maps/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <system_error>
#include <utility>

#include "maps/error.h"

namespace rovigo::maps {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_to_write(const fs::path& path, int error) {
  throw InputError("cannot write " + path.string() + ": " + std::generic_category().message(error) +
                   "; check the folder, its permissions and the free space");
}

/// Closes on scope exit; close() reports its error, which counts when writing.
class FileDescriptor {
 public:
  explicit FileDescriptor(int fd) : fd_(fd) {}
  ~FileDescriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  int get() const { return fd_; }
  bool is_open() const { return fd_ >= 0; }
  bool close() { return ::close(std::exchange(fd_, -1)) == 0; }

 private:
  int fd_;
};

/// The hidden file beside the target, removed on scope exit unless it was renamed.
class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& target) : target_(target), fd_(create(target, path_)) {
    struct stat old = {};
    if (::stat(target.c_str(), &old) == 0) (void)::fchmod(fd_.get(), old.st_mode & 07777);
  }
  ~TemporaryFile() {
    if (!path_.empty()) ::unlink(path_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  int fd() const { return fd_.get(); }
  const fs::path& path() const { return path_; }

  void commit() {
    if (::fsync(fd_.get()) != 0 || !fd_.close()) fail_to_write(target_, errno);
    if (::rename(path_.c_str(), target_.c_str()) != 0) fail_to_write(target_, errno);
    path_.clear();
    sync_folder();
  }

 private:
  /// O_EXCL with a counted name rather than mkstemp, so that the umask decides the permissions.
  static int create(const fs::path& target, fs::path& path) {
    std::string stem = target.filename().string() + "." + std::to_string(::getpid()) + "-";
    stem.insert(stem.begin(), '.');
    for (int attempt = 0; attempt < 1000; ++attempt) {
      path = target.parent_path() / (stem + std::to_string(attempt));
      const int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (fd >= 0) return fd;
      if (errno != EEXIST) break;
    }
    const int error = errno;
    path.clear();
    fail_to_write(target, error);
  }

  /// Without it a power cut may bring the old folder entry back (not an error: the old file is
  /// whole too). File systems that cannot sync folders answer EINVAL.
  void sync_folder() const {
    const fs::path folder = target_.parent_path().empty() ? "." : target_.parent_path();
    const FileDescriptor dir(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (dir.is_open() && ::fsync(dir.get()) != 0 && errno == EIO) fail_to_write(target_, errno);
  }

  fs::path target_;
  fs::path path_;
  FileDescriptor fd_;
};

void write_all(int fd, std::string_view bytes, const fs::path& path) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) fail_to_write(path, n < 0 ? errno : ENOSPC);
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

/// Where a rename must go so that a symbolic link keeps pointing at the file.
fs::path resolve_links(const fs::path& path) {
  std::error_code error;
  if (!fs::is_symlink(path, error)) return path;
  const fs::path target = fs::weakly_canonical(path, error);
  return error ? path : target;
}

enum class TargetKind { kRegularOrNew, kFolder, kSpecial };

TargetKind kind_of(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) return TargetKind::kFolder;
  const bool special = fs::exists(status) && !fs::is_regular_file(status);
  return special ? TargetKind::kSpecial : TargetKind::kRegularOrNew;
}

}  // namespace

void write_file_atomically(const fs::path& path, std::string_view bytes) {
  const TargetKind kind = kind_of(path);
  if (kind == TargetKind::kFolder || path.filename().empty()) fail_to_write(path, EISDIR);
  if (kind == TargetKind::kSpecial) {
    const FileDescriptor fd(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
    if (!fd.is_open()) fail_to_write(path, errno);
    return write_all(fd.get(), bytes, path);
  }
  TemporaryFile file(resolve_links(path));
  write_all(file.fd(), bytes, path);
  file.commit();
}

void write_file_atomically(const fs::path& path,
                           const std::function<void(const fs::path&)>& write) {
  const TargetKind kind = kind_of(path);
  if (kind == TargetKind::kFolder || path.filename().empty()) fail_to_write(path, EISDIR);
  if (kind == TargetKind::kSpecial) {
    throw InputError("cannot write " + path.string() +
                     ": it is no ordinary file; give the name of a file");
  }
  TemporaryFile file(resolve_links(path));
  write(file.path());
  file.commit();
}

std::string read_file(const fs::path& path, std::size_t max_bytes) {
  const auto fail = [&](const std::string& why) {
    throw InputError("cannot read " + path.string() + ": " + why);
  };
  const FileDescriptor fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!fd.is_open()) fail(std::generic_category().message(errno));
  struct stat info = {};
  if (::fstat(fd.get(), &info) != 0) fail(std::generic_category().message(errno));
  if (S_ISDIR(info.st_mode)) fail("it is a folder; give a file");
  const auto too_large = [&] { fail("it is larger than " + std::to_string(max_bytes) + " bytes"); };
  if (info.st_size > 0 && static_cast<std::uintmax_t>(info.st_size) > max_bytes) too_large();
  std::string bytes;
  bytes.reserve(static_cast<std::size_t>(info.st_size));
  char buffer[1 << 16];
  for (;;) {
    const ssize_t n = ::read(fd.get(), buffer, sizeof buffer);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(std::generic_category().message(errno));
    if (n == 0) return bytes;
    if (bytes.size() + static_cast<std::size_t>(n) > max_bytes) too_large();
    bytes.append(buffer, static_cast<std::size_t>(n));
  }
}

}  // namespace rovigo::maps
