#pragma once

#include <httplib.h>

#include <optional>
#include <string>
#include <string_view>

namespace tessera::server {

/// 128 random bits, as 32 hexadecimal digits.
[[nodiscard]] std::string random_token();

/// The reason for which a request is refused.
struct Refusal {
  int status = 403;
  std::string error, hint;
};

/// Decides which requests are allowed. Every process on this machine may load the page itself; everything
/// under /api/ needs the token of this start. The Origin reveals a foreign page in the same browser, and the
/// Host a foreign name that resolves to this machine.
///
/// Threads: any.
class RequestGuard {
 public:
  RequestGuard(int port, std::string token) : port_(std::to_string(port)), token_(std::move(token)) {}
  /// nullopt: it is allowed.
  [[nodiscard]] std::optional<Refusal> refuse(const httplib::Request& request) const;

 private:
  [[nodiscard]] bool is_here(std::string_view authority) const;
  [[nodiscard]] bool comes_from_here(const httplib::Request& request) const;
  [[nodiscard]] bool has_token(const httplib::Request& request) const;
  std::string port_, token_;
};

}  // namespace tessera::server
