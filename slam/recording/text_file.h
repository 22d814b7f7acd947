#pragma once
// Text files of numbers (TUM lists and trajectories), read strictly: every complaint names file and
// line.

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace rovigo::slam {

/// Larger text files than this are refused: an hour of IMU at 100 Hz is 30 MB.
inline constexpr std::size_t kMaxTextBytes = 512u << 20;

/// Text from a file as it may stand in a message: in quotes, short, and without bytes that upset a
/// terminal.
std::string shown_text(std::string_view text);

/// A line cut at white space; comments (`#`) and empty lines are not handed out.
struct TextLine {
  int number = 0;  ///< from 1
  std::vector<std::string_view> fields;
};

/// A text file cut into lines. The views in the lines live as long as this object.
class TextFile {
 public:
  /// Throws InputError when the file cannot be read.
  explicit TextFile(const std::filesystem::path& path);
  /// The same for text already in memory; `name` is used in messages.
  TextFile(std::string name, std::string text);
  TextFile(const TextFile&) = delete;
  TextFile& operator=(const TextFile&) = delete;

  const std::vector<TextLine>& lines() const { return lines_; }

  /// Field `index` as a finite number. Throws InputError naming file, line and value.
  double number(const TextLine& line, std::size_t index) const;
  /// Field `index` as a time stamp in seconds: finite, 0 .. 1e10. Throws like `number`.
  double time(const TextLine& line, std::size_t index) const;
  /// Throws InputError unless the line has exactly `count` fields; `what` names them.
  void require_fields(const TextLine& line, std::size_t count, std::string_view what) const;
  /// Throws an InputError that begins with file and line.
  [[noreturn]] void fail(const TextLine& line, const std::string& problem) const;

 private:
  void cut();

  std::string name_;
  std::string text_;
  std::vector<TextLine> lines_;
};

}  // namespace rovigo::slam
