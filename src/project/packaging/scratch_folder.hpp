#pragma once

#include <filesystem>
#include <string>

namespace tessera::project {

/// A folder for work in between, which is removed with the object.
class ScratchFolder {
 public:
  /// beside: a folder in which it is made; empty: that of the system for temporary files. Throws
  /// std::runtime_error if it cannot be made.
  explicit ScratchFolder(const std::filesystem::path& beside = {});
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace tessera::project
