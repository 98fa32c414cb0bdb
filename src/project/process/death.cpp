#include "project/process/death.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <vector>

namespace tessera::project {

namespace {

/// "; nothing has given the safe command to robot.motor.left, robot.motor.right"
std::string unprotected(const std::vector<std::string>& devices) {
  if (devices.empty()) return "";
  constexpr std::size_t shown = 16;
  const std::vector<std::string> first(
      devices.begin(), devices.begin() + static_cast<std::ptrdiff_t>(std::min(devices.size(), shown)));
  const std::string more = devices.size() > shown ? fmt::format(", and {} more", devices.size() - shown) : "";
  return fmt::format("; NOT SAFE, because nothing has given the safe command to {}{}", fmt::join(first, ", "),
                     more);
}

std::string describe_silent_death(const Exit& exit, bool is_noted) {
  if (exit.code == 0 || (is_noted && exit.code <= 128))
    return "the controller has ended without a message: something in it has called _exit, or replaced the "
           "program";
  if (exit.code <= 128) return "";
  const char* const name = sigabbrev_np(exit.code - 128);
  return fmt::format("the controller was killed by {}", name == nullptr
                                                            ? fmt::format("signal {}", exit.code - 128)
                                                            : fmt::format("SIG{}", name));
}

}  // namespace

std::string describe_death(const Exit& exit, const std::filesystem::path& note) {
  std::ifstream stream(note);
  std::string where, what;
  const bool is_noted = std::getline(stream, where) && std::getline(stream, what);
  if (is_noted && !what.empty())
    return what.starts_with("killed") ? fmt::format("the controller was {} in {}", what, where)
                                      : fmt::format("the controller has ended: {} {}", where, what);
  std::vector<std::string> devices;
  for (std::string device; is_noted && std::getline(stream, device);) devices.push_back(device);
  const std::string death = describe_silent_death(exit, is_noted);
  return death.empty() ? death : death + unprotected(devices);
}

}  // namespace tessera::project
