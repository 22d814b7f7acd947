#include "slam/recording/gz_archive.h"

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <system_error>

#include "maps/error.h"

namespace rovigo::slam {
namespace {

constexpr unsigned kBufferBytes = 1u << 18;
constexpr std::size_t kMostPerCall = 1u << 30;  // zlib counts in int

GzFile open_gz(const std::filesystem::path& path, const char* mode) {
  errno = 0;
  GzFile file(gzopen(path.c_str(), mode));
  if (!file) {
    throw maps::InputError("cannot open " + path.string() + ": " +
                           std::generic_category().message(errno != 0 ? errno : ENOMEM));
  }
  gzbuffer(file.get(), kBufferBytes);
  return file;
}

}  // namespace

GzReadArchive::GzReadArchive(const std::filesystem::path& path) : file_(open_gz(path, "rb")) {}

std::uint64_t GzReadArchive::bytes_read() const {
  return static_cast<std::uint64_t>(std::max<z_off_t>(gzoffset(file_.get()), 0));
}

void GzReadArchive::mark() {
  is_marked_ = true;
  since_mark_.clear();
}

void GzReadArchive::rewind() {
  again_ = since_mark_ + again_.substr(again_taken_);
  again_taken_ = 0;
  position_ -= since_mark_.size();
  forget_mark();
}

void GzReadArchive::forget_mark() {
  is_marked_ = false;
  since_mark_.clear();
}

bool GzReadArchive::at_end() {
  if (again_taken_ < again_.size()) return false;
  const int byte = gzgetc(file_.get());
  if (byte == -1) return true;
  gzungetc(byte, file_.get());
  return false;
}

bool GzReadArchive::is_cut_short() const {
  int code = Z_OK;
  gzerror(file_.get(), &code);
  return code == Z_BUF_ERROR;
}

bool GzReadArchive::is_damaged() const {
  int code = Z_OK;
  gzerror(file_.get(), &code);
  return code != Z_OK && code != Z_STREAM_END;
}

std::size_t GzReadArchive::read(void* buffer, std::size_t length) {
  auto* const bytes = static_cast<char*>(buffer);
  std::size_t done = again_.copy(bytes, length, again_taken_);
  again_taken_ += done;
  while (done < length) {
    const auto wanted = static_cast<unsigned>(std::min(length - done, kMostPerCall));
    const int got = gzread(file_.get(), bytes + done, wanted);
    if (got <= 0) throw std::runtime_error("the file ends inside an object");
    done += static_cast<std::size_t>(got);
  }
  position_ += done;
  if (is_marked_) since_mark_.append(bytes, length);
  return done;
}

std::size_t GzReadArchive::write(const void*, std::size_t) {
  throw std::logic_error("this archive only reads");
}

GzWriteArchive::GzWriteArchive(const std::filesystem::path& path)
    // Level 1: higher ones cost twice the time for 5% fewer bytes (JPEG and noisy depth).
    : path_(path), file_(open_gz(path, "wb1")) {}

void GzWriteArchive::close() {
  if (gzclose(file_.release()) != Z_OK) {
    throw maps::InputError("cannot write " + path_.string() + ": check the free space");
  }
}

std::size_t GzWriteArchive::read(void*, std::size_t) {
  throw std::logic_error("this archive only writes");
}

std::size_t GzWriteArchive::write(const void* buffer, std::size_t length) {
  const auto* const bytes = static_cast<const unsigned char*>(buffer);
  for (std::size_t done = 0; done < length;) {
    const auto wanted = static_cast<unsigned>(std::min(length - done, kMostPerCall));
    const int put = gzwrite(file_.get(), bytes + done, wanted);
    if (put <= 0) {
      throw maps::InputError("cannot write " + path_.string() + ": check the free space");
    }
    done += static_cast<std::size_t>(put);
  }
  return length;
}

}  // namespace rovigo::slam
