#include "maps/exchange_loader.h"

#include <dlfcn.h>

#include "maps/error.h"

namespace rovigo::maps {

const ExchangePlugin& load_exchange_plugin(const std::filesystem::path& folder) {
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  const auto file = (folder.empty() ? program.parent_path() : folder) / kExchangePluginFile;
  // Never closed: MRPT and PCL register classes that must outlive every use.
  void* module = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!module) {
    const char* why = ::dlerror();
    throw InputError("this format needs the exchange plug-in, which cannot be loaded: " +
                     std::string(why ? why : file.string()));
  }
  using Entry = const ExchangePlugin* (*)();
  const auto entry = reinterpret_cast<Entry>(::dlsym(module, kExchangePluginSymbol));
  if (!entry) throw InputError(file.string() + " is no exchange plug-in of Rovigo");
  return *entry();
}

}  // namespace rovigo::maps
