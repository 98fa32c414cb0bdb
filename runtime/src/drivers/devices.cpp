#include "drivers/devices.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "drivers/driver_watch.hpp"
#include "drivers/substitutes.hpp"
#include "drivers/whole_driver.hpp"

namespace tessera {
namespace {

/// The differences between receptors and effectors.
struct ReceptorKind {
  using Base = RealReceptor;
  static constexpr bool effector = false;
  static constexpr auto maker = &CppDriver::receptor;
  static constexpr auto of_world = &World::receptor;
  static constexpr auto of_test = &Substitutes::receptor;
  static const auto& buffers(const Bindings& bindings) { return bindings.real_inputs; }
  static auto& devices(SubsystemDevices& devices) { return devices.receptors; }
};
struct EffectorKind {
  using Base = RealEffector;
  static constexpr bool effector = true;
  static constexpr auto maker = &CppDriver::effector;
  static constexpr auto of_world = &World::effector;
  static constexpr auto of_test = &Substitutes::effector;
  static const auto& buffers(const Bindings& bindings) { return bindings.real_outputs; }
  static auto& devices(SubsystemDevices& devices) { return devices.effectors; }
};

/// Whether `path` is `name` or something in it: "robot.motor.left" is in "robot.motor".
[[nodiscard]] bool is_in(std::string_view path, std::string_view name) {
  return path.starts_with(name) && (path.size() == name.size() || path[name.size()] == '.');
}

}  // namespace

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
  const auto open = reinterpret_cast<OpenWorld>(dlsym(library, open_world_function));
  if (open == nullptr) {
    error = fmt::format("'{}' is no library of worlds of this version: it has no function {}",
                        options.world_library, open_world_function);
    return nullptr;
  }
  try {
    return open(*options.world, error);
  } catch (const std::exception& exception) {
    error = exception.what();
  }
  return nullptr;
}

bool simulates_devices(const RunOptions& options) {
  return options.clock == RunOptions::Clock::simulated || options.world || options.simulated_drivers;
}

bool opens_real_driver(const RunOptions& options, std::string_view path) {
  return !simulates_devices(options) ||
         std::ranges::any_of(options.hardware, [&](const std::string& name) { return is_in(path, name); });
}

bool is_of(const System& system, const CppDriver& driver) {
  return std::ranges::any_of(system.instances, [&](const Instance& instance) {
    const std::string path = fmt::format("{}.{}", instance.agent, instance.name);
    return driver.path == path || driver.path.starts_with(path + ".");
  });
}

bool opens_real_devices(const System& system, const RunOptions& options) {
  return std::ranges::any_of(system.real_drivers, [&](const CppDriver& driver) {
    return opens_real_driver(options, driver.path) && is_of(system, driver);
  });
}

/// Also notes that the hardware of this name was found.
bool DeviceFinder::is_hardware(const std::string& path) {
  if (!simulates_devices(options_)) return true;
  bool found = false;
  for (const std::string& name : options_.hardware)
    if (is_in(path, name)) {
      hardware_.insert(name);
      found = true;
    }
  return found;
}

const CppDriver* DeviceFinder::cpp_driver(const std::string& path, bool hardware) const {
  const auto& drivers = hardware ? system_.real_drivers : system_.simulated_drivers;
  const auto found =
      std::find_if(drivers.begin(), drivers.end(), [&](const CppDriver& one) { return one.path == path; });
  return found == drivers.end() ? nullptr : &*found;
}

template <class Kind>
std::unique_ptr<typename Kind::Base> DeviceFinder::make(const CppDriver& driver) {
  std::string why = "it was made for another kind of buffer";
  try {
    const DriverSetup setup(std::string(driver.path), {driver.options.begin(), driver.options.end()},
                            world_for(driver));
    const DriverWatch::Call call(DriverWatch::Step::constructor, driver.path);
    if (driver.*Kind::maker != nullptr)
      if (auto device = (driver.*Kind::maker)(setup); device != nullptr) return device;
  } catch (const std::exception& exception) {
    why = exception.what();
  } catch (...) {
    why = "its constructor threw an exception that is no std::exception";
  }
  const std::string place = driver.place == nullptr ? "" : fmt::format("{}: ", *driver.place);
  complaints_.push_back(fmt::format("{}the driver {} of {}: {}", place, driver.class_name, driver.path, why));
  return nullptr;
}

