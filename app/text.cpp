#include "app/text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include "maps/error.h"

namespace rovigo::app {

std::optional<double> parse_number(const std::string& text) {
  const char* begin = text.data();
  const char* end = begin + text.size();
  if (begin != end && *begin == '+') ++begin;  // from_chars knows no leading plus
  double value = 0.0;
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error != std::errc{} || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

PoseArgument parse_pose(const std::string& option, const std::string& text) {
  const auto parts = split(text, ',');
  std::vector<double> numbers;
  for (const auto& part : parts) {
    const auto number = parse_number(part);
    if (!number) break;
    numbers.push_back(*number);
  }
  if (numbers.size() != parts.size() || numbers.size() < 2 || numbers.size() > 3) {
    throw maps::InputError(option + " " + text +
                           ": must be X,Y or X,Y,YAW in metres and radians, e.g. 2.5,-1.0,1.57");
  }
  PoseArgument out;
  out.pose = {numbers[0], numbers[1], numbers.size() == 3 ? maps::wrap_angle(numbers[2]) : 0.0};
  out.has_heading = numbers.size() == 3;
  return out;
}

TPoint2D parse_point(const std::string& option, const std::string& text) {
  const PoseArgument parsed = parse_pose(option, text);
  if (parsed.has_heading) {
    throw maps::InputError(option + " " + text +
                           ": must be X,Y in metres; a heading has no use here");
  }
  return maps::position_of(parsed.pose);
}

namespace {

/// Levenshtein distance, one row at a time.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

}  // namespace

std::string nearest_word(const std::string& word, const std::vector<std::string>& candidates) {
  const auto nearest =
      std::min_element(candidates.begin(), candidates.end(), [&](const auto& a, const auto& b) {
        return edit_distance(word, a) < edit_distance(word, b);
      });
  return nearest == candidates.end() ? std::string{} : *nearest;
}

std::string join(const std::vector<std::string>& parts, const std::string& separator) {
  std::string out;
  for (std::size_t i = 0; i < parts.size(); ++i) out += (i ? separator : "") + parts[i];
  return out;
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t end; (end = text.find(separator, begin)) != std::string::npos; begin = end + 1) {
    parts.push_back(text.substr(begin, end - begin));
  }
  parts.push_back(text.substr(begin));
  return parts;
}

}  // namespace rovigo::app
