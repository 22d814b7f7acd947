#pragma once
// Strict reading of small YAML files: every message names file and line, the value and the limit;
// an unknown key is answered with the nearest valid one. For scenarios, routes and suites.

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "maps/error.h"
#include "maps/settings.h"

namespace rovigo::sim {

/// The file's text. Throws InputError when it cannot be read or is too long for what it should be.
std::string read_text(const std::filesystem::path& file);

/// The document as one map (an empty document is an empty map).
YAML::Node parse_yaml(const std::string& text, const std::string& file);

/// "file:12: what"
[[noreturn]] void fail_at(const std::string& file, const YAML::Node& node, const std::string& what);

double real_at(const std::string& file, const YAML::Node& node, const std::string& name);

/// Throws unless every key of `map` is one of `known`.
void require_known_keys(const std::string& file, const YAML::Node& map,
                        const std::vector<std::string>& known);

/// Fills a config struct's fields from the keys of a YAML map.
class YamlFields final : public maps::SettingsVisitor {
 public:
  YamlFields(const std::string& file, const YAML::Node& map) : file_(file), map_(map) {}
  void real(const maps::SettingInfo& info, double& value) override;
  void integer(const maps::SettingInfo& info, int& value) override;
  void flag(const maps::SettingInfo& info, bool& value) override;
  void text(const maps::SettingInfo& info, std::string& value) override;
  const std::vector<std::string>& names() const { return names_; }

 private:
  YAML::Node find(const maps::SettingInfo& info);

  const std::string& file_;
  const YAML::Node& map_;
  std::vector<std::string> names_;
};

template <class Config>
void read_settings(const std::string& file, const YAML::Node& map, Config& config) {
  if (!map.IsMap()) fail_at(file, map, "expected `key: value` lines here");
  YamlFields fields(file, map);
  config.describe(fields);
  require_known_keys(file, map, fields.names());
}

}  // namespace rovigo::sim
