#include "links/carrier_library.hpp"

#include <dlfcn.h>
#include <fmt/ranges.h>

#include <array>
#include <exception>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

namespace tessera {
namespace {

namespace fs = std::filesystem;

/// If the library was copied to a robot, it is beside the controller.
void* load_library(const std::string& file, std::string& error) {
  std::error_code ignored;
  const fs::path beside = fs::read_symlink("/proc/self/exe", ignored).parent_path() / "libtessera_dds.so";
  const std::vector<std::string> usual{beside.string(), TESSERA_CARRIER_BUILT, TESSERA_CARRIER_INSTALLED};
  const std::vector<std::string> candidates = file.empty() ? usual : std::vector<std::string>{file};
  for (const std::string& candidate : candidates) {
    if (file.empty() && !fs::exists(candidate, ignored)) continue;
    if (void* const library = dlopen(candidate.c_str(), RTLD_NOW | RTLD_LOCAL)) return library;
    error = fmt::format("cannot load the library of the network: {}", dlerror());
    return nullptr;
  }
  error = fmt::format("the library of the network is not there: {} (--carrier-library FILE says where it is)",
                      fmt::join(usual, ", "));
  return nullptr;
}

}  // namespace

std::unique_ptr<network::Carrier> open_carrier(const std::string& file, const network::CarrierSetup& setup,
                                               std::string& error) {
  void* const library = load_library(file, error);
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
