#include "app/track/controller_comparison.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "app/text.h"

namespace rovigo::app {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kLeastErrorM = 1e-6;  // less is none: a ratio of nothings says nothing

struct Drive {
  std::string group, trajectory;
  double ours_m = 0.0, reference_m = 0.0;
  bool reference_arrived = false;
};

std::vector<Drive> paired_drives(const TrackResult& result) {
  struct Two {
    const Json* ours = nullptr;
    const Json* reference = nullptr;
  };
  std::map<std::vector<std::string>, Two> pairs;
  for (const Json& run : result.runs) {
    auto parts = split(run["name"].get<std::string>(), '/');
    if (parts.size() < 3) continue;
    const bool is_reference = parts[2] == "reference";
    parts[2] = run["seed"].dump();
    Two& two = pairs[parts];
    (is_reference ? two.reference : two.ours) = &run;
  }
  std::vector<Drive> out;
  for (const auto& [key, two] : pairs) {
    if (!two.ours || !two.reference) continue;
    out.push_back({key[0], key[1], (*two.ours)["cross_track_rms_m"].get<double>(),
                   (*two.reference)["cross_track_rms_m"].get<double>(),
                   (*two.reference)["status"] == "ok"});
  }
  return out;
}

double ratio_of(double reference_m, double ours_m) {
  return std::max(reference_m, kLeastErrorM) / std::max(ours_m, kLeastErrorM);
}

double rms(const std::vector<Drive>& drives, double Drive::*value) {
  double sum = 0.0;
  for (const Drive& d : drives) sum += d.*value * d.*value;
  return drives.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(drives.size()));
}

double median_ratio(const std::vector<Drive>& drives) {
  if (drives.empty()) return 0.0;
  std::vector<double> ratios;
  for (const Drive& d : drives) ratios.push_back(ratio_of(d.reference_m, d.ours_m));
  std::sort(ratios.begin(), ratios.end());
  const std::size_t half = ratios.size() / 2;
  return ratios.size() % 2 == 1 ? ratios[half] : (ratios[half - 1] + ratios[half]) / 2.0;
}

ControllerComparison compare(const std::string& what, const std::vector<Drive>& drives) {
  std::vector<Drive> arrived;
  for (const Drive& d : drives) {
    if (d.reference_arrived) arrived.push_back(d);
  }
  ControllerComparison out;
  out.what = what;
  out.drives = drives.size();
  out.reference_arrived = arrived.size();
  out.rms_m = rms(drives, &Drive::ours_m);
  out.reference_rms_m = rms(drives, &Drive::reference_m);
  out.ratio = ratio_of(out.reference_rms_m, out.rms_m);
  out.median_ratio = median_ratio(drives);
  if (!arrived.empty()) {
    out.arrived_ratio = ratio_of(rms(arrived, &Drive::reference_m), rms(arrived, &Drive::ours_m));
    out.arrived_median_ratio = median_ratio(arrived);
  }
  return out;
}

}  // namespace

std::vector<ControllerComparison> compare_controllers(const TrackResult& result) {
  const std::vector<Drive> drives = paired_drives(result);
  std::map<std::string, std::vector<Drive>> trajectories, groups;
  for (const Drive& d : drives) {
    trajectories[d.group + ", " + d.trajectory].push_back(d);
    groups[d.group].push_back(d);
  }
  std::vector<ControllerComparison> out;
  for (const auto& [what, of] : trajectories) out.push_back(compare(what, of));
  for (const auto& [what, of] : groups) out.push_back(compare(what, of));
  if (groups.size() > 1) out.push_back(compare("all", drives));
  return out;
}

Json comparison_json(const std::vector<ControllerComparison>& comparisons) {
  Json out = Json::array();
  for (const auto& c : comparisons) {
    out.push_back({{"what", c.what},
                   {"drives", c.drives},
                   {"reference_arrived", c.reference_arrived},
                   {"cross_track_rms_m", c.rms_m},
                   {"reference_cross_track_rms_m", c.reference_rms_m},
                   {"ratio", c.ratio},
                   {"median_ratio", c.median_ratio},
                   {"arrived_ratio", c.arrived_ratio},
                   {"arrived_median_ratio", c.arrived_median_ratio}});
  }
  return out;
}

std::vector<Row> comparison_rows(const std::vector<ControllerComparison>& comparisons) {
  std::vector<Row> rows;
  for (const auto& c : comparisons) {
    std::string text = with_unit(c.rms_m, 4, "m RMS") + ", the thesis's law " +
                       with_unit(c.reference_rms_m, 4, "m") + ": " + with_unit(c.ratio, 1, "times");
    if (c.drives > 1) text += ", median " + with_unit(c.median_ratio, 1, "");
    text += "; it arrived in " + std::to_string(c.reference_arrived) + " of " +
            std::to_string(c.drives);
    if (c.reference_arrived > 0 && c.reference_arrived < c.drives) {
      text += ", there " + with_unit(c.arrived_ratio, 1, "times") + ", median " +
              with_unit(c.arrived_median_ratio, 1, "");
    }
    rows.emplace_back("against: " + c.what, text);
  }
  return rows;
}

}  // namespace rovigo::app
