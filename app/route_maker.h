#pragma once
// Routes by name, by file, or made for a world nobody drew a route for.

#include <cstdint>
#include <string>

#include "app/config.h"
#include "sim/route.h"
#include "sim/world.h"

namespace rovigo::app {

/// A closed tour through random places.
struct TourRequest {
  double length_m = 30.0;
  std::uint64_t seed = 1;
  int laps = 1;
  bool turns = false;  ///< turn in place by 180 to 360 deg at each place
};

/// Starts and ends where rovers are put down in `world`. The first half visits places that are
/// reachable and roomy, new ones before old ones; the second half comes by some of them again.
/// The same arguments give the same route. Throws InputError when the world has no such place.
sim::Route make_tour(const TourRequest& request, const sim::World& world,
                     const RovigoConfig& config);

/// What `--route` may say: "loop:METRES[:SEED[:LAPS]]", "turns:METRES[:SEED]",
/// "spin:X,Y,YAW[:RATE[:SECONDS]]", a name in sim/routes, or a path to a YAML file. Throws
/// InputError naming what is wrong and the forms there are.
sim::Route route_in_world(const std::string& text, const sim::World& world,
                          const RovigoConfig& config);

}  // namespace rovigo::app
