#include "maps/movingai.h"

#include <charconv>
#include <cmath>
#include <optional>

#include "maps/atomic_file.h"
#include "maps/error.h"

namespace rovigo::maps {
namespace {

constexpr std::size_t kMaxFileBytes = std::size_t{1} << 30;

/// Hands out lines without their ends (LF or CR LF) and counts them.
class Lines {
 public:
  Lines(std::string_view text, const std::string& name) : rest_(text), name_(name) {}

  std::optional<std::string_view> next() {
    if (rest_.empty()) return std::nullopt;
    ++number_;
    const std::size_t end = rest_.find('\n');
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return line;
  }
  [[noreturn]] void fail(const std::string& why) const {
    throw InputError(name_ + " line " + std::to_string(number_) + ": " + why);
  }

 private:
  std::string_view rest_;
  const std::string& name_;
  int number_ = 0;
};

/// Fields parted by tabs where the line has any (names may then hold spaces), else by blanks.
std::vector<std::string_view> split(std::string_view line) {
  const std::string_view separators = line.find('\t') != std::string_view::npos ? "\t" : " ";
  std::vector<std::string_view> fields;
  while (!line.empty()) {
    const std::size_t begin = line.find_first_not_of(separators);
    if (begin == std::string_view::npos) break;
    line.remove_prefix(begin);
    const std::size_t end = std::min(line.find_first_of(separators), line.size());
    fields.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
  return fields;
}

template <class Number>
std::optional<Number> parse(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::string quoted(std::string_view text) {
  std::string quotation(1, '"');
  quotation += text.substr(0, 40);
  quotation += text.size() > 40 ? "...\"" : "\"";
  return quotation;
}

int side(const Lines& lines, std::string_view key, std::string_view text) {
  const auto value = parse<int>(text);
  if (!value || *value < 1 || *value > kMaxGridSide) {
    lines.fail(std::string(key) + " = " + quoted(text) + " is no whole number in 1 .. " +
               std::to_string(kMaxGridSide));
  }
  return *value;
}

/// `type`, `height`, `width` in any order, up to the line `map`.
GridGeometry read_header(Lines& lines) {
  GridGeometry geometry{1.0, {0.0, 0.0}, 0, 0};
  while (const auto line = lines.next()) {
    const auto words = split(*line);
    if (words.empty()) continue;
    if (words[0] == "map") {
      if (geometry.width == 0 || geometry.height == 0) {
        lines.fail("the rows begin before width and height are given");
      }
      if (geometry.size() > kMaxGridCells) {
        lines.fail("the map claims " + std::to_string(geometry.size()) + " cells; at most " +
                   std::to_string(kMaxGridCells) + " can be used");
      }
      return geometry;
    }
    if (words.size() == 2 && words[0] == "height") {
      geometry.height = side(lines, words[0], words[1]);
    } else if (words.size() == 2 && words[0] == "width") {
      geometry.width = side(lines, words[0], words[1]);
    } else if (words[0] != "type") {
      lines.fail(quoted(*line) + " is none of type, height, width, map: this is no MovingAI map");
    }
  }
  lines.fail("the file ends before the line `map`: this is no MovingAI map");
}

}  // namespace

OccupancyGrid parse_movingai_map(std::string_view text, const std::string& name) {
  Lines lines(text, name);
  const GridGeometry geometry = read_header(lines);
  // A file cannot be smaller than its cells: check before taking the memory.
  if (text.size() < geometry.size()) {
    lines.fail("the file is cut off: " + std::to_string(geometry.width) + " x " +
               std::to_string(geometry.height) + " cells do not fit into " +
               std::to_string(text.size()) + " bytes");
  }
  OccupancyGrid grid(geometry, OccupancyGrid::kOccupied);
  for (int row = 0; row < geometry.height; ++row) {
    const auto line = lines.next();
    if (!line) lines.fail("the file ends after " + std::to_string(row) + " of its rows");
    if (line->size() != static_cast<std::size_t>(geometry.width)) {
      lines.fail("the row has " + std::to_string(line->size()) + " cells instead of " +
                 std::to_string(geometry.width));
    }
    for (int x = 0; x < geometry.width; ++x) {
      const char c = (*line)[static_cast<std::size_t>(x)];
      if (c == '.' || c == 'G') grid.at({x, geometry.height - 1 - row}) = OccupancyGrid::kFree;
    }
  }
  return grid;
}

OccupancyGrid load_movingai_map(const std::filesystem::path& path) {
  return parse_movingai_map(read_file(path, kMaxFileBytes), path.string());
}

std::vector<MovingAiProblem> parse_movingai_scenario(std::string_view text,
                                                     const std::string& name) {
  Lines lines(text, name);
  std::vector<MovingAiProblem> problems;
  const auto first = lines.next();
  if (!first || first->substr(0, 7) != "version") {
    throw InputError(name + ": is no MovingAI scenario; its first line must say `version 1`");
  }
  while (const auto line = lines.next()) {
    const auto fields = split(*line);
    if (fields.empty()) continue;
    if (fields.size() != 9) {
      lines.fail(std::to_string(fields.size()) +
                 " columns instead of 9 (bucket, map, width, height, start x, start y, goal x, "
                 "goal y, optimal length)");
    }
    const auto whole = [&](std::size_t i) {
      const auto value = parse<int>(fields[i]);
      if (!value || *value < 0 || *value > 1 << 24) {
        lines.fail("column " + std::to_string(i + 1) + ", " + quoted(fields[i]) +
                   ", is no whole number in range");
      }
      return *value;
    };
    const auto length = parse<double>(fields[8]);
    if (!length || !std::isfinite(*length) || *length < 0.0) {
      lines.fail("column 9, " + quoted(fields[8]) + ", is no length");
    }
    MovingAiProblem problem;
    problem.bucket = whole(0);
    problem.map = fields[1];
    problem.map_width = whole(2);
    problem.map_height = whole(3);
    problem.start_in_file = {whole(4), whole(5)};
    problem.goal_in_file = {whole(6), whole(7)};
    problem.optimal_length = *length;
    problems.push_back(std::move(problem));
  }
  return problems;
}

std::vector<MovingAiProblem> load_movingai_scenario(const std::filesystem::path& path) {
  return parse_movingai_scenario(read_file(path, kMaxFileBytes), path.string());
}

}  // namespace rovigo::maps
