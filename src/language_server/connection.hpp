#pragma once

#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace tessera::language_server {

/// Messages of JSON-RPC over two files, each behind a header with its length (LSP 3.17, base protocol).
///
/// Threads: one reads; any may write.
class Connection {
 public:
  Connection(int in, int out) : in_(in), out_(out) {}

  struct Incoming {
    nlohmann::json message;
    bool readable = true;  ///< false: no JSON; the message is null
  };
  /// The next message. nullopt: the other side has closed, or what it sends is not this protocol.
  [[nodiscard]] std::optional<Incoming> read();

  /// Waits until it is written. A reader that is gone is no error: read() will tell.
  void write(const nlohmann::json& message);

 private:
  bool fill();
  [[nodiscard]] std::optional<std::size_t> read_header();

  int in_, out_;
  std::string buffer_;
  std::mutex writing_;
};

}  // namespace tessera::language_server
