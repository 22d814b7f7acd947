#pragma once
// The compressed blocks that a ROS 1 bag keeps its messages in.

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace rovigo::slam {

/// Larger chunks are refused. rosbag closes a chunk after 768 KB, so only one message (an image)
/// of this size could make one.
inline constexpr std::size_t kMaxChunkBytes = 256u << 20;

/// Bytes that are left as they come until something is written to them: a chunk that only claims
/// to be large costs nothing.
struct ChunkBytes {
  std::unique_ptr<char[]> data;
  std::size_t size = 0;
  std::string_view view() const { return {data.get(), size}; }
};

ChunkBytes make_chunk_bytes(std::size_t size);

/// Decompresses `packed` (`compression` is "none", "lz4" or "bz2") to exactly `size` bytes. Empty,
/// with `problem` set, on failure.
ChunkBytes unpack_chunk(ChunkBytes packed, std::string_view compression, std::size_t size,
                        std::string& problem);

}  // namespace rovigo::slam
