#include "app/query_batch.h"

#include <fstream>
#include <string>

#include "app/text.h"
#include "maps/error.h"
#include "maps/movingai.h"

namespace rovigo::app {

namespace {

std::vector<PointPair> read_csv(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in)
    throw maps::InputError(file.string() + ": cannot be opened; check the path given to --batch");
  std::vector<PointPair> queries;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty() || line[0] == '#') continue;
    if (number == 1 && line == "start_x,start_y,goal_x,goal_y") continue;
    std::vector<double> values;
    for (const auto& part : split(line, ',')) {
      if (const auto value = parse_number(part)) values.push_back(*value);
    }
    if (values.size() != 4 || split(line, ',').size() != 4) {
      throw maps::InputError(file.string() + " line " + std::to_string(number) + ": \"" + line +
                             "\" must be four numbers: start_x,start_y,goal_x,goal_y");
    }
    queries.push_back({{values[0], values[1]}, {values[2], values[3]}});
  }
  return queries;
}

}  // namespace

std::vector<PointPair> read_query_batch(const std::filesystem::path& file,
                                        const maps::GridGeometry& grid) {
  if (file.extension() != ".scen") return read_csv(file);
  std::vector<PointPair> queries;
  for (const auto& problem : maps::load_movingai_scenario(file)) {
    if (problem.map_width != grid.width || problem.map_height != grid.height) {
      throw maps::InputError(file.string() + ": made for a map of " +
                             std::to_string(problem.map_width) + " x " +
                             std::to_string(problem.map_height) + " cells, but this one has " +
                             std::to_string(grid.width) + " x " + std::to_string(grid.height));
    }
    queries.push_back({problem.start(), problem.goal()});
  }
  return queries;
}

}  // namespace rovigo::app
