#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

namespace tessera::server {

/// The files of the page, read once. No other file can be requested.
///
/// Threads: any, after construction.
class Assets {
 public:
  struct Asset {
    std::shared_ptr<const std::string> bytes;
    std::shared_ptr<const std::string> packed;  ///< compressed by gzip; nullptr: compression saves nothing
    std::string type;
  };
  /// folder: as Vite builds it, with an index.html; it need not exist.
  explicit Assets(const std::filesystem::path& folder);
  /// path: "/", "/operate" or "/assets/index.js". nullptr: there is no such file.
  [[nodiscard]] const Asset* find(const std::string& path) const;

 private:
  std::map<std::string, Asset> files_;
};

}  // namespace tessera::server
