#include "app/config.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <sstream>

#include "app/text.h"
#include "maps/error.h"
#include "maps/nearest_word.h"

namespace rovigo::app {

namespace {

using maps::InputError;
using maps::SettingInfo;

/// A value somebody wrote, and where.
struct Assignment {
  std::string value;
  std::string where;  ///< "rovigo.yaml line 3" or "--set robot.max_speed_m_s=9"
  bool used = false;
};
using Assignments = std::map<std::string, Assignment>;  // by "section.name"

void visit_sections(RovigoConfig& config,
                    const std::function<maps::SettingsVisitor&(const std::string&)>& enter) {
  config.robot.describe(enter("robot"));
  config.inflation.describe(enter("inflation"));
  config.slam.describe(enter("slam"));
  config.planning.describe(enter("planning"));
  config.control.describe(enter("control"));
  config.docking.describe(enter("docking"));
}

/// Gives every setting the value that was assigned to it, noting what does not fit.
class Assigner final : public maps::SettingsVisitor {
 public:
  explicit Assigner(Assignments& assignments) : assignments_(assignments) {}

  Assigner& enter(const std::string& section) {
    section_ = section;
    return *this;
  }
  void real(const SettingInfo& info, double& value) override {
    take(info, [&](const std::string& text) {
      const auto parsed = parse_number(text);
      if (!parsed) return info.name + " = \"" + text + "\" is not a number";
      value = *parsed;
      return maps::range_problem(info, value);
    });
  }
  void integer(const SettingInfo& info, int& value) override {
    take(info, [&](const std::string& text) {
      const auto parsed = parse_number(text);
      if (!parsed || *parsed != std::floor(*parsed)) {
        return info.name + " = \"" + text + "\" is not a whole number";
      }
      const std::string problem = maps::range_problem(info, *parsed);
      if (problem.empty() && std::abs(*parsed) < 2e9) value = static_cast<int>(*parsed);
      return problem;
    });
  }
  void flag(const SettingInfo& info, bool& value) override {
    take(info, [&](const std::string& text) -> std::string {
      if (text != "true" && text != "false") {
        return info.name + " = \"" + text + "\" is neither true nor false";
      }
      value = text == "true";
      return {};
    });
  }
  void text(const SettingInfo& info, std::string& value) override {
    take(info, [&](const std::string& written) {
      value = written;
      return maps::choice_problem(info, value);
    });
  }

  const std::vector<std::string>& keys() const { return keys_; }
  const std::vector<std::string>& problems() const { return problems_; }

 private:
  void take(const SettingInfo& info, const std::function<std::string(const std::string&)>& assign) {
    const std::string key = section_ + "." + info.name;
    keys_.push_back(key);
    const auto found = assignments_.find(key);
    if (found == assignments_.end()) return;
    found->second.used = true;
    const std::string problem = assign(found->second.value);
    if (!problem.empty())
      problems_.push_back(found->second.where + ": " + section_ + "." + problem);
  }

  Assignments& assignments_;
  std::string section_;
  std::vector<std::string> keys_;
  std::vector<std::string> problems_;
};

void read_section(const std::filesystem::path& file, const std::string& section,
                  const YAML::Node& node, Assignments& out) {
  for (const auto& item : node) {
    const std::string where = file.string() + " line " + std::to_string(item.first.Mark().line + 1);
    if (!item.first.IsScalar() || !item.second.IsScalar()) {
      throw InputError(where + ": a setting must be written as `key: value` inside its section");
    }
    const std::string key = section + "." + item.first.Scalar();
    if (out.count(key)) throw InputError(where + ": " + key + " is set twice; keep one of the two");
    out[key] = {item.second.Scalar(), where};
  }
}

void read_file(const std::filesystem::path& file, Assignments& out) {
  const YAML::Node root = [&] {
    try {
      return YAML::LoadFile(file.string());
    } catch (const YAML::BadFile&) {
      throw InputError(file.string() + ": cannot be opened; check the path given to --config");
    } catch (const YAML::Exception& e) {
      throw InputError(file.string() + " line " + std::to_string(e.mark.line + 1) +
                       ": not valid YAML (" + e.msg + ")");
    }
  }();
  if (root.IsNull()) return;
  if (!root.IsMap()) {
    throw InputError(file.string() +
                     ": must be a map of sections, e.g. `robot:` with settings below it");
  }
  for (const auto& section : root) {
    const std::string where =
        file.string() + " line " + std::to_string(section.first.Mark().line + 1);
    if (!section.first.IsScalar()) throw InputError(where + ": a section's name must be a word");
    if (section.second.IsNull()) continue;
    if (!section.second.IsMap()) {
      throw InputError(where + ": \"" + section.first.Scalar() +
                       "\" must be a section with settings below it; `rovigo config` lists them");
    }
    read_section(file, section.first.Scalar(), section.second, out);
  }
}

void read_assignments(const std::vector<std::string>& assignments, Assignments& out) {
  for (const std::string& text : assignments) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw InputError("--set " + text + ": must be KEY=VALUE, e.g. robot.max_speed_m_s=0.3");
    }
    out[text.substr(0, equals)] = {text.substr(equals + 1), "--set " + text};  // the last one wins
  }
}

