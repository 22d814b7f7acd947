#include "app/track/suite.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "app/console.h"
#include "maps/nearest_word.h"
#include "sim/yaml_reader.h"

namespace rovigo::app {

namespace {

using sim::fail_at;

constexpr std::size_t kMaxRuns = 100000;
constexpr std::size_t kMaxNameLength = 60;

/// A list, or one value in place of a list of one.
template <class Read>
auto read_list(const std::string& file, const YAML::Node& node, const std::string& name,
               const Read& read) {
  std::vector<decltype(read(node))> values;
  if (node.IsScalar()) {
    values.push_back(read(node));
  } else if (node.IsSequence() && node.size() > 0 && node.size() <= kMaxRuns) {
    for (const auto& item : node) values.push_back(read(item));
  } else {
    fail_at(file, node, name + " must be a value or a list of 1 to 100000 values");
  }
  auto sorted = values;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
    fail_at(file, node, name + " names a value twice");
  }
  return values;
}

/// A name that can be part of a file's name.
std::string read_name(const std::string& file, const YAML::Node& node, const std::string& what) {
  if (!node.IsScalar()) fail_at(file, node, what + " must be a single word");
  const std::string& name = node.Scalar();
  const bool good = !name.empty() && name.size() <= kMaxNameLength &&
                    std::all_of(name.begin(), name.end(), [](char c) {
                      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                             (c >= '0' && c <= '9') || c == '_' || c == '-';
                    });
  if (!good) {
    fail_at(file, node,
            what + " must be 1 to 60 letters, digits, _ or -, so that files can be called by it");
  }
  return name;
}

std::string read_choice(const std::string& file, const YAML::Node& node, const std::string& what,
                        const std::vector<std::string>& choices) {
  const std::string word = read_name(file, node, what);
  if (std::find(choices.begin(), choices.end(), word) != choices.end()) return word;
  fail_at(file, node,
          "there is no " + what + " \"" + word + "\"; the nearest is \"" +
              maps::nearest_word(word, choices) + "\"");
}

double read_speed(const std::string& file, const YAML::Node& node) {
  const double speed = sim::real_at(file, node, "speeds_m_s");
  if (!(speed >= 0.05 && speed <= 0.8)) {
    fail_at(file, node,
            "speeds_m_s = " + node.Scalar() + " is outside [0.05, 0.8], what the rover can drive");
  }
  return speed;
}

std::uint64_t read_seed(const std::string& file, const YAML::Node& node) {
  std::uint64_t seed = 0;
  if (!node.IsScalar() || node.Scalar().find('-') != std::string::npos ||
      !YAML::convert<std::uint64_t>::decode(node, seed)) {
    fail_at(file, node, "seeds must be whole numbers, 0 or more");
  }
  return seed;
}

/// A seed, a list of them, or `{from: 1, to: 100}`.
std::vector<std::uint64_t> read_seeds(const std::string& file, const YAML::Node& node) {
  const auto seed = [&](const YAML::Node& item) { return read_seed(file, item); };
  if (!node.IsMap()) return read_list(file, node, "seeds", seed);
  sim::require_known_keys(file, node, {"from", "to"});
  if (!node["from"] || !node["to"]) fail_at(file, node, "a range of seeds needs from and to");
  const std::uint64_t from = seed(node["from"]), to = seed(node["to"]);
  if (to < from || to - from >= kMaxRuns) {
    fail_at(file, node, "a range of seeds must hold 1 to 100000 seeds");
  }
  std::vector<std::uint64_t> seeds(to - from + 1);
  std::iota(seeds.begin(), seeds.end(), from);
  return seeds;
}

TrackGroup read_group(const std::string& file, const YAML::Node& node,
                      const std::vector<std::string>& trajectories) {
  if (!node.IsMap()) fail_at(file, node, "a group is a list of `key: value` lines");
  sim::require_known_keys(
      file, node,
      {"name", "scenario", "pose", "trajectories", "controllers", "speeds_m_s", "seeds", "limits"});
  TrackGroup group;
  if (!node["name"]) fail_at(file, node, "a group needs a `name:`");
  group.name = read_name(file, node["name"], "a group's name");
  if (const auto n = node["scenario"]) {
    if (!n.IsScalar()) fail_at(file, n, "scenario must be a name or a path");
    group.scenario = n.Scalar();
  }
  if (const auto n = node["pose"]) {
    group.pose = read_choice(file, n, "pose source", {"perturbed", "truth", "slam", "odometry"});
  }
  group.trajectories = trajectories;
  if (const auto n = node["trajectories"]) {
    group.trajectories = read_list(file, n, "trajectories", [&](const YAML::Node& item) {
      return read_choice(file, item, "trajectory", trajectories);
    });
  }
  if (const auto n = node["controllers"]) {
    group.controllers = read_list(file, n, "controllers", [&](const YAML::Node& item) {
      return read_choice(file, item, "controller", {"default", "reference"});
    });
  }
  if (const auto n = node["speeds_m_s"]) {
    group.speeds_m_s = read_list(file, n, "speeds_m_s",
                                 [&](const YAML::Node& item) { return read_speed(file, item); });
  }
  if (const auto n = node["seeds"]) group.seeds = read_seeds(file, n);
  if (const auto n = node["limits"]) sim::read_settings(file, n, group.limits);
  return group;
}

std::map<std::string, TrackShape> read_trajectories(const std::string& file,
                                                    const YAML::Node& root) {
  const YAML::Node list = root["trajectories"];
  if (!list || !list.IsMap() || list.size() == 0) {
    throw maps::InputError(file +
                           ": `trajectories:` must name what is driven, for example "
                           "`trajectories: {circle: {shape: circle, radius_m: 1}}`");
  }
  std::map<std::string, TrackShape> out;
  for (const auto& entry : list) {
    const std::string name = read_name(file, entry.first, "a trajectory's name");
    if (out.contains(name)) fail_at(file, entry.first, "trajectory \"" + name + "\" appears twice");
    sim::read_settings(file, entry.second, out[name]);
  }
  return out;
}

std::size_t count_runs(const TrackGroup& group) {
  double runs = 1.0;
  for (const std::size_t n : {group.trajectories.size(), group.controllers.size(),
                              group.speeds_m_s.size(), group.seeds.size()}) {
    runs *= static_cast<double>(n);
  }
  return static_cast<std::size_t>(std::min(runs, 1e9));
}

}  // namespace

