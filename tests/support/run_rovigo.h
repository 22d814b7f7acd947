#pragma once
// Runs the program as a user does, in a process of its own.

#include <filesystem>
#include <string>
#include <vector>

namespace rovigo::test {

struct ProcessResult {
  int exit_code = -1;  ///< -1 when a signal ended it
  int signal = 0;
  std::string out;
  std::string err;
};

/// Runs `rovigo` with these arguments; stdout and stderr are captured apart.
ProcessResult run_rovigo(const std::vector<std::string>& arguments);

/// A fresh folder that is gone when the test ends.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

std::string read_text(const std::filesystem::path& file);
void write_text(const std::filesystem::path& file, const std::string& text);

/// `../shared/data` beside the checkout, or $ROVIGO_TEST_DATA.
std::filesystem::path test_data();

}  // namespace rovigo::test
