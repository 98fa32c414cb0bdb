#include "links/carrier_library.hpp"

#include <dlfcn.h>
#include <fmt/core.h>

#include <array>
#include <exception>

namespace tessera {

std::unique_ptr<network::Carrier> open_carrier(const std::string& file, const network::CarrierSetup& setup,
                                               std::string& error) {
  void* library = nullptr;
  for (const char* candidate : {file.c_str(), TESSERA_CARRIER_BUILT, TESSERA_CARRIER_INSTALLED}) {
    if (library != nullptr || *candidate == '\0' || (!file.empty() && candidate != file.c_str())) continue;
    library = dlopen(candidate, RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) error = fmt::format("cannot load the library of the network: {}", dlerror());
  }
  if (library == nullptr) return nullptr;
  auto* const open = reinterpret_cast<network::OpenCarrier*>(dlsym(library, network::open_carrier_function));
  if (open == nullptr) {
    error = fmt::format("the library of the network is none of this version: it has no function {}",
                        network::open_carrier_function);
    return nullptr;
  }
  std::array<char, 1024> why{};
  try {
    if (network::Carrier* const made = open(setup, why.data(), why.size())) {
      error.clear();
      return std::unique_ptr<network::Carrier>(made);
    }
    error = fmt::format("the network: {}", why.data());
  } catch (const std::exception& exception) {
    error = fmt::format("the network: {}", exception.what());
  }
  return nullptr;
}

}  // namespace tessera
