#pragma once

#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <thread>

namespace tessera::server {

/// Calls back when a file may have changed: it was written, replaced, made or removed, by any process.
///
/// Threads: the callback runs in a thread of the watch, until its destructor returns.
class FileWatch {
 public:
  FileWatch(const std::filesystem::path& file, std::function<void()> changed);
  ~FileWatch();
  FileWatch(const FileWatch&) = delete;
  FileWatch& operator=(const FileWatch&) = delete;

 private:
  void watch(const std::set<std::string>& names);
  [[nodiscard]] bool concerns(const std::set<std::string>& names) const;

  std::function<void()> changed_;
  int events_ = -1, ended_ = -1;
  std::thread thread_;
};

}  // namespace tessera::server
