#include "slam/recording/text_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include "maps/atomic_file.h"
#include "maps/error.h"

namespace rovigo::slam {
namespace {

constexpr double kMaxTime_s = 1e10;  // the year 2286; far below where 100 ns ticks overflow

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

std::vector<std::string_view> cut_at_spaces(std::string_view line) {
  std::vector<std::string_view> fields;
  std::size_t i = 0;
  while (i < line.size()) {
    while (i < line.size() && is_space(line[i])) ++i;
    const std::size_t begin = i;
    while (i < line.size() && !is_space(line[i])) ++i;
    if (i > begin) fields.push_back(line.substr(begin, i - begin));
  }
  return fields;
}

}  // namespace

std::string shown_text(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string shown = "'";
  for (const char c : text.substr(0, kLongest)) shown += (c >= 0x20 && c < 0x7f) ? c : '?';
  return shown + (text.size() > kLongest ? "...'" : "'");
}

TextFile::TextFile(const std::filesystem::path& path)
    : name_(path.string()), text_(maps::read_file(path, kMaxTextBytes)) {
  cut();
}

TextFile::TextFile(std::string name, std::string text)
    : name_(std::move(name)), text_(std::move(text)) {
  cut();
}

void TextFile::cut() {
  const std::string_view all = text_;
  int number = 0;
  for (std::size_t begin = 0; begin < all.size();) {
    const std::size_t end = std::min(all.find('\n', begin), all.size());
    std::vector<std::string_view> fields = cut_at_spaces(all.substr(begin, end - begin));
    ++number;
    if (!fields.empty() && fields.front().front() != '#') {
      lines_.push_back({number, std::move(fields)});
    }
    begin = end + 1;
  }
}

double TextFile::number(const TextLine& line, std::size_t index) const {
  const std::string_view field = line.fields.at(index);
  double value = 0.0;
  const char* const end = field.data() + field.size();
  const char* const begin = field.front() == '+' ? field.data() + 1 : field.data();
  const auto [rest, error] = std::from_chars(begin, end, value);
  if (error != std::errc() || rest != end || !std::isfinite(value)) {
    fail(line,
         shown_text(field) + " in column " + std::to_string(index + 1) + " is not a finite number");
  }
  return value;
}

double TextFile::time(const TextLine& line, std::size_t index) const {
  const double value = number(line, index);
  if (value < 0.0 || value > kMaxTime_s) {
    fail(line, "the time " + shown_text(line.fields[index]) + " is outside 0 .. 1e10 seconds");
  }
  return value;
}

void TextFile::require_fields(const TextLine& line, std::size_t count,
                              std::string_view what) const {
  if (line.fields.size() != count) {
    fail(line, std::to_string(line.fields.size()) + " columns where " + std::to_string(count) +
                   " are expected (" + std::string(what) + ")");
  }
}

void TextFile::fail(const TextLine& line, const std::string& problem) const {
  throw maps::InputError(name_ + ", line " + std::to_string(line.number) + ": " + problem);
}

}  // namespace rovigo::slam
