// rovigo config: every setting, its unit, range and default; checks a file.

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/commands/options.h"
#include "app/config.h"
#include "app/console.h"

namespace rovigo::app {

namespace {

void print_rows(const std::vector<SettingRow>& rows, bool advanced) {
  std::size_t width = 0;
  for (const auto& r : rows) width = std::max(width, r.key.size());
  for (const auto& r : rows) {
    if (r.advanced != advanced) continue;
    std::printf("  %-*s  %-10s %-20s %s\n", static_cast<int>(width), r.key.c_str(), r.value.c_str(),
                r.range.c_str(), r.help.c_str());
  }
}

}  // namespace

int run_config(const ConfigOptions& options) {
  if (options.markdown) {
    std::fputs(settings_markdown().c_str(), stdout);
    return kDone;
  }
  const Console console(options.json);
  const auto file = options.check ? options.check : options.config;
  const auto rows = list_settings(load_config(file, options.set));
  if (options.json) {
    nlohmann::ordered_json settings = nlohmann::ordered_json::array();
    for (const auto& r : rows) {
      settings.push_back({{"key", r.key},
                          {"type", r.type},
                          {"value", r.value},
                          {"range", r.range},
                          {"help", r.help},
                          {"advanced", r.advanced}});
    }
    console.result({{"status", "ok"},
                    {"code", 0},
                    {"message", "all settings are valid"},
                    {"settings", settings}},
                   "", {});
    return kDone;
  }
  if (options.check) {
    console.say(options.check->string() + ": all settings are valid");
    return kDone;
  }
  console.say("Settings for everybody (name, value, range, meaning):");
  print_rows(rows, false);
  console.say("\nAdvanced:");
  print_rows(rows, true);
  console.say(
      "\nPut them in a YAML file (`robot:` with `max_speed_m_s: 0.3` below it) for --config, or "
      "use --set robot.max_speed_m_s=0.3");
  return kDone;
}

}  // namespace rovigo::app
