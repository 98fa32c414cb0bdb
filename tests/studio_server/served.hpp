#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "project/files/files.hpp"
#include "server/studio.hpp"

namespace tessera::server_test {

namespace fs = std::filesystem;

using project::content_of;
void write(const fs::path& file, const std::string& text);

using Headers = std::multimap<std::string, std::string>;

/// The result of a request.
struct Reply {
  int status = 0;  ///< 0: no answer
  std::string body;
  Headers headers;
  [[nodiscard]] nlohmann::json json() const { return nlohmann::json::parse(body, nullptr, false); }
};

/// The events of one browser; each that comes is judged by its schema.
class EventStream {
 public:
  EventStream(int port, const std::string& token);
  ~EventStream();
  EventStream(const EventStream&) = delete;
  EventStream& operator=(const EventStream&) = delete;
  /// The next event of that name that `wanted` accepts; others are skipped. null: the stream ended, no event
  /// came for a minute, or none that was wanted for four.
  [[nodiscard]] nlohmann::json next(const std::string& name,
                                    const std::function<bool(const nlohmann::json&)>& wanted = {});

 private:
  [[nodiscard]] std::optional<std::string> line();
  int socket_ = -1;
  std::string bytes_;
};

/// Makes `to` the same as `from`, but for `.tessera`; files that are the same already keep their dates.
void mirror(const fs::path& from, const fs::path& to);

/// A studio of a project of its own, which is a copy of the line follower.
class Served : public testing::Test {
 protected:
  Served() : Served(fs::temp_directory_path() / ("tessera_studio_" + std::to_string(getpid()))) {}
  /// `folder`: of the project; an earlier build in it is kept.
  explicit Served(fs::path folder);
  ~Served() override;
  void serve();

  [[nodiscard]] Reply get(const std::string& path) const { return ask("GET", path, {}); }
  [[nodiscard]] Reply put(const std::string& path, const nlohmann::json& body) const {
    return ask("PUT", path, body.dump());
  }
  [[nodiscard]] Reply post(const std::string& path, const nlohmann::json& body) const {
    return ask("POST", path, body.dump());
  }
  /// Every request to the API and every answer is judged by its schema.
  [[nodiscard]] Reply ask(const std::string& method, const std::string& path, const std::string& body) const;
  /// Those headers and no others.
  [[nodiscard]] Reply ask_with(const Headers& headers, const std::string& method, const std::string& path,
                               const std::string& body) const;
  [[nodiscard]] std::string host() const { return "127.0.0.1:" + std::to_string(port_); }
  [[nodiscard]] Headers own_headers() const {
    return {{"Host", host()}, {"Authorization", "Bearer " + token_}};
  }
  [[nodiscard]] fs::path spec() const { return folder_ / "project/spec.yaml"; }

  fs::path folder_;
  bool keep_ = false;  ///< the folder stays when the test ends
  server::StudioOptions options_;
  std::unique_ptr<server::Studio> studio_;
  int port_ = 0;
  std::string token_;
};

/// Connects to the port; the socket.
[[nodiscard]] int connect_to(int port);
/// Sends all of it; false: the other side has closed.
bool send_all(int socket, const std::string& bytes);
/// The text until the other side closes, or for a minute.
[[nodiscard]] std::string receive_all(int socket);

}  // namespace tessera::server_test
