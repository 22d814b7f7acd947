#include "maps/plugins/exchange.h"

#include <exception>

#include "maps/plugins/writers.h"

namespace rovigo::maps {
namespace {

/// Runs a writer, turning what it throws into words.
template <auto kWrite, class... Args>
std::string guarded(Args... args) {
  try {
    kWrite(args...);
    return {};
  } catch (const std::exception& e) {
    return *e.what() ? e.what() : "unknown error";
  }
}

const ExchangePlugin kPlugin = {
    guarded<write_ply>,           guarded<write_pcd>,     guarded<write_octomap>,
    guarded<write_octomap_layer>, guarded<write_gridmap>, guarded<write_simplemap>,
};

}  // namespace
}  // namespace rovigo::maps

extern "C" const rovigo::maps::ExchangePlugin* rovigo_exchange_plugin() {
  return &rovigo::maps::kPlugin;
}
