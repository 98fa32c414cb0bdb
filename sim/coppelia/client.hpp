#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "sim/coppelia/request_socket.hpp"
#include "tessera/device.hpp"

namespace tessera::coppelia {

/// Calls functions of CoppeliaSim over its ZeroMQ remote API, protocol version 2.
///
/// Each request and each reply is one map in CBOR. While the simulator is busy with a call, it may ask the
/// client to wait or to ask again; this class answers both. A call takes at most the timeout of the server's
/// settings, however often that happens.
///
/// Threads: one at a time.
class Client {
 public:
  /// Errors: LinkError, see RequestSocket.
  explicit Client(const WorldServer& server);
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;
  /// Signs off from the server, unless the connection is lost.
  ~Client();

  [[nodiscard]] bool is_lost() const { return lost_; }
  /// The results of the function, as an array. arguments: an array.
  ///
  /// Errors: RefusedCall: the simulator gives the reason. LinkError: after it, every call fails so.
  [[nodiscard]] nlohmann::json call(const std::string& function, nlohmann::json arguments, Duration patience);

 private:
  [[nodiscard]] nlohmann::json exchange(nlohmann::json request, Duration patience);

  RequestSocket socket_;
  std::string name_;  // "localhost:23000"
  std::string uuid_;
  bool introduced_ = false;
  bool lost_ = false;
};

}  // namespace tessera::coppelia
