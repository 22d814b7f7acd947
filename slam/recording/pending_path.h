#pragma once
// Output that grows under a temporary name and appears under its own only when it is whole.

#include <filesystem>

namespace rovigo::slam {

/// A hidden sibling of `target` (`.NAME.part`), removed on destruction unless committed.
class PendingPath {
 public:
  /// Throws InputError when the folder that shall hold `target` does not exist.
  explicit PendingPath(const std::filesystem::path& target);
  ~PendingPath();
  PendingPath(const PendingPath&) = delete;
  PendingPath& operator=(const PendingPath&) = delete;

  const std::filesystem::path& target() const { return target_; }
  const std::filesystem::path& temporary() const { return temporary_; }

  /// Syncs and renames. A file at the target is replaced; a folder there is swapped for the new
  /// one and removed. Throws InputError.
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;
  bool is_committed_ = false;
};

}  // namespace rovigo::slam
