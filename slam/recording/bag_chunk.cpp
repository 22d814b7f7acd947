#include "slam/recording/bag_chunk.h"

#include <bzlib.h>
#include <lz4frame.h>

#include <utility>

#include "slam/recording/text_file.h"

namespace rovigo::slam {
namespace {

/// roslz4 writes standard LZ4 frames.
bool unpack_lz4(std::string_view packed, ChunkBytes& out) {
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) != 0) return false;
  std::size_t read = 0;
  std::size_t written = 0;
  std::size_t wanted = 1;  // zero once the frame is complete
  while (wanted != 0) {
    std::size_t read_now = packed.size() - read;
    std::size_t written_now = out.size - written;
    wanted = LZ4F_decompress(context, out.data.get() + written, &written_now, packed.data() + read,
                             &read_now, nullptr);
    if (LZ4F_isError(wanted) != 0) break;
    if (read_now == 0 && written_now == 0) break;  // no progress: one side is exhausted
    read += read_now;
    written += written_now;
  }
  LZ4F_freeDecompressionContext(context);
  return wanted == 0 && written == out.size;
}

bool unpack_bz2(std::string_view packed, ChunkBytes& out) {
  auto written = static_cast<unsigned int>(out.size);
  const int status =
      BZ2_bzBuffToBuffDecompress(out.data.get(), &written, const_cast<char*>(packed.data()),
                                 static_cast<unsigned int>(packed.size()), 0, 0);
  return status == BZ_OK && written == out.size;
}

}  // namespace

ChunkBytes make_chunk_bytes(std::size_t size) {
  return {std::make_unique_for_overwrite<char[]>(size), size};
}

ChunkBytes unpack_chunk(ChunkBytes packed, std::string_view compression, std::size_t size,
                        std::string& problem) {
  if (size > kMaxChunkBytes) {
    problem = "it claims to unpack to " + std::to_string(size >> 20) + " MB, more than " +
              std::to_string(kMaxChunkBytes >> 20);
    return {};
  }
  if (compression == "none") {
    if (packed.size == size) return packed;
    problem = "its two sizes differ";
    return {};
  }
  const bool is_lz4 = compression == "lz4";
  if (!is_lz4 && compression != "bz2") {
    problem = "its compression " + shown_text(compression) + " is none of none, lz4 and bz2";
    return {};
  }
  ChunkBytes out = make_chunk_bytes(size);
  if (is_lz4 ? unpack_lz4(packed.view(), out) : unpack_bz2(packed.view(), out)) return out;
  problem = "its " + std::string(compression) + " data are damaged";
  return {};
}

}  // namespace rovigo::slam
