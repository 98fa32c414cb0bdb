#pragma once

#include <filesystem>
#include <functional>
#include <mutex>
#include <set>
#include <string>
#include <thread>

namespace tessera::server {

/// Calls back when one of some files may have changed: it was written, replaced, made or removed, by any process.
///
/// Threads: any; the callback runs in a thread of the watch, until its destructor returns.
class FileWatch {
 public:
  FileWatch(const std::filesystem::path& file, std::function<void()> changed);
  ~FileWatch();
  FileWatch(const FileWatch&) = delete;
  FileWatch& operator=(const FileWatch&) = delete;

  /// Watches another file, too, if its folder is there.
  void add(const std::filesystem::path& file);

 private:
  void watch();
  [[nodiscard]] bool concerns();

  std::function<void()> changed_;
  int events_ = -1, ended_ = -1;
  std::mutex mutex_;
  std::set<std::string> names_;  ///< of the files, without their folders
  std::thread thread_;
};

}  // namespace tessera::server
