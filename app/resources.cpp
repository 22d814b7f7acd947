#include "app/resources.h"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <vector>

#include "app/text.h"
#include "maps/error.h"

namespace rovigo::app {

namespace {

namespace fs = std::filesystem;

fs::path data_folder(const std::string& kind) { return fs::path(ROVIGO_DATA_DIR) / "sim" / kind; }

std::string names_in(const fs::path& folder, const std::string& extension) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().extension() == extension) names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return join(names, ", ");
}

fs::path find(const std::string& what, const std::string& kind, const std::string& extension,
              const std::string& name_or_path) {
  const fs::path named = data_folder(kind) / (name_or_path + extension);
  std::error_code ignored;
  const bool is_word = name_or_path.find('/') == std::string::npos;
  if (is_word && fs::is_regular_file(named, ignored)) return named;
  if (fs::is_regular_file(name_or_path, ignored)) return name_or_path;
  throw maps::InputError("no " + what + " \"" + name_or_path + "\": give a path to a " + extension +
                         " file or one of: " + names_in(data_folder(kind), extension));
}

}  // namespace

sim::World open_world(const std::string& name_or_path) {
  const std::string prefix = "random:";
  if (name_or_path.rfind(prefix, 0) == 0) {
    const std::string digits = name_or_path.substr(prefix.size());
    std::uint64_t seed = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), seed);
    if (error != std::errc{} || end != digits.data() + digits.size()) {
      throw maps::InputError("world \"" + name_or_path +
                             "\": must be random:SEED with a whole number, e.g. random:7");
    }
    return sim::World::random_office(seed);
  }
  return sim::World::load(find("world", "worlds", ".sdf", name_or_path));
}

sim::Route open_route(const std::string& name_or_path) {
  return sim::load_route(find("route", "routes", ".yaml", name_or_path));
}

sim::Scenario open_scenario(const std::string& name_or_path) {
  return sim::load_scenario(find("scenario", "scenarios", ".yaml", name_or_path));
}

fs::path find_suite(const std::string& name_or_path) {
  return find("suite", "suites", ".yaml", name_or_path);
}

void require_writable(const std::filesystem::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) {
    throw maps::InputError(file.string() + ": there is no folder " + folder.string() +
                           " to write into; create it first");
  }
  if (fs::is_directory(file, ignored)) {
    throw maps::InputError(file.string() + ": is a folder; name a file");
  }
  if (access(folder.c_str(), W_OK) != 0) {
    throw maps::InputError(file.string() + ": the folder " + folder.string() +
                           " may not be written to; choose another or change its permissions");
  }
}

}  // namespace rovigo::app
