#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "project/process/listener.hpp"

namespace tessera::project {

/// A lock on a file, kept by the kernel. It works across processes and threads, and
/// ends when its holder dies.
///
/// Threads: each has its own.
class LockFile {
 public:
  enum class Mode : std::uint8_t { shared, exclusive };
  /// Makes the file if it does not exist. nullopt: another one holds the lock. Throws std::runtime_error
  /// if the file cannot be opened.
  [[nodiscard]] static std::optional<LockFile> try_take(const std::filesystem::path& file, Mode mode);
  LockFile(LockFile&& other) noexcept;
  LockFile& operator=(LockFile&& other) noexcept;
  LockFile(const LockFile&) = delete;
  LockFile& operator=(const LockFile&) = delete;
  ~LockFile();
  /// Writes a text that readers of the file see.
  void write(const std::string& text) const;
  /// Programs that are started from now on also hold the lock, until the last of them has ended.
  void goes_to_children() const;

 private:
  explicit LockFile(int descriptor) : descriptor_(descriptor) {}
  int descriptor_ = -1;
};

/// While the lock exists, no other process or thread generates or compiles in that state folder. Waits for
/// the holder and tells the listener who that is. nullopt: `stop` became true in the meantime.
[[nodiscard]] std::optional<LockFile> take_build_lock(const std::filesystem::path& state, Listener& listener,
                                                      const std::atomic<bool>* stop);

}  // namespace tessera::project
