#pragma once
// Files that are either the old ones or the new ones, whole, whatever interrupts the writing.

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace rovigo::maps {

/// Writes `bytes` to a hidden file beside `path`, syncs it, renames it onto `path` and syncs the
/// folder. Until the rename the old file stands untouched; a failed write leaves no trace. An
/// existing file keeps its permissions, a symbolic link stays a link, and what is no regular file
/// (/dev/stdout, a pipe) is simply written to.
/// Throws InputError naming the file and the reason (no space, no permission, no such folder).
void write_file_atomically(const std::filesystem::path& path, std::string_view bytes);

/// The same for writers that insist on a file name of their own (SQLite, OctoMap, MRPT): `write`
/// is handed the name of an empty file beside `path` and fills it; what it throws passes through,
/// with the old file untouched and the new one removed.
/// Throws InputError as write_file_atomically does, also where `path` is no regular file.
void write_file_atomically(const std::filesystem::path& path,
                           const std::function<void(const std::filesystem::path&)>& write);

/// The bytes of a regular file. Throws InputError when it cannot be read or holds more than
/// `max_bytes`.
std::string read_file(const std::filesystem::path& path, std::size_t max_bytes);

}  // namespace rovigo::maps
