#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <optional>
#include <system_error>
#include <vector>

#include "drivers/ros2_library.hpp"
#include "tessera/ros2.hpp"

namespace tessera {

namespace fs = std::filesystem;

namespace {

fs::path find_ros2_library(const std::vector<fs::path>& folders) {
  if (const char* const given = std::getenv("TESSERA_ROS2_LIBRARY"); given != nullptr && *given != '\0')
    return given;
  std::error_code ignored;
  std::vector<fs::path> places{fs::read_symlink("/proc/self/exe", ignored).parent_path()};
  places.insert(places.end(), folders.begin(), folders.end());
  for (const fs::path& place : places)
    if (fs::exists(place / ros2_library_name, ignored)) return place / ros2_library_name;
  return places.back() / ros2_library_name;
}

}  // namespace

void* ros2_function(const std::vector<fs::path>& folders, const char* name) {
  const fs::path file = find_ros2_library(folders);
  void* const library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr)
    throw DriverError(fmt::format(
        "cannot load the library for ROS 2: {}; TESSERA_ROS2_LIBRARY can say where it is", dlerror()));
  void* const function = dlsym(library, name);
  if (function == nullptr)
    throw DriverError(
        fmt::format("'{}' is no library of this version: it has no function {}", file.string(), name));
  return function;
}

namespace {

Ros2Binding binding_of(const DriverSetup& setup, const ValueEncoding* encoding) {
  Ros2Binding binding;
  binding.path = setup.path();
  binding.topic = setup.text("topic");
  binding.type = setup.text("type");
  binding.definition = setup.text("definition");
  binding.fields = setup.text_or("fields", "");
  binding.names = setup.text_or("names", "");
  binding.frame_id = setup.text_or("frame_id", "");
  binding.frame = setup.text_or("frame", "");
  binding.in = setup.text_or("in", "");
  binding.at = setup.text_or("at", "");
  binding.one_publisher = setup.text_or("publishers", "") == "one";
  binding.qos = setup.text_or("qos", "");
  binding.node = setup.text_or("node", "");
  binding.interface = setup.text_or("interface", "lo");
  binding.peers = setup.text_or("peers", "");
  if (setup.has("domain")) binding.domain = static_cast<std::uint32_t>(setup.integer("domain"));
  binding.wait = setup.duration_or("wait", Duration::zero());
  binding.role = setup.text_or("role", "");
  binding.timeout = setup.duration_or("timeout", Duration::zero());
  binding.encoding = encoding;
  refuse_unknown_options(setup, true);
  return binding;
}

struct UsedFolder {
  std::mutex mutex;
  std::optional<fs::path> path;
};
UsedFolder& used_folder() {
  static UsedFolder folder;
  return folder;
}

template <class Maker>
auto make_with_library(const DriverSetup& setup, const ValueEncoding* encoding, const char* folder,
                       const char* name) {
  const Ros2Binding binding = binding_of(setup, encoding);
  const auto maker = reinterpret_cast<Maker>(ros2_function({folder}, name));
  std::string error = "it cannot be made";
  auto device = maker(binding, error);
  if (device == nullptr) throw DriverError(error);
  UsedFolder& used = used_folder();
  const std::lock_guard lock(used.mutex);
  used.path = folder;
  return device;
}

}  // namespace

std::optional<fs::path> ros2_folder_in_use() {
  UsedFolder& used = used_folder();
  const std::lock_guard lock(used.mutex);
  return used.path;
}

std::unique_ptr<RealReceptor> make_ros2_receptor(const DriverSetup& setup, const ValueEncoding* encoding,
                                                 const char* folder) {
  return make_with_library<Ros2ReceptorMaker>(setup, encoding, folder, ros2_receptor_function);
}

std::unique_ptr<RealEffector> make_ros2_effector(const DriverSetup& setup, const ValueEncoding* encoding,
                                                 const char* folder) {
  return make_with_library<Ros2EffectorMaker>(setup, encoding, folder, ros2_effector_function);
}

}  // namespace tessera