TrackSuite parse_suite(const std::string& yaml, const std::string& file) {
  const YAML::Node root = sim::parse_yaml(yaml, file);
  sim::require_known_keys(file, root, {"name", "trajectories", "groups"});
  TrackSuite suite;
  suite.name = std::filesystem::path(file).stem().string();
  suite.folder = std::filesystem::path(file).parent_path();
  if (root["name"]) suite.name = read_name(file, root["name"], "name");
  suite.trajectories = read_trajectories(file, root);
  std::vector<std::string> known;
  for (const auto& [name, shape] : suite.trajectories) known.push_back(name);

  const YAML::Node groups = root["groups"];
  if (!groups || !groups.IsSequence() || groups.size() == 0) {
    throw maps::InputError(file +
                           ": `groups:` must list at least one group, for example "
                           "`groups: [{name: all}]`");
  }
  std::size_t runs = 0;
  for (const auto& node : groups) {
    suite.groups.push_back(read_group(file, node, known));
    const TrackGroup& added = suite.groups.back();
    for (std::size_t i = 0; i + 1 < suite.groups.size(); ++i) {
      if (suite.groups[i].name != added.name) continue;
      fail_at(file, node, "group \"" + added.name + "\" appears twice");
    }
    runs += count_runs(added);
    if (runs > kMaxRuns) {
      fail_at(file, node, "the suite has more than 100000 runs; split it into several");
    }
  }
  return suite;
}

TrackSuite load_suite(const std::filesystem::path& file) {
  return parse_suite(sim::read_text(file), file.string());
}

std::vector<TrackCase> cases_of(const TrackSuite& suite) {
  std::vector<TrackCase> cases;
  for (std::size_t g = 0; g < suite.groups.size(); ++g) {
    const TrackGroup& group = suite.groups[g];
    for (const auto& trajectory : group.trajectories) {
      for (const auto& controller : group.controllers) {
        for (const double speed : group.speeds_m_s) {
          const std::string name =
              group.name + "/" + trajectory + "/" + controller + "/" + with_unit(speed, 3, "");
          for (const auto seed : group.seeds) {
            cases.push_back({name, seed, trajectory, controller, speed, g});
          }
        }
      }
    }
  }
  std::sort(cases.begin(), cases.end(), [](const TrackCase& a, const TrackCase& b) {
    return std::tie(a.name, a.seed) < std::tie(b.name, b.seed);
  });
  return cases;
}

}  // namespace rovigo::app
