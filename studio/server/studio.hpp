#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "server/http/http_limits.hpp"

namespace tessera::server {

struct StudioOptions {
  std::filesystem::path spec;   ///< the file that is edited; the studio reads and writes only in its folder
  int port = 8417;              ///< 0: any
  int tries = 50;               ///< `port` and the next ports, until one is free
  std::filesystem::path page;   ///< folder of the built page; it need not exist
  std::filesystem::path share;  ///< worlds/ and tracks/
  std::string version;
  std::filesystem::path command = {};  ///< `tessera`; empty: this process is it
  HttpLimits limits = {};
};

/// `tessera studio`: serves the page and its data (docs/reference/studio.md has the protocol). It serves on the
/// loopback interface from construction to destruction; jobs and runs end with it.
///
/// Threads: one thread makes and destroys it.
class Studio {
 public:
  /// Throws std::runtime_error if the folder cannot be opened or all ports are taken.
  explicit Studio(const StudioOptions& options);
  ~Studio();
  Studio(const Studio&) = delete;
  Studio& operator=(const Studio&) = delete;

  [[nodiscard]] int port() const;
  [[nodiscard]] const std::string& token() const;
  /// The address to open: "http://127.0.0.1:8417/#token=..."
  [[nodiscard]] std::string url() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace tessera::server
