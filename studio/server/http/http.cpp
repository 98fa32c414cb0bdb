#include "server/http/http.hpp"

#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <condition_variable>
#include <deque>
#include <mutex>
#include <string_view>
#include <thread>
#include <vector>

#include "server/http/connection.hpp"

namespace tessera::server {

namespace {

constexpr const char* loopback = "127.0.0.1";
constexpr int backlog = 256;
constexpr std::string_view too_many =
    "HTTP/1.1 503 Service Unavailable\r\nContent-Length: 0\r\nRetry-After: 1\r\nConnection: close\r\n\r\n";

/// The current connection gets no worker: sends this answer and closes it.
thread_local bool refusing = false;

/// Workers and a bounded queue. A task that does not fit into the queue is called at
/// once, with `refusing` set.
class BoundedQueue final : public httplib::TaskQueue {
 public:
  BoundedQueue(std::size_t workers, std::size_t waiting) : most_(waiting) {
    for (std::size_t worker = 0; worker < workers; ++worker) threads_.emplace_back([this] { work(); });
  }

  void enqueue(std::function<void()> connection) override {
    {
      const std::lock_guard lock(mutex_);
      if (waiting_.size() < most_) {
        waiting_.push_back(std::move(connection));
        connection = nullptr;
      }
    }
    if (!connection) return ready_.notify_one();
    refusing = true;
    connection();
    refusing = false;
  }

  void shutdown() override {
    {
      const std::lock_guard lock(mutex_);
      ending_ = true;
    }
    ready_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }

 private:
  void work() {
    for (;;) {
      std::unique_lock lock(mutex_);
      ready_.wait(lock, [this] { return ending_ || !waiting_.empty(); });
      if (waiting_.empty()) return;
      const std::function<void()> connection = std::move(waiting_.front());
      waiting_.pop_front();
      lock.unlock();
      connection();
    }
  }

  const std::size_t most_;
  std::mutex mutex_;
  std::condition_variable ready_;
  std::deque<std::function<void()>> waiting_;
  bool ending_ = false;
  std::vector<std::thread> threads_;
};

/// Leaves out SO_REUSEPORT, which httplib sets by default: it would let two servers share one port.
void set_options(socket_t socket) {
  const int yes = 1;
  setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
}

}  // namespace

HttpServer::HttpServer(HttpLimits limits) : limits_(limits), ended_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  set_payload_max_length(limits_.body_bytes);
  set_socket_options(set_options);
  set_tcp_nodelay(true);
  new_task_queue = [this] { return new BoundedQueue(limits_.workers, limits_.waiting); };
}

HttpServer::~HttpServer() { close(ended_); }

int HttpServer::bind(int port, int tries) {
  const auto bound = [this](int to) {
    ::listen(svr_sock_, backlog);  // httplib uses five
    return to;
  };
  if (port == 0) {
    const int any = bind_to_any_port(loopback);
    return any > 0 ? bound(any) : 0;
  }
  for (int next = port; next < port + tries && next <= 65535; ++next)
    if (bind_to_port(loopback, next)) return bound(next);
  return 0;
}

void HttpServer::serve() { listen_after_bind(); }

void HttpServer::shut_down() {
  ending_.store(true, std::memory_order_release);
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = write(ended_, &one, sizeof one);
  stop();
}

bool HttpServer::process_and_close_socket(socket_t socket) {
  bool done = false;
  if (refusing) {
    [[maybe_unused]] const ssize_t sent =
        send(socket, too_many.data(), too_many.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    shutdown(socket, SHUT_RDWR);
  } else {
    Connection connection(socket, limits_, ended_);
    bool closed = false;
    done = process_request(connection, /*close_connection=*/true, closed, nullptr);
    connection.finish();
  }
  close(socket);
  return done;
}

}  // namespace tessera::server
