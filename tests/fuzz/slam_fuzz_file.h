#pragma once
// The fuzzer's bytes as a file, for readers that take a path. In memory (/dev/shm) where there is.

#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

inline std::filesystem::path fuzz_file(const std::string& ending, const std::uint8_t* data,
                                       std::size_t size) {
  const std::filesystem::path shared = "/dev/shm";
  const std::filesystem::path folder =
      std::filesystem::exists(shared) ? shared : std::filesystem::temp_directory_path();
  const auto path = folder / ("rovigo_fuzz_" + std::to_string(::getpid()) + ending);
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  return path;
}
