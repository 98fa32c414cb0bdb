#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "project/files/lock_file.hpp"
#include "project/process/listener.hpp"

namespace tessera::project {

/// The folder of one run, STATE/runs/20261122-091530-simulate-1: recording, path, summary, and the program
/// that made them. Nobody else writes there. While it lives (and while the controller does, which inherits
/// its lock), no other run removes it.
///
/// When a run begins, old ones are removed until at most 100 are left that take at most 4 GB together:
/// TESSERA_KEEP_RUNS=N and TESSERA_KEEP_RUNS_SIZE=2GB say otherwise (0: no limit). One stays if `last` shows
/// it or a file `keep` is in it, and so does everything that Tessera has not written.
///
/// Threads: each run has its own.
class RunFolder {
 public:
  enum class Shown : std::uint8_t { no, as_last };
  /// mode: "simulate". as_last: STATE/last is a symbolic link to it from now on.
  /// Throws std::runtime_error when it cannot be made.
  RunFolder(const std::filesystem::path& state, const std::string& mode, Shown shown, Listener& listener);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// The program under a name in this folder, where it stays what it is.
  [[nodiscard]] std::filesystem::path own_copy_of(const std::filesystem::path& program) const;
  /// Programs that are started from now on keep it in use too.
  void goes_to_children() const { in_use_.goes_to_children(); }
  /// The controller is over and has not begun to run: what it has left goes, and STATE/last shows the run
  /// that it showed before.
  void withdraw() const;

 private:
  RunFolder(const std::filesystem::path& state, const std::string& mode, Shown shown, Listener& listener,
            const LockFile& held);
  std::filesystem::path path_, before_;  ///< before_: what STATE/last was then
  LockFile in_use_;
};

/// "500MB", "2GB", "1000" (bytes); as `--record-limit` has it. Throws std::runtime_error, which names `what`.
[[nodiscard]] std::uint64_t parse_size(const std::string& text, const std::string& what);

}  // namespace tessera::project
