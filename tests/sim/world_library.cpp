#include "world_library.hpp"

#include <dlfcn.h>

#include <stdexcept>

std::unique_ptr<tessera::World> open_world(const tessera::WorldOptions& options, std::string& error) {
  static void* const library = dlopen(TESSERA_WORLD_LIBRARY, RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) throw std::runtime_error(dlerror());
  static const auto open = reinterpret_cast<tessera::OpenWorld>(dlsym(library, tessera::open_world_function));
  if (open == nullptr) throw std::runtime_error(dlerror());
  return open(options, error);
}

std::string line_world() { return TESSERA_SOURCE_DIR "/share/tessera/worlds/line_world.xml"; }
std::string shipped_track(const std::string& name) {
  return TESSERA_SOURCE_DIR "/share/tessera/tracks/" + name;
}
