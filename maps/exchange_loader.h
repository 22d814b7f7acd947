#pragma once
// Loads the exchange plug-in on demand. Internal to maps.

#include <filesystem>

#include "maps/plugins/exchange.h"

namespace rovigo::maps {

/// The plug-in in `folder`, or beside the running program when empty. It stays loaded. Throws
/// InputError saying where it was looked for.
const ExchangePlugin& load_exchange_plugin(const std::filesystem::path& folder);

}  // namespace rovigo::maps