/// Only simulated drivers see the simulated world.
std::shared_ptr<WorldState> DeviceFinder::world_for(const CppDriver& driver) const {
  const auto& simulated = system_.simulated_drivers;
  const bool is_simulated = !simulated.empty() && &driver >= simulated.data() && &driver <= &simulated.back();
  if (world_ == nullptr || !is_simulated) return nullptr;
  return world_->state(std::string(driver.path.substr(0, driver.path.find('.'))));
}

template <class Kind>
std::unique_ptr<typename Kind::Base> DeviceFinder::find_one(const std::string& path,
                                                            const ValueEncoding* encoding) {
  if (options_.substitutes != nullptr) return (options_.substitutes->*Kind::of_test)(path);
  const bool hardware = is_hardware(path);
  if (!hardware || !simulates_devices(options_))
    for (DriverRequest request : options_.drivers) {
      if (request.path != path) continue;
      request.encoding = encoding;
      if (encoding != nullptr) request.type = encoding->type();
      std::string error = "there is no world to find it in (--world)";
      std::unique_ptr<typename Kind::Base> device;
      if (world_ != nullptr) device = (world_->*Kind::of_world)(request, error);
      if (device == nullptr)
        complaints_.push_back(
            fmt::format("{} ({} '{}'): {}", path, request.kind, fmt::join(request.targets, "', '"), error));
      return device;
    }
  if (const CppDriver* const driver = cpp_driver(path, hardware)) return make<Kind>(*driver);
  complaints_.push_back(
      fmt::format("the real buffer {} has no {}driver", path, hardware ? "" : "simulated "));
  return nullptr;
}

/// true: one driver serves all real buffers, or should.
template <class Kind>
bool DeviceFinder::find_whole(const std::string& subsystem, const Bindings& bindings,
                              SubsystemDevices& devices) {
  const CppDriver* const driver = cpp_driver(subsystem, is_hardware(subsystem));
  if (driver == nullptr || options_.substitutes != nullptr) return false;
  std::unique_ptr<typename Kind::Base> device = make<Kind>(*driver);
  if (device == nullptr) return true;
  if (bindings.real.value == nullptr) {
    complaints_.push_back(fmt::format("{} does not know the structure of its real buffers", subsystem));
    return true;
  }
  devices.drivers.push_back({subsystem, device.get(), 0, Kind::buffers(bindings).size(), Kind::effector});
  Kind::devices(devices) = parts_of(std::move(device), bindings);
  return true;
}

template <class Kind>
void DeviceFinder::find_all(const std::string& subsystem, const Bindings& bindings,
                            SubsystemDevices& devices) {
  const auto& buffers = Kind::buffers(bindings);
  if (buffers.empty()) return;
  paths_.insert(subsystem);
  for (const auto& buffer : buffers) paths_.insert(fmt::format("{}.{}", subsystem, buffer.name));
  if (find_whole<Kind>(subsystem, bindings, devices)) return;
  for (std::size_t index = 0; index < buffers.size(); ++index) {
    const std::string path = fmt::format("{}.{}", subsystem, buffers[index].name);
    std::unique_ptr<typename Kind::Base> device = find_one<Kind>(path, buffers[index].encoding);
    if (device != nullptr) devices.drivers.push_back({path, device.get(), index, 1, Kind::effector});
    Kind::devices(devices).push_back(std::move(device));
  }
}

SubsystemDevices DeviceFinder::find(const std::string& subsystem, const Bindings& bindings) {
  SubsystemDevices devices;
  find_all<ReceptorKind>(subsystem, bindings, devices);
  find_all<EffectorKind>(subsystem, bindings, devices);
  return devices;
}

std::optional<Problem> DeviceFinder::complaints() const {
  std::string text;
  const auto say = [&](const std::string& sentence) { text += (text.empty() ? "" : "\n") + sentence; };
  for (const std::string& complaint : complaints_) say(complaint);
  for (const DriverRequest& request : options_.drivers)
    if (!paths_.contains(request.path))
      say(fmt::format("a driver is given for '{}', which is no real buffer", request.path));
  for (const std::string& name : options_.hardware)
    if (!hardware_.contains(name))
      say(fmt::format(
          "hardware is asked for at '{}', which is neither a real buffer with a driver of its own nor "
          "a subsystem with real buffers",
          name));
  if (text.empty()) return std::nullopt;
  return Problem{std::move(text)};
}

}  // namespace tessera
