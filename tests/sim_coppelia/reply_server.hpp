#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace tessera::testing {

using Bytes = std::vector<std::uint8_t>;

/// A ZeroMQ REP socket on a free port of the loopback interface, in a thread of its own.
class ReplyServer {
 public:
  /// Called by the thread for each request. nullopt: it never answers again, as a program that hangs.
  using Answer = std::function<std::optional<Bytes>(const Bytes& request)>;

  explicit ReplyServer(Answer answer, std::uint16_t port = 0);
  ReplyServer(const ReplyServer&) = delete;
  ReplyServer& operator=(const ReplyServer&) = delete;
  ~ReplyServer() { stop(); }

  [[nodiscard]] std::uint16_t port() const { return port_; }
  /// Closes the socket, as a program that ends.
  void stop();

 private:
  void serve();

  Answer answer_;
  void* context_;
  void* socket_;
  std::uint16_t port_ = 0;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

}  // namespace tessera::testing
