#pragma once
// The container of a ROS 1 bag (format 2.0, wiki.ros.org/Bags/Format/2.0), read from front to back.
// Not with rosbag_storage: it dereferences the offsets it finds in a damaged bag unchecked (about
// one in 300 bags with a few wrong bytes crashes it), insists on an index, and loads Python.

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "slam/recording/bag_chunk.h"
#include "slam/recording/byte_cursor.h"
#include "slam/recording/warnings.h"

namespace rovigo::slam {

struct BagConnection {
  std::string topic;
  std::string type;            ///< e.g. sensor_msgs/Image
  std::uint64_t messages = 0;  ///< by the index; 0 when the bag has none
};

struct BagMessage {
  std::uint32_t connection = 0;
  std::uint64_t received_ns = 0;  ///< when it was recorded; images were taken before
  std::string_view data;          ///< serialised; valid while `chunk` is held
  std::shared_ptr<const ChunkBytes> chunk;
};

/// Hands out the messages in the order of the file, one chunk in memory at a time. A damaged chunk
/// is left out, a damaged file ends early; both are told in `warnings()`.
class BagFile {
 public:
  /// Throws InputError for a file that is no ROS 1 bag 2.0, or an encrypted one.
  explicit BagFile(std::filesystem::path path);

  /// False at the end.
  bool next(BagMessage& message);

  /// False for a bag that was not closed: its topics are then known only as they are met.
  bool has_index() const { return has_index_; }
  const std::map<std::uint32_t, BagConnection>& connections() const { return connections_; }
  std::uint64_t bytes_read() const { return position_; }
  std::uint64_t bytes_in_all() const { return size_; }
  const WarningList& warnings() const { return warnings_; }

 private:
  /// The fields of a record's header that are used; the rest is passed over.
  struct Header {
    std::uint8_t op = 0;
    std::uint32_t connection = 0;
    std::uint32_t size = 0;
    std::uint64_t time = 0;  ///< seconds in the low, nanoseconds in the high half
    std::uint64_t index_position = 0;
    std::string_view topic;
    std::string_view compression;
    std::string_view encryptor;
  };
  static bool parse_header(std::string_view bytes, Header& header);

  void read_bag_header();
  void read_index(std::uint64_t index_position);
  /// Header and data length of the record at `position_`; false at the end or at damage.
  bool read_record_start(std::string& header_bytes, Header& header, std::uint32_t& data_bytes);
  std::string read_data(std::uint32_t count);
  void take_connection(const Header& header, std::string_view data);
  void take_chunk_info(std::string_view data);
  /// Opens the next chunk that can be unpacked; false at the end of the file.
  bool open_next_chunk();
  void leave_out_chunk(std::uint64_t position, const std::string& problem);
  void end_early(const std::string& problem);

  std::filesystem::path path_;
  std::ifstream file_;
  std::uint64_t size_ = 0;
  std::uint64_t position_ = 0;
  bool has_index_ = false;
  bool is_done_ = false;
  std::uint64_t chunk_position_ = 0;
  std::shared_ptr<const ChunkBytes> chunk_;
  ByteCursor in_chunk_{std::string_view()};
  std::map<std::uint32_t, BagConnection> connections_;
  WarningList warnings_;
};

}  // namespace rovigo::slam
