#include "slam/recording/rawlog_header.h"

#include <nlohmann/json.hpp>

#include "maps/error.h"

namespace rovigo::slam {

std::string header_text(const RecordingInfo& info) {
  nlohmann::ordered_json json;
  json["rovigo"] = ROVIGO_VERSION;
  json["name"] = info.name;
  json["has_extrinsics"] = info.rig.has_extrinsics;
  json["has_wheels"] = info.rig.has_wheels;
  json["has_imu"] = info.rig.has_imu;
  if (info.simulation) {
    const TPose2D& pose = info.simulation->world_from_map;
    json["simulation"] = {{"world", info.simulation->world},
                          {"seed", info.simulation->seed},
                          {"world_from_map", {pose.x, pose.y, pose.phi}}};
  }
  // A name from the file system may hold bytes that are not UTF-8; they must not stop a recording.
  return json.dump(2, ' ', true, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::optional<RawlogHeader> parse_header(const std::string& text, const std::string& file) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (json.is_discarded() || !json.is_object() || !json.contains("rovigo")) return std::nullopt;
  try {
    RawlogHeader header;
    header.has_extrinsics = json.at("has_extrinsics").get<bool>();
    header.has_wheels = json.at("has_wheels").get<bool>();
    header.has_imu = json.at("has_imu").get<bool>();
    if (json.contains("simulation")) {
      const auto& from = json.at("simulation");
      maps::SimulationOrigin simulation;
      simulation.world = from.at("world").get<std::string>();
      simulation.seed = from.at("seed").get<std::uint64_t>();
      const auto& pose = from.at("world_from_map");
      simulation.world_from_map = {pose.at(0).get<double>(), pose.at(1).get<double>(),
                                   pose.at(2).get<double>()};
      header.simulation = simulation;
    }
    return header;
  } catch (const nlohmann::json::exception&) {
    throw maps::InputError(file + ": the opening comment of this Rovigo recording is damaged");
  }
}

}  // namespace rovigo::slam
