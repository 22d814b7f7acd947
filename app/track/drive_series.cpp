#include "app/track/drive_series.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "control/tracking_metrics.h"
#include "maps/atomic_file.h"
#include "maps/error.h"

namespace rovigo::app {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kSampleS = 0.1;
constexpr std::size_t kMaxBytes = std::size_t{1} << 30U;

double rounded(double value) { return std::round(value * 1e4) / 1e4; }

/// The vectors and what they are called in the file.
template <class Series>
auto columns(Series& s) {
  using Column = std::pair<const char*, decltype(&s.time_s)>;
  return std::vector<Column>{{"t_s", &s.time_s},
                             {"x_m", &s.x_m},
                             {"y_m", &s.y_m},
                             {"cross_track_m", &s.cross_track_m},
                             {"v_m_s", &s.speed_m_s},
                             {"w_rad_s", &s.turn_rate_rad_s},
                             {"planned_x_m", &s.planned_x_m},
                             {"planned_y_m", &s.planned_y_m}};
}

bool read_one(const Json& object, DriveSeries& s) {
  if (!object.is_object() || !object.contains("name") || !object["name"].is_string() ||
      !object.contains("seed") || !object["seed"].is_number_unsigned()) {
    return false;
  }
  s.name = object["name"].get<std::string>();
  s.seed = object["seed"].get<std::uint64_t>();
  for (auto& [key, column] : columns(s)) {
    if (!object.contains(key) || !object[key].is_array()) return false;
    for (const Json& v : object[key]) {
      if (!v.is_number()) return false;
      column->push_back(v.get<double>());
    }
  }
  const std::size_t n = s.time_s.size();
  return s.x_m.size() == n && s.y_m.size() == n && s.cross_track_m.size() == n &&
         s.speed_m_s.size() == n && s.turn_rate_rad_s.size() == n &&
         s.planned_x_m.size() == s.planned_y_m.size() &&
         std::is_sorted(s.time_s.begin(), s.time_s.end());
}

}  // namespace

DriveSeries series_of(const TrackRun& run) {
  const planning::Trajectory& planned = run.track->trajectory;
  DriveSeries s;
  s.name = run.what.name;
  s.seed = run.what.seed;
  double next_s = 0.0;
  for (const control::DriveStep& step : run.log.steps) {
    if (step.time_s < next_s - 1e-9) continue;
    next_s += kSampleS;
    s.time_s.push_back(rounded(step.time_s));
    s.x_m.push_back(rounded(step.true_pose.x));
    s.y_m.push_back(rounded(step.true_pose.y));
    s.cross_track_m.push_back(
        rounded(control::cross_track_error_m(planned, maps::position_of(step.true_pose))));
    s.speed_m_s.push_back(rounded(step.command.vx));
    s.turn_rate_rad_s.push_back(rounded(step.command.omega));
  }
  for (double t = 0.0; t < planned.duration_s() + kSampleS; t += kSampleS) {
    const TPose2D at = planning::sample(planned, t).pose;
    s.planned_x_m.push_back(rounded(at.x));
    s.planned_y_m.push_back(rounded(at.y));
  }
  return s;
}

Json series_json(const std::vector<DriveSeries>& series) {
  Json list = Json::array();
  for (const DriveSeries& s : series) {
    Json object{{"name", s.name}, {"seed", s.seed}};
    for (const auto& [key, column] : columns(s)) object[key] = *column;
    list.push_back(std::move(object));
  }
  return list;
}

std::vector<DriveSeries> read_series(const std::filesystem::path& file) {
  const Json list = Json::parse(maps::read_file(file, kMaxBytes), nullptr, false);
  if (!list.is_array()) {
    throw maps::InputError(file.string() + ": is no list of drives; run the shard with --report");
  }
  std::vector<DriveSeries> out;
  for (const Json& object : list) {
    DriveSeries s;
    if (!read_one(object, s)) {
      throw maps::InputError(file.string() + ": drive " + std::to_string(out.size() + 1) +
                             " is not complete; run the shard with --report again");
    }
    out.push_back(std::move(s));
  }
  return out;
}

}  // namespace rovigo::app
