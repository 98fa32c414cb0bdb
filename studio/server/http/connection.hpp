#pragma once

#include <httplib.h>

#include <array>
#include <chrono>

#include "server/http/http_limits.hpp"

namespace tessera::server {

/// The bytes of one connection. Reading ends for good at the deadline of the request or when the request is
/// too long. Writing ends when the client accepts no data for too long.
class Connection final : public httplib::Stream {
 public:
  /// ended: a descriptor that becomes readable when the server ends.
  Connection(socket_t socket, const HttpLimits& limits, int ended);

  [[nodiscard]] bool is_readable() const override { return readable_; }
  /// Whether the client is still connected. Does not wait.
  [[nodiscard]] bool is_writable() const override;
  ssize_t read(char* to, size_t size) override;
  ssize_t write(const char* from, size_t size) override;
  void get_remote_ip_and_port(std::string& ip, int& port) const override;
  void get_local_ip_and_port(std::string& ip, int& port) const override;
  [[nodiscard]] socket_t socket() const override { return socket_; }

  /// Signals the end of the answer, and for a moment takes what the client is still sending, so that the
  /// client reads the answer and not a reset.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  [[nodiscard]] bool wait(short events, Clock::time_point until) const;
  [[nodiscard]] bool fill();
  void look_for_end_of_head();

  socket_t socket_;
  const HttpLimits& limits_;
  int ended_;
  Clock::time_point deadline_;
  std::size_t left_;           ///< bytes that may still be read
  std::size_t ends_head_ = 0;  ///< how many of the four bytes that end the head were just read
  std::array<char, 8192> buffer_{};
  std::size_t next_ = 0, filled_ = 0;
  bool readable_ = true;
};

}  // namespace tessera::server
