#include "project/process/spawn.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <stdexcept>

namespace tessera::project {

pid_t spawn(const Command& command, posix_spawn_file_actions_t* actions, bool own_group) {
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // A process that waits for signals blocks them; the program that it starts must
  // receive them all the same.
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setflags(
      &attributes, static_cast<short>(POSIX_SPAWN_SETSIGMASK | (own_group ? POSIX_SPAWN_SETPGROUP : 0)));
  pid_t child = 0;
  const int problem = posix_spawnp(&child, arguments[0], actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  if (problem != 0)
    throw std::runtime_error(fmt::format("cannot start {}: {}", command[0], std::strerror(problem)));
  return child;
}

}  // namespace tessera::project
