#pragma once
// MRPT's serialisation over zlib: rawlogs are gz streams (or plain ones) of serialised objects.

#include <mrpt/serialization/CArchive.h>
#include <zlib.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace rovigo::slam {

struct GzClose {
  void operator()(gzFile file) const { gzclose(file); }
};
using GzFile = std::unique_ptr<gzFile_s, GzClose>;

/// Reads a gz or plain file. A read that cannot be filled throws, so that no object is ever built
/// from what was not there.
class GzReadArchive final : public mrpt::serialization::CArchive {
 public:
  /// Throws InputError when the file cannot be opened.
  explicit GzReadArchive(const std::filesystem::path& path);

  /// Bytes taken from the file so far, compressed; for progress.
  std::uint64_t bytes_read() const;
  /// Bytes handed out so far, uncompressed.
  std::uint64_t position() const { return position_; }
  /// Remembers this place; `rewind` goes back to it. One place at a time.
  void mark();
  void rewind();
  void forget_mark();
  /// True when nothing is left to read at a place where an object could begin.
  bool at_end();
  /// The compressed stream stops before its end.
  bool is_cut_short() const;
  /// It stops, does not decompress, or fails its checksum.
  bool is_damaged() const;

 private:
  std::size_t read(void* buffer, std::size_t length) override;
  std::size_t write(const void* buffer, std::size_t length) override;

  GzFile file_;
  std::uint64_t position_ = 0;
  bool is_marked_ = false;
  std::string since_mark_;       ///< what was read since `mark`
  std::string again_;            ///< what `rewind` gave back
  std::size_t again_taken_ = 0;  ///< how much of it was read again
};

/// Writes a gz file whose bytes depend on the content alone (no name, no time in the header).
class GzWriteArchive final : public mrpt::serialization::CArchive {
 public:
  explicit GzWriteArchive(const std::filesystem::path& path);
  /// Throws InputError when the last bytes cannot be written.
  void close();

 private:
  std::size_t read(void* buffer, std::size_t length) override;
  std::size_t write(const void* buffer, std::size_t length) override;

  std::filesystem::path path_;
  GzFile file_;
};

}  // namespace rovigo::slam
