#include "app/signal_log.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "app/text.h"
#include "maps/atomic_file.h"
#include "maps/error.h"
#include "maps/nearest_word.h"

namespace rovigo::app {

namespace {

constexpr std::size_t kMaxBytes = std::size_t{128} << 20U;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// The columns of one signal, by their places in the header.
struct Choice {
  std::string name;
  std::size_t setpoint = 0;
  std::size_t response = 0;
};

std::string trimmed(const std::string& text) {
  const auto from = text.find_first_not_of(" \t\r\"");
  if (from == std::string::npos) return "";
  return text.substr(from, text.find_last_not_of(" \t\r\"") - from + 1);
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells = split(line, ',');
  for (auto& cell : cells) cell = trimmed(cell);
  return cells;
}

/// "Set-point [m/s]" and "setpoint_m_s" begin alike.
std::string folded(const std::string& column) {
  std::string out;
  for (const char c : column) {
    if (c >= 'A' && c <= 'Z') out += static_cast<char>(c - 'A' + 'a');
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) out += c;
  }
  return out;
}

std::string unit_of(const std::string& column) {
  if (column.ends_with("_rad_s")) return "rad/s";
  if (column.ends_with("_m_s")) return "m/s";
  if (column.ends_with("_rad")) return "rad";
  if (column.ends_with("_m")) return "m";
  return "";
}

class Header {
 public:
  Header(std::string file, std::vector<std::string> names)
      : file_(std::move(file)), names_(std::move(names)) {}

  std::size_t size() const { return names_.size(); }
  const std::string& name(std::size_t i) const { return names_[i]; }

  std::optional<std::size_t> find(const std::string& name) const {
    const auto it = std::find(names_.begin(), names_.end(), name);
    if (it == names_.end()) return std::nullopt;
    return static_cast<std::size_t>(it - names_.begin());
  }

  std::size_t time() const {
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const std::string name = folded(names_[i]);
      if (name == "t" || name == "ts" || name.starts_with("time")) return i;
    }
    fail("has no column of times (time_s or t_s)");
  }

  /// What `identify` was asked for, or what the names tell.
  std::vector<Choice> choices(const SignalColumns& wanted) const {
    if (wanted.setpoint || wanted.response) {
      if (!wanted.setpoint || !wanted.response) {
        throw maps::InputError("--setpoint and --response go together: give both columns, or none");
      }
      return {{*wanted.response, required("--setpoint", *wanted.setpoint),
               required("--response", *wanted.response)}};
    }
    std::vector<Choice> out;
    const auto add = [&](const char* name, const char* setpoint, const char* response) {
      const auto s = find(setpoint), r = find(response);
      if (s && r) out.push_back({name, *s, *r});
    };
    add("forward speed", "command_v_m_s", "true_v_m_s");
    add("turn rate", "command_w_rad_s", "true_w_rad_s");
    if (!out.empty()) return out;
    const auto s = find_beginning({"setpoint", "command", "reference"});
    const auto r = find_beginning({"response", "measured", "output"});
    if (s && r) return {{names_[*r], *s, *r}};
    if (names_.size() == 3 && time() == 0) return {{names_[2], 1, 2}};
    fail("has no columns `setpoint` and `response`; name yours with --setpoint and --response (" +
         join(names_, ", ") + ")");
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw maps::InputError(file_ + ": " + what);
  }

  std::size_t required(const std::string& option, const std::string& name) const {
    if (const auto place = find(name)) return *place;
    throw maps::InputError(option + ": " + file_ + " has no column \"" + name +
                           "\"; the nearest is \"" + maps::nearest_word(name, names_) + "\"");
  }

  std::optional<std::size_t> find_beginning(const std::vector<std::string>& starts) const {
    for (const auto& start : starts) {
      for (std::size_t i = 0; i < names_.size(); ++i) {
        if (folded(names_[i]).starts_with(start)) return i;
      }
    }
    return std::nullopt;
  }

  std::string file_;
  std::vector<std::string> names_;
};

}  // namespace

std::vector<SignalLog> read_signal_logs(const std::filesystem::path& file,
                                        const SignalColumns& columns) {
  std::istringstream in(maps::read_file(file, kMaxBytes));
  std::string line;
  int number = 0;
  const auto next_line = [&] {
    while (std::getline(in, line)) {
      ++number;
      if (!trimmed(line).empty() && line[0] != '#') return true;
    }
    return false;
  };
  if (!next_line()) {
    throw maps::InputError(file.string() +
                           ": is empty; a log begins with a header: time_s,setpoint,response");
  }
  const Header header(file.string(), cells_of(line));
  if (parse_number(header.name(0))) {
    throw maps::InputError(file.string() + " line " + std::to_string(number) + ": \"" + line +
                           "\" is no header; name the columns: time_s,setpoint,response");
  }
  const std::size_t time = header.time();
  std::vector<SignalLog> logs;
  const std::vector<Choice> choices = header.choices(columns);
  for (const Choice& c : choices) {
    logs.push_back({c.name,
                    header.name(c.setpoint),
                    header.name(c.response),
                    unit_of(header.name(c.response)),
                    {}});
  }
  double last_time = -std::numeric_limits<double>::infinity();
  while (next_line()) {
    const auto cells = cells_of(line);
    const auto fail = [&](const std::string& what) -> void {
      throw maps::InputError(file.string() + " line " + std::to_string(number) + ": " + what);
    };
    if (cells.size() != header.size()) {
      fail(std::to_string(cells.size()) + " values in place of " + std::to_string(header.size()));
    }
    const auto number_at = [&](std::size_t i, double when_empty) {
      if (cells[i].empty() || folded(cells[i]) == "nan") return when_empty;
      const auto value = parse_number(cells[i]);
      if (!value) fail(header.name(i) + " = \"" + cells[i] + "\" is not a finite number");
      return *value;
    };
    const double t = number_at(time, kNone);
    if (!(t >= last_time)) fail(header.name(time) + " = " + cells[time] + " goes back in time");
    last_time = t;
    for (std::size_t i = 0; i < choices.size(); ++i) {
      auto& samples = logs[i].samples;
      const double held = samples.empty() ? 0.0 : samples.back().setpoint;
      samples.push_back(
          {t, number_at(choices[i].setpoint, held), number_at(choices[i].response, kNone)});
    }
  }
  return logs;
}

}  // namespace rovigo::app
