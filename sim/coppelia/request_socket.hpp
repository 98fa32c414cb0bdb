#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "tessera/time.hpp"

namespace tessera::coppelia {

/// A ZeroMQ socket that sends requests to a server and gets one reply for each.
class RequestSocket {
 public:
  /// Errors: LinkError, see listening_address.
  RequestSocket(const std::string& host, std::uint16_t port, Duration patience);

  /// Errors: NoReply; LinkError: the server has closed the connection. The socket cannot be
  ///         used after that.
  [[nodiscard]] std::vector<std::uint8_t> ask(std::span<const std::uint8_t> request, Duration patience);

 private:
  struct CloseContext {
    void operator()(void* context) const;
  };
  struct CloseSocket {
    void operator()(void* socket) const;
  };
  using Context = std::unique_ptr<void, CloseContext>;
  using Socket = std::unique_ptr<void, CloseSocket>;

  [[nodiscard]] Socket make(int type) const;
  void set(int option, int value);
  void watch_connection();
  void throw_if_lost();
  [[nodiscard]] std::vector<std::uint8_t> receive();

  [[nodiscard]] std::string doubt() const;

  std::string name_;  // "localhost:23000"
  bool has_answered_ = false;
  Context context_;
  Socket socket_, monitor_;
};

}  // namespace tessera::coppelia
