#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "eventually.hpp"

namespace tessera {

/// The other processes that work in a folder.
inline std::vector<pid_t> processes_in(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  std::error_code gone;  // processes end while they are looked at
  const std::string below = fs::weakly_canonical(folder, gone).string();
  std::vector<pid_t> found;
  if (below.empty()) return found;
  for (const auto& process : fs::directory_iterator("/proc", gone)) {
    const std::string name = process.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos || name == std::to_string(getpid()))
      continue;
    const std::string at = fs::read_symlink(process.path() / "cwd", gone).string();
    if (!gone && at.starts_with(below) && (at.size() == below.size() || at[below.size()] == '/'))
      found.push_back(std::stoi(name));
  }
  return found;
}

/// Removes the folder of a test when the processes that the test left in it have ended. Those that do not end fail
/// the test.
inline void remove_scratch(const std::filesystem::path& folder) {
  if (!eventually([&] { return processes_in(folder).empty(); }))
    for (const pid_t process : processes_in(folder))
      ADD_FAILURE() << "process " << process << " still runs in " << folder;
  std::error_code error;  // fixtures call this from their destructors
  std::filesystem::remove_all(folder, error);
  if (error) ADD_FAILURE() << "cannot remove " << folder << ": " << error.message();
}

}  // namespace tessera
