#include "sim/yaml_reader.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <system_error>

#include "maps/nearest_word.h"

namespace rovigo::sim {
namespace {

constexpr std::uintmax_t kMaxBytes = 1U << 20U;

std::string printable(const std::string& text) {
  constexpr std::size_t kLongest = 40;
  std::string out;
  for (const char c : text.substr(0, kLongest)) out += c >= ' ' && c <= '~' ? c : '?';
  return text.size() > kLongest ? out + "..." : out;
}

std::string scalar_text(const std::string& file, const YAML::Node& node, const std::string& name) {
  if (!node.IsScalar()) fail_at(file, node, name + " must be a single value");
  return node.Scalar();
}

}  // namespace

std::string read_text(const std::filesystem::path& file) {
  std::error_code error;
  const auto bytes = std::filesystem::file_size(file, error);
  if (error) throw maps::InputError(file.string() + ": cannot be read: " + error.message());
  if (bytes > kMaxBytes) {
    throw maps::InputError(file.string() + ": " + std::to_string(bytes) +
                           " bytes are too many; the limit is " + std::to_string(kMaxBytes));
  }
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw maps::InputError(file.string() + ": cannot be read");
  return text.str();
}

YAML::Node parse_yaml(const std::string& text, const std::string& file) {
  YAML::Node root;
  try {
    root = YAML::Load(text);
  } catch (const YAML::Exception& e) {
    throw maps::InputError(file + ":" + std::to_string(e.mark.line + 1) + ": not YAML: " + e.msg);
  }
  if (root.IsNull()) return YAML::Node(YAML::NodeType::Map);
  if (!root.IsMap()) fail_at(file, root, "expected `key: value` lines");
  return root;
}

void fail_at(const std::string& file, const YAML::Node& node, const std::string& what) {
  throw maps::InputError(file + ":" + std::to_string(node.Mark().line + 1) + ": " + what);
}

double real_at(const std::string& file, const YAML::Node& node, const std::string& name) {
  const std::string text = scalar_text(file, node, name);
  double value = 0.0;
  if (!YAML::convert<double>::decode(node, value) || !std::isfinite(value)) {
    fail_at(file, node, name + " = \"" + printable(text) + "\" is not a finite number");
  }
  return value;
}

void require_known_keys(const std::string& file, const YAML::Node& map,
                        const std::vector<std::string>& known) {
  std::set<std::string> seen;
  for (const auto& entry : map) {
    if (!entry.first.IsScalar()) fail_at(file, entry.first, "a key must be a single word");
    const std::string& key = entry.first.Scalar();
    if (!seen.insert(key).second) fail_at(file, entry.first, "\"" + key + "\" appears twice");
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    fail_at(file, entry.first,
            "unknown key \"" + printable(key) + "\"; the nearest valid key is \"" +
                maps::nearest_word(key, known) + "\"");
  }
}

YAML::Node YamlFields::find(const maps::SettingInfo& info) {
  names_.push_back(info.name);
  return map_[info.name];
}

void YamlFields::real(const maps::SettingInfo& info, double& value) {
  const YAML::Node node = find(info);
  if (!node) return;
  value = real_at(file_, node, info.name);
  const std::string problem = maps::range_problem(info, value);
  if (!problem.empty()) fail_at(file_, node, problem);
}

void YamlFields::integer(const maps::SettingInfo& info, int& value) {
  const YAML::Node node = find(info);
  if (!node) return;
  const std::string text = scalar_text(file_, node, info.name);
  if (!YAML::convert<int>::decode(node, value)) {
    fail_at(file_, node, info.name + " = \"" + printable(text) + "\" is not a whole number");
  }
  const std::string problem = maps::range_problem(info, value);
  if (!problem.empty()) fail_at(file_, node, problem);
}

void YamlFields::flag(const maps::SettingInfo& info, bool& value) {
  const YAML::Node node = find(info);
  if (!node) return;
  const std::string text = scalar_text(file_, node, info.name);
  if (!YAML::convert<bool>::decode(node, value)) {
    fail_at(file_, node, info.name + " = \"" + printable(text) + "\" is neither true nor false");
  }
}

void YamlFields::text(const maps::SettingInfo& info, std::string& value) {
  const YAML::Node node = find(info);
  if (!node) return;
  value = scalar_text(file_, node, info.name);
  const std::string problem = maps::choice_problem(info, printable(value));
  if (!problem.empty()) fail_at(file_, node, problem);
}

}  // namespace rovigo::sim
