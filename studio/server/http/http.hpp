#pragma once

#include <httplib.h>

#include <atomic>
#include <functional>
#include <string>

#include "server/http/http_limits.hpp"

namespace tessera::server {

/// An HTTP server on the loopback interface that no client can hold up: one request a connection, a deadline
/// for all of it, bounded bytes, bounded connections. Handlers are those of httplib.
///
/// Threads: handlers run in worker threads; start and stop in one.
class HttpServer : public httplib::Server {
 public:
  explicit HttpServer(HttpLimits limits = {});
  ~HttpServer() override;

  /// Binds to the port, or to the next one that is free of `tries`; 0: any. The port, or 0 when all are
  /// taken.
  [[nodiscard]] int bind(int port, int tries);
  /// Serves until shut_down, in the calling thread.
  void serve();
  /// From any thread: no new connections; connections that are open end at once.
  void shut_down();
  [[nodiscard]] bool shutting_down() const { return ending_.load(std::memory_order_acquire); }
  [[nodiscard]] const HttpLimits& limits() const { return limits_; }

 private:
  bool process_and_close_socket(socket_t socket) override;

  HttpLimits limits_;
  std::atomic<bool> ending_{false};
  int ended_ = -1;  ///< eventfd, readable once it ends
};

}  // namespace tessera::server
