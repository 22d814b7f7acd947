#include "app/track/version_comparison.h"

#include <cmath>
#include <map>

#include "app/text.h"

namespace rovigo::app {

namespace {

using Json = nlohmann::ordered_json;

/// Sums up; rms_m and rms_before_m hold sums of squares until root_of().
void count(VersionComparison& c, const Json& run, const Json& before) {
  const auto square = [](const Json& r) {
    const double rms_m = r["cross_track_rms_m"].get<double>();
    return rms_m * rms_m;
  };
  ++c.drives;
  c.same += run["log_hash"] == before["log_hash"] ? 1 : 0;
  c.passed += run["passed"].get<bool>() ? 1 : 0;
  c.passed_before += before["passed"].get<bool>() ? 1 : 0;
  c.rms_m += square(run);
  c.rms_before_m += square(before);
}

VersionComparison root_of(VersionComparison sums, const std::string& what) {
  sums.what = what;
  const auto drives = static_cast<double>(sums.drives);
  sums.rms_m = std::sqrt(sums.rms_m / drives);
  sums.rms_before_m = std::sqrt(sums.rms_before_m / drives);
  return sums;
}

}  // namespace

std::vector<VersionComparison> compare_versions(const TrackResult& now, const TrackResult& before) {
  const auto key_of = [](const Json& run) {
    return run["name"].get<std::string>() + "/" + run["seed"].dump();
  };
  std::map<std::string, const Json*> earlier;
  for (const Json& run : before.runs) earlier[key_of(run)] = &run;
  std::map<std::string, VersionComparison> groups;
  VersionComparison all;
  for (const Json& run : now.runs) {
    const auto found = earlier.find(key_of(run));
    if (found == earlier.end()) continue;
    auto parts = split(run["name"].get<std::string>(), '/');
    parts.resize(3);
    count(groups[parts[0] + ", " + parts[2]], run, *found->second);
    count(all, run, *found->second);
  }
  std::vector<VersionComparison> out;
  for (const auto& [what, sums] : groups) out.push_back(root_of(sums, what));
  if (groups.size() > 1) out.push_back(root_of(all, "all"));
  return out;
}

Json comparison_json(const std::vector<VersionComparison>& comparisons) {
  Json out = Json::array();
  for (const auto& c : comparisons) {
    out.push_back({{"what", c.what},
                   {"drives", c.drives},
                   {"same_to_the_bit", c.same},
                   {"passed", c.passed},
                   {"passed_before", c.passed_before},
                   {"cross_track_rms_m", c.rms_m},
                   {"cross_track_rms_before_m", c.rms_before_m}});
  }
  return out;
}

std::vector<Row> comparison_rows(const std::vector<VersionComparison>& comparisons,
                                 const std::string& before_name) {
  if (comparisons.empty()) return {{"before", "no run is also in " + before_name}};
  std::vector<Row> rows;
  for (const auto& c : comparisons) {
    rows.emplace_back("before: " + c.what,
                      with_unit(c.rms_before_m, 4, "m RMS") + ", now " +
                          with_unit(c.rms_m, 4, "m") + "; passed " +
                          std::to_string(c.passed_before) + ", now " + std::to_string(c.passed) +
                          "; " + std::to_string(c.same) + " of " + std::to_string(c.drives) +
                          " drives are the same to the bit");
  }
  return rows;
}

}  // namespace rovigo::app
