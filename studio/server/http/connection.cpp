#include "server/http/connection.hpp"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string_view>

namespace tessera::server {

Connection::Connection(socket_t socket, const HttpLimits& limits, int ended)
    : socket_(socket),
      limits_(limits),
      ended_(ended),
      deadline_(Clock::now() + limits.read),
      left_(limits.head_bytes) {}

bool Connection::wait(short events, Clock::time_point until) const {
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
    if (left <= 0) return false;
    std::array<pollfd, 2> sources{pollfd{.fd = socket_, .events = events, .revents = 0},
                                  pollfd{.fd = ended_, .events = POLLIN, .revents = 0}};
    const int ready = poll(sources.data(), sources.size(), static_cast<int>(left));
    if (ready < 0 && errno == EINTR) continue;
    return ready > 0 && (sources[1].revents & POLLIN) == 0;
  }
}

bool Connection::is_writable() const {
  pollfd source{.fd = socket_, .events = POLLOUT | POLLRDHUP, .revents = 0};
  if (poll(&source, 1, 0) < 0) return errno == EINTR;
  return (source.revents & (POLLERR | POLLHUP | POLLRDHUP | POLLNVAL)) == 0;
}

bool Connection::fill() {
  if (!readable_ || left_ == 0 || !wait(POLLIN, deadline_)) return false;
  const ssize_t count = recv(socket_, buffer_.data(), std::min(buffer_.size(), left_), MSG_DONTWAIT);
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return fill();
  if (count <= 0) return false;
  left_ -= static_cast<std::size_t>(count);
  next_ = 0;
  filled_ = static_cast<std::size_t>(count);
  look_for_end_of_head();
  return true;
}

/// A body may follow the head.
void Connection::look_for_end_of_head() {
  constexpr std::string_view end = "\r\n\r\n";
  for (std::size_t at = 0; at < filled_ && ends_head_ < end.size(); ++at) {
    ends_head_ = buffer_[at] == end[ends_head_] ? ends_head_ + 1 : buffer_[at] == '\r' ? 1 : 0;
    if (ends_head_ == end.size()) left_ = limits_.body_bytes;
  }
}

ssize_t Connection::read(char* to, size_t size) {
  if (next_ == filled_ && !fill()) {
    readable_ = false;
    return -1;
  }
  const std::size_t count = std::min(size, filled_ - next_);
  std::memcpy(to, buffer_.data() + next_, count);
  next_ += count;
  return static_cast<ssize_t>(count);
}

ssize_t Connection::write(const char* from, size_t size) {
  std::size_t written = 0;
  while (written < size) {
    if (!wait(POLLOUT, Clock::now() + limits_.write)) return -1;
    const ssize_t count = send(socket_, from + written, size - written, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) continue;
    if (count <= 0) return -1;
    written += static_cast<std::size_t>(count);
  }
  return static_cast<ssize_t>(written);
}

void Connection::get_remote_ip_and_port(std::string& ip, int& port) const {
  sockaddr_in address{};
  socklen_t length = sizeof address;
  if (getpeername(socket_, reinterpret_cast<sockaddr*>(&address), &length) != 0) return;
  ip = inet_ntoa(address.sin_addr);
  port = ntohs(address.sin_port);
}

void Connection::get_local_ip_and_port(std::string& ip, int& port) const {
  sockaddr_in address{};
  socklen_t length = sizeof address;
  if (getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &length) != 0) return;
  ip = inet_ntoa(address.sin_addr);
  port = ntohs(address.sin_port);
}

void Connection::finish() {
  constexpr auto patience = std::chrono::milliseconds(500);
  std::size_t most = std::size_t{16} << 20U;
  shutdown(socket_, SHUT_WR);
  const Clock::time_point until = Clock::now() + patience;
  while (wait(POLLIN, until)) {
    const ssize_t count = recv(socket_, buffer_.data(), buffer_.size(), MSG_DONTWAIT);
    if (count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR)) return;
    most -= std::min(most, static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    if (most == 0) return;
  }
}

}  // namespace tessera::server
