#include "slam/recording/bag_file.h"

#include <utility>

#include "maps/error.h"
#include "slam/recording/text_file.h"

namespace rovigo::slam {
namespace {

constexpr std::string_view kMagic = "#ROSBAG V";
constexpr std::string_view kVersion2 = "#ROSBAG V2.0\n";
constexpr std::uint32_t kMaxHeaderBytes = 1u << 20;
constexpr std::uint32_t kMaxDefinitionBytes = 16u << 20;

enum Op : std::uint8_t {
  kMessage = 2,
  kBagHeader = 3,
  kIndexData = 4,
  kChunk = 5,
  kChunkInfo = 6,
  kConnection = 7
};

template <class T>
T number_in(std::string_view value) {
  return ByteCursor(value).number<T>();
}

/// Calls `take(name, value)` for each `name=value`; false when the bytes are no list of them.
template <class Take>
bool for_each_field(std::string_view bytes, const Take& take) {
  ByteCursor cursor(bytes);
  while (cursor.left() > 0) {
    const std::string_view field = cursor.counted();
    const std::size_t equals = field.find('=');
    if (!cursor.ok() || equals == std::string_view::npos) return false;
    take(field.substr(0, equals), field.substr(equals + 1));
  }
  return true;
}

}  // namespace

bool BagFile::parse_header(std::string_view bytes, Header& header) {
  header = {};
  return for_each_field(bytes, [&header](std::string_view name, std::string_view value) {
    if (name == "op") header.op = number_in<std::uint8_t>(value);
    if (name == "conn") header.connection = number_in<std::uint32_t>(value);
    if (name == "size") header.size = number_in<std::uint32_t>(value);
    if (name == "time") header.time = number_in<std::uint64_t>(value);
    if (name == "index_pos") header.index_position = number_in<std::uint64_t>(value);
    if (name == "topic") header.topic = value;
    if (name == "compression") header.compression = value;
    if (name == "encryptor") header.encryptor = value;
  });
}

BagFile::BagFile(std::filesystem::path path) : path_(std::move(path)) {
  std::error_code error;
  size_ = std::filesystem::file_size(path_, error);
  file_.open(path_, std::ios::binary);
  if (error || !file_) throw maps::InputError("cannot read " + path_.string());
  if (size_ == 0) throw maps::InputError(path_.string() + ": the file is empty");
  std::string magic(kVersion2.size(), '\0');
  file_.read(magic.data(), static_cast<std::streamsize>(magic.size()));
  if (magic != kVersion2) {
    throw maps::InputError(
        path_.string() + (magic.starts_with(kMagic)
                              ? ": a ROS bag of another version than 2.0; rosbag fix mends old ones"
                              : ": not a ROS 1 bag (it does not begin with #ROSBAG V2.0)"));
  }
  position_ = kVersion2.size();
  read_bag_header();
}

void BagFile::read_bag_header() {
  std::string bytes;
  Header header;
  std::uint32_t data_bytes = 0;
  if (!read_record_start(bytes, header, data_bytes) || header.op != kBagHeader) {
    throw maps::InputError(path_.string() + ": a ROS bag cut short or damaged in its header");
  }
  if (!header.encryptor.empty()) {
    throw maps::InputError(path_.string() + ": the bag is encrypted; rosbag decrypt opens it");
  }
  position_ += data_bytes;
  const std::uint64_t first_record = position_;
  if (header.index_position > first_record && header.index_position < size_) {
    read_index(header.index_position);
  }
  if (!has_index_) {
    warnings_.add(
        path_.string() +
        " was not closed when it was recorded, or its end is missing: it has no index "
        "and is read as far as it is whole (rosbag reindex mends it for other programs).");
  }
  position_ = first_record;
  is_done_ = false;
}

void BagFile::read_index(std::uint64_t index_position) {
  std::string bytes;
  Header header;
  std::uint32_t data_bytes = 0;
  position_ = index_position;
  const WarningList without_index = warnings_;
  has_index_ = true;
  while (position_ < size_) {
    const bool is_whole = read_record_start(bytes, header, data_bytes) &&
                          (header.op == kConnection || header.op == kChunkInfo) &&
                          data_bytes <= kMaxDefinitionBytes;
    if (!is_whole) {
      has_index_ = false;
      connections_.clear();
      break;
    }
    const std::string data = read_data(data_bytes);
    if (header.op == kConnection) take_connection(header, data);
    if (header.op == kChunkInfo) take_chunk_info(data);
  }
  warnings_ = without_index;
}

bool BagFile::read_record_start(std::string& header_bytes, Header& header,
                                std::uint32_t& data_bytes) {
  const std::uint64_t start = position_;
  const auto length = number_in<std::uint32_t>(read_data(4));
  if (length > 0 && length <= kMaxHeaderBytes && size_ - position_ >= length) {
    header_bytes = read_data(length);
    const std::string data_length = read_data(4);
    data_bytes = number_in<std::uint32_t>(data_length);
    const bool is_whole = data_length.size() == 4 && data_bytes <= size_ - position_;
    if (is_whole && parse_header(header_bytes, header)) return true;
  }
  end_early("at byte " + std::to_string(start) + " it is cut short or damaged");
  return false;
}

std::string BagFile::read_data(std::uint32_t count) {
  std::string bytes(count, '\0');
  file_.clear();
  file_.seekg(static_cast<std::streamoff>(position_));
  file_.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(file_.gcount()));
  position_ += bytes.size();
  return bytes;
}

