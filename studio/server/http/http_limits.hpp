#pragma once

#include <chrono>
#include <cstddef>

namespace tessera::server {

/// Limits for one connection, and for all of them together.
struct HttpLimits {
  std::size_t workers = 64;   ///< requests that are served at the same time
  std::size_t waiting = 128;  ///< connections that wait for a worker; more are refused (503)
  std::size_t head_bytes = std::size_t{32} << 10U;
  std::size_t body_bytes = std::size_t{8} << 20U;
  std::chrono::milliseconds read{5'000};   ///< for a whole request: head and body
  std::chrono::milliseconds write{5'000};  ///< for a piece of the answer
};

}  // namespace tessera::server
