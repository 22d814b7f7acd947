// Our side of against_scipy.py: answers one line for each line on its standard input.
//   grid MAP OUT                   loads a map, writes its cells as int8; answers WIDTH HEIGHT
//   inflate SIGMA OUT              inflates it, writes 1 for lethal cells; answers CPU ms
//   spline S COUNT POINTS OUT      through COUNT points (x, y as doubles); writes 101 samples of
//                                  the curve; answers CPU ms

#include <cstdint>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "maps/inflation.h"
#include "maps/movingai.h"
#include "maps/ros_map.h"
#include "planning/reference_spline.h"

namespace {

using namespace rovigo;  // NOLINT

double cpu_ms() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

template <typename T>
void write(const std::string& file, const std::vector<T>& values) {
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(values.data()),
             static_cast<std::streamsize>(values.size() * sizeof(T)));
}

maps::OccupancyGrid load(const std::filesystem::path& file) {
  std::vector<std::string> warnings;
  return file.extension() == ".map" ? maps::load_movingai_map(file)
                                    : maps::load_ros_map(file, warnings);
}

double inflate(const maps::OccupancyGrid& grid, double sigma, const std::string& out) {
  const double begin = cpu_ms();
  const maps::Costmap costmap =
      maps::inflate_reference(grid, sigma, maps::MapMode::kUnknownPassable);
  const double spent = cpu_ms() - begin;
  std::vector<std::uint8_t> lethal;
  for (const std::uint8_t cell : costmap.cells) {
    lethal.push_back(cell == maps::Costmap::kLethal ? 1 : 0);
  }
  write(out, lethal);
  return spent;
}

double spline(double smoothing, std::size_t count, const std::string& in, const std::string& out) {
  std::vector<double> numbers(2 * count);
  std::ifstream(in, std::ios::binary)
      .read(reinterpret_cast<char*>(numbers.data()),
            static_cast<std::streamsize>(numbers.size() * sizeof(double)));
  std::vector<mrpt::math::TPoint2D> points;
  for (std::size_t i = 0; i < count; ++i) points.push_back({numbers[2 * i], numbers[2 * i + 1]});
  const double begin = cpu_ms();
  const planning::ReferenceSpline fit = planning::reference_spline(points, smoothing);
  std::vector<double> samples;
  for (int i = 0; i <= 100; ++i) {
    const mrpt::math::TPoint2D p = fit.curve.position(0.01 * i);
    samples.insert(samples.end(), {p.x, p.y});
  }
  const double spent = cpu_ms() - begin;
  write(out, samples);
  return spent;
}

}  // namespace

int main() {
  maps::OccupancyGrid grid;
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream words(line);
    std::string command, in, out;
    double number = 0.0;
    std::size_t count = 0;
    words >> command;
    if (command == "grid" && words >> in >> out) {
      grid = load(in);
      write(out, grid.cells);
      std::cout << grid.geometry.width << ' ' << grid.geometry.height << std::endl;
    } else if (command == "inflate" && words >> number >> out) {
      std::cout << inflate(grid, number, out) << std::endl;
    } else if (command == "spline" && words >> number >> count >> in >> out) {
      std::cout << spline(number, count, in, out) << std::endl;
    } else {
      std::cerr << "planning_scipy: not understood: " << line << '\n';
      return 2;
    }
  }
}
