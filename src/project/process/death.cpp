#include "project/process/death.hpp"

#include <fmt/format.h>

#include <cstring>
#include <fstream>

namespace tessera::project {

std::string describe_death(const Exit& exit, const std::filesystem::path& note) {
  std::ifstream stream(note);
  std::string where, what;
  if (std::getline(stream, where) && std::getline(stream, what))
    return what.starts_with("killed") ? fmt::format("the controller was {} in {}", what, where)
                                      : fmt::format("the controller has ended: {} {}", where, what);
  if (exit.code == 0)
    return "the controller has ended without a message: something in it has called _exit, or replaced the "
           "program";
  if (exit.code <= 128) return "";
  const char* const name = sigabbrev_np(exit.code - 128);
  return fmt::format("the controller was killed by {}", name == nullptr
                                                            ? fmt::format("signal {}", exit.code - 128)
                                                            : fmt::format("SIG{}", name));
}

}  // namespace tessera::project
