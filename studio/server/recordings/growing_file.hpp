#pragma once

#include <filesystem>
#include <string>

namespace tessera::server {

/// Reads the bytes that are appended to a file. The file need not exist yet.
class GrowingFile {
 public:
  explicit GrowingFile(std::filesystem::path file) : path_(std::move(file)) {}
  ~GrowingFile();
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;
  /// At most `most` bytes at a time; empty: nothing new.
  [[nodiscard]] std::string more(std::size_t most = std::size_t{4} << 20U);

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
};

}  // namespace tessera::server
