#pragma once

#include <httplib.h>

#include <atomic>
#include <functional>
#include <string>

#include "server/http/http_limits.hpp"

namespace tessera::server {

/// An HTTP server on the loopback interface that no client can block: one request per connection, one
/// deadline for the whole request, limited bytes, limited connections. Handlers are those of httplib.
///
/// Threads: handlers run in worker threads; one thread calls start and stop.
class HttpServer : public httplib::Server {
 public:
  explicit HttpServer(HttpLimits limits = {});
  ~HttpServer() override;

  /// Binds to `port`, or to the next free one of `tries` ports; port 0: to any. Returns the
  /// port, or 0 if all are taken.
  [[nodiscard]] int bind(int port, int tries);
  /// Serves until shut_down, in the calling thread.
  void serve();
  /// Accepts no new connections and ends the open ones at once. Threads: any.
  void shut_down();
  [[nodiscard]] bool shutting_down() const { return ending_.load(std::memory_order_acquire); }
  [[nodiscard]] const HttpLimits& limits() const { return limits_; }

 private:
  bool process_and_close_socket(socket_t socket) override;

  HttpLimits limits_;
  std::atomic<bool> ending_{false};
  int ended_ = -1;  ///< eventfd, readable once the server ends
};

}  // namespace tessera::server
