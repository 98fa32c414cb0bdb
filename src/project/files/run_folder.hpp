#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "project/files/lock_file.hpp"
#include "project/process/listener.hpp"

namespace tessera::project {

/// The folder of one run, STATE/runs/20261122-091530-simulate-1: recording, summary, and the program
/// that made them. Only this run writes there. No other run removes the folder while this object exists, or
/// while the controller runs, which inherits its lock.
///
/// When a run begins, old folders are removed until at most 100 are left that take at most 4 GB together.
/// TESSERA_KEEP_RUNS=N and TESSERA_KEEP_RUNS_SIZE=2GB change these limits (0: no limit). A folder stays if
/// `last` points to it or it contains a file `keep`. Files that Tessera did not write stay, too.
///
/// Threads: each run has its own.
class RunFolder {
 public:
  enum class Shown : std::uint8_t { no, as_last };
  /// mode: "simulate". as_last: the symbolic link STATE/last points to it from now on. Throws
  /// std::runtime_error if the folder cannot be made.
  RunFolder(const std::filesystem::path& state, const std::string& mode, Shown shown, Listener& listener);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// The program under a name in this folder, where it stays what it is.
  [[nodiscard]] std::filesystem::path own_copy_of(const std::filesystem::path& program) const;
  /// Programs that are started from now on keep it in use too.
  void goes_to_children() const { in_use_.goes_to_children(); }
  /// For a controller that ended before it began to run: removes its files, and makes STATE/last point
  /// to the same run as before.
  void withdraw() const;

 private:
  RunFolder(const std::filesystem::path& state, const std::string& mode, Shown shown, Listener& listener,
            const LockFile& held);
  std::filesystem::path path_, before_;  ///< before_: the earlier target of STATE/last
  LockFile in_use_;
};

/// "500MB", "2GB", "1000" (bytes); as `--record-limit` has it. Throws std::runtime_error, which names `what`.
[[nodiscard]] std::uint64_t parse_size(const std::string& text, const std::string& what);

}  // namespace tessera::project
