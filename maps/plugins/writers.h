#pragma once
// The writers inside the exchange plug-in. All throw std::exception when a file cannot be written.

#include "maps/plugins/exchange.h"

namespace rovigo::maps {

using Points = const std::vector<ColoredPoint>&;
using NextViewPoints = const std::function<bool(ViewPoints&)>&;
using NextView = const std::function<bool(ExchangeView&)>&;
using FileName = const std::string&;

void write_ply(Points points, FileName file);
void write_pcd(Points points, FileName file);
void write_octomap(NextViewPoints next, double resolution_m, FileName file);
void write_octomap_layer(const OccupancyGrid& grid, FileName file);
void write_gridmap(const OccupancyGrid& grid, FileName file);
void write_simplemap(const MapMetadata& metadata, NextView next, FileName file);

}  // namespace rovigo::maps
