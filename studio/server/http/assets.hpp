#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

namespace tessera::server {

/// The files of the page, read once: what is not among them cannot be asked for.
///
/// Threads: any, once made.
class Assets {
 public:
  struct Asset {
    std::shared_ptr<const std::string> bytes;
    std::shared_ptr<const std::string> packed;  ///< by gzip; nullptr: that saves nothing
    std::string type;
  };
  /// folder: as Vite builds it, with an index.html; it need not exist.
  explicit Assets(const std::filesystem::path& folder);
  /// path: "/" or "/assets/index.js". nullptr: there is none.
  [[nodiscard]] const Asset* find(const std::string& path) const;

 private:
  std::map<std::string, Asset> files_;
};

}  // namespace tessera::server
