#include "devices.hpp"

#include <dlfcn.h>
#include <fmt/core.h>

#include <algorithm>
#include <exception>

namespace tessera {

std::unique_ptr<World> open_world(const RunOptions& options, std::string& error) {
  if (!options.world) return nullptr;
  if (options.world_library.empty()) {
    error = "a world is asked for, but no library that simulates one (--world-library)";
    return nullptr;
  }
  void* library = dlopen(options.world_library.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    error = fmt::format("cannot load the world's library: {}", dlerror());
    return nullptr;
  }
  const auto open = reinterpret_cast<OpenWorld>(dlsym(library, "tessera_open_world"));
  if (open == nullptr) {
    error = fmt::format("'{}' is no library of worlds: it has no function tessera_open_world",
                        options.world_library);
    return nullptr;
  }
  try {
    return open(*options.world, error);
  } catch (const std::exception& exception) {
    error = exception.what();
  }
  return nullptr;
}

template <class Device>
std::unique_ptr<Device> DeviceFinder::find(const std::string& path,
                                           std::unique_ptr<Device> (World::*from_world)(const DriverRequest&,
                                                                                        std::string&),
                                           std::unique_ptr<Device> (*CppDriver::*from_cpp)()) {
  paths_.push_back(path);
  for (const DriverRequest& request : options_.drivers) {
    if (request.path != path) continue;
    std::string error = "there is no world to find it in (--world)";
    std::unique_ptr<Device> device;
    if (world_ != nullptr) device = (world_->*from_world)(request, error);
    if (device == nullptr)
      complaints_.push_back(fmt::format("{} ({} '{}'): {}", path, request.kind, request.target, error));
    return device;
  }
  for (const CppDriver& driver : system_.drivers)
    if (driver.path == path && driver.*from_cpp != nullptr)
      if (std::unique_ptr<Device> device = (driver.*from_cpp)(); device != nullptr) return device;
  complaints_.push_back(fmt::format("the real buffer {} has no driver", path));
  return nullptr;
}

std::unique_ptr<RealReceptor> DeviceFinder::receptor(const std::string& path) {
  return find(path, &World::receptor, &CppDriver::receptor);
}

std::unique_ptr<RealEffector> DeviceFinder::effector(const std::string& path) {
  return find(path, &World::effector, &CppDriver::effector);
}

std::string DeviceFinder::complaints() const {
  std::string text;
  const auto say = [&](const std::string& sentence) { text += (text.empty() ? "" : "\n") + sentence; };
  for (const std::string& complaint : complaints_) say(complaint);
  for (const DriverRequest& request : options_.drivers)
    if (std::find(paths_.begin(), paths_.end(), request.path) == paths_.end())
      say(fmt::format("a driver is given for '{}', which is no real buffer", request.path));
  return text;
}

}  // namespace tessera