void BagFile::take_connection(const Header& header, std::string_view data) {
  BagConnection& connection = connections_[header.connection];
  connection.topic = header.topic;
  for_each_field(data, [&connection](std::string_view name, std::string_view value) {
    if (name == "type") connection.type = value;
  });
}

/// How many messages of each connection a chunk holds. The records of the connections come first.
void BagFile::take_chunk_info(std::string_view data) {
  ByteCursor cursor(data);
  while (cursor.left() > 0) {
    const auto id = cursor.number<std::uint32_t>();
    const auto count = cursor.number<std::uint32_t>();
    const auto found = connections_.find(id);
    if (found != connections_.end()) found->second.messages += count;
  }
}

bool BagFile::next(BagMessage& message) {
  while (true) {
    if (!chunk_ && !open_next_chunk()) return false;
    if (in_chunk_.left() == 0) {
      chunk_.reset();
      continue;
    }
    Header header;
    const bool is_header = parse_header(in_chunk_.counted(), header);
    const std::string_view data = in_chunk_.counted();
    if (!is_header || !in_chunk_.ok()) {
      leave_out_chunk(chunk_position_, "a record in it is damaged");
      chunk_.reset();
      continue;
    }
    if (header.op == kConnection) take_connection(header, data);
    if (header.op != kMessage || !connections_.contains(header.connection)) continue;
    message.connection = header.connection;
    message.received_ns = (header.time & 0xffffffffu) * 1000000000u + (header.time >> 32u);
    message.data = data;
    message.chunk = chunk_;
    return true;
  }
}

bool BagFile::open_next_chunk() {
  std::string bytes;
  Header header;
  std::uint32_t data_bytes = 0;
  while (!is_done_ && position_ < size_) {
    const std::uint64_t start = position_;
    if (!read_record_start(bytes, header, data_bytes)) return false;
    if (header.op == kIndexData || header.op == kChunkInfo || header.op == kConnection) {
      position_ += data_bytes;  // the index; connections stand in the chunks, too
      continue;
    }
    if (header.op != kChunk) {
      end_early("at byte " + std::to_string(start) + " it is damaged");
      return false;
    }
    if (data_bytes == 0) break;  // the chunk that was being written when recording broke off
    if (data_bytes > kMaxChunkBytes) {
      leave_out_chunk(start, "it is larger than " + std::to_string(kMaxChunkBytes >> 20) + " MB");
      position_ += data_bytes;
      continue;
    }
    ChunkBytes packed = make_chunk_bytes(data_bytes);
    file_.clear();
    file_.seekg(static_cast<std::streamoff>(position_));
    file_.read(packed.data.get(), static_cast<std::streamsize>(packed.size));
    position_ += data_bytes;
    std::string problem;
    if (static_cast<std::size_t>(file_.gcount()) != packed.size) problem = "it cannot be read";
    ChunkBytes unpacked;
    if (problem.empty()) {
      unpacked = unpack_chunk(std::move(packed), header.compression, header.size, problem);
    }
    if (problem.empty()) {
      chunk_position_ = start;
      chunk_ = std::make_shared<const ChunkBytes>(std::move(unpacked));
      in_chunk_ = ByteCursor(chunk_->view());
      return true;
    }
    leave_out_chunk(start, problem);
  }
  is_done_ = true;
  return false;
}

void BagFile::leave_out_chunk(std::uint64_t position, const std::string& problem) {
  warnings_.add(path_.string() + ": the messages of the chunk at byte " + std::to_string(position) +
                " are lost, because " + problem + ".");
}

void BagFile::end_early(const std::string& problem) {
  is_done_ = true;
  warnings_.add(path_.string() + ": " + problem + "; what comes after is left out.");
}

}  // namespace rovigo::slam
