#include "safety/device_claims.hpp"

#include <fmt/core.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string_view>
#include <system_error>
#include <variant>
#include <vector>

#include "drivers/devices.hpp"

namespace tessera {
namespace {

namespace fs = std::filesystem;

/// The identity of a folder, which is the same for every path to it.
std::string identity_of(const fs::path& folder) {
  struct stat status {};
  if (stat(folder.c_str(), &status) != 0) return folder.string();
  return fmt::format("{}:{}", status.st_dev, status.st_ino);
}

/// Terminals, such as /dev/ttyUSB0, also by another name (/dev/serial/by-id). Other devices, such as an I2C bus, may
/// well be shared.
std::set<std::string> serial_devices(const CppDriver& driver) {
  std::set<std::string> files;
  for (const DriverOption& option : driver.options) {
    const auto* const text = std::get_if<std::string_view>(&option.value);
    if (text == nullptr || !text->starts_with("/dev/")) continue;
    std::error_code problem;
    const fs::path file = fs::canonical(fs::path(*text), problem);
    if (!problem && file.native().starts_with("/dev/tty")) files.insert(file.string());
  }
  return files;
}

}  // namespace

std::string project_of_this_program() {
  std::error_code problem;
  const fs::path program = fs::read_symlink("/proc/self/exe", problem);
  for (fs::path folder = program.parent_path(); folder.has_relative_path(); folder = folder.parent_path())
    if (folder.filename() == ".tessera") return folder.parent_path().string();
  return program.parent_path().string();
}

DeviceClaims::DeviceClaims(const System& system, const RunOptions& options) {
  if (options.also || options.project.empty() || !opens_real_devices(system, options)) return;
  std::set<std::string> files;
  for (const CppDriver& driver : system.real_drivers)
    if (opens_real_driver(options, driver.path) && is_of(system, driver)) files.merge(serial_devices(driver));
  const std::string& process = options.network.process;
  claim({"devices", identity_of(options.project), std::string(system.name), process},
        fmt::format("the real devices of {}{}{}", system.name, process.empty() ? "" : ".", process));
  for (const std::string& file : files) claim({"device", file}, file);
}

void DeviceClaims::claim(const std::vector<std::string>& parts, const std::string& what) {
  const std::optional<std::int64_t>& other = claims_.emplace_back(parts).other();
  if (!other || refusal_) return;
  refusal_ = *other > 0 ? fmt::format(
                              "process {0} uses {1} already: stop it first (`kill {0}` stops it safely), or "
                              "add --also if both are to command them",
                              *other, what)
                        : fmt::format(
                              "another process uses {} already: stop it first, or add --also if both are to "
                              "command them",
                              what);
}

}  // namespace tessera
