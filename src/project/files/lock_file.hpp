#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "project/process/listener.hpp"

namespace tessera::project {

/// A lock that the kernel keeps on a file: over processes and threads, gone when its holder dies.
///
/// Threads: each has its own.
class LockFile {
 public:
  enum class Mode : std::uint8_t { shared, exclusive };
  /// Makes the file if need be. nullopt: another one holds it. Throws std::runtime_error when the file cannot
  /// be opened.
  [[nodiscard]] static std::optional<LockFile> try_take(const std::filesystem::path& file, Mode mode);
  LockFile(LockFile&& other) noexcept;
  LockFile& operator=(LockFile&& other) noexcept;
  LockFile(const LockFile&) = delete;
  LockFile& operator=(const LockFile&) = delete;
  ~LockFile();
  /// Who looks at the file reads this.
  void write(const std::string& text) const;
  /// Programs that are started from now on hold the lock too, until the last of them has ended.
  void goes_to_children() const;

 private:
  explicit LockFile(int descriptor) : descriptor_(descriptor) {}
  int descriptor_ = -1;
};

/// While it lives, nobody else generates or compiles in that state folder. Waits for who does, and tells the
/// listener who that is. nullopt: `stop` has become true meanwhile.
[[nodiscard]] std::optional<LockFile> take_build_lock(const std::filesystem::path& state, Listener& listener,
                                                      const std::atomic<bool>* stop);

}  // namespace tessera::project