class Lister final : public maps::SettingsVisitor {
 public:
  Lister& enter(const std::string& section) {
    section_ = section;
    return *this;
  }
  void real(const SettingInfo& info, double& value) override {
    add(info, "real", format(value), true);
  }
  void integer(const SettingInfo& info, int& value) override {
    add(info, "integer", std::to_string(value), true);
  }
  void flag(const SettingInfo& info, bool& value) override {
    add(info, "true/false", value ? "true" : "false", false);
  }
  void text(const SettingInfo& info, std::string& value) override {
    add(info, "text", value, false);
  }
  std::vector<SettingRow> rows;

 private:
  static std::string format(double v) {
    std::ostringstream s;
    s << v;
    return s.str();
  }
  void add(const SettingInfo& info, const std::string& type, const std::string& value,
           bool numeric) {
    std::string range;
    if (numeric && (std::isfinite(info.min) || std::isfinite(info.max))) {
      range = "[" + format(info.min) + ", " + format(info.max) + "]";
    }
    for (const auto& c : info.choices) range += (range.empty() ? "" : ", ") + c;
    rows.push_back({section_ + "." + info.name, type, value, range, info.help, info.advanced});
  }
  std::string section_;
};

std::string markdown_table(const std::vector<SettingRow>& rows, bool advanced) {
  std::string out = "| setting | default | range | meaning |\n|---|---|---|---|\n";
  for (const auto& r : rows) {
    if (r.advanced != advanced) continue;
    out += "| `" + r.key + "` | " + r.value + " | " + r.range + " | " + r.help + " |\n";
  }
  return out;
}

}  // namespace

RovigoConfig load_config(const std::optional<std::filesystem::path>& file,
                         const std::vector<std::string>& assignments) {
  Assignments written;
  if (file) read_file(*file, written);
  read_assignments(assignments, written);

  RovigoConfig config;
  Assigner assigner(written);
  visit_sections(config,
                 [&](const std::string& s) -> maps::SettingsVisitor& { return assigner.enter(s); });

  std::vector<std::string> problems = assigner.problems();
  for (const auto& [key, assignment] : written) {
    if (assignment.used) continue;
    problems.push_back(assignment.where + ": unknown setting \"" + key + "\"; did you mean \"" +
                       maps::nearest_word(key, assigner.keys()) + "\"?");
  }
  if (!problems.empty()) throw InputError(join(problems, "; "));
  config.inflation.robot_radius_m = config.robot.robot_radius_m;  // one setting, the robot's
  return config;
}

std::vector<SettingRow> list_settings(const RovigoConfig& config) {
  RovigoConfig copy = config;
  Lister lister;
  visit_sections(copy,
                 [&](const std::string& s) -> maps::SettingsVisitor& { return lister.enter(s); });
  return lister.rows;
}

std::string settings_markdown() {
  const auto rows = list_settings(RovigoConfig{});
  return "# Settings\n\nWritten by `rovigo config --markdown`; a test keeps it fresh. Put settings "
         "into a YAML file "
         "(`section:` with `name: value` below it) and pass it with `--config FILE`, or one at a "
         "time with "
         "`--set section.name=value`.\n\n## For everybody\n\n" +
         markdown_table(rows, false) + "\n## Advanced\n\n" + markdown_table(rows, true);
}

}  // namespace rovigo::app
