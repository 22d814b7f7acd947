#include "app/text.h"

#include <charconv>
#include <cmath>

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
