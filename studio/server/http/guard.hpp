#pragma once

#include <httplib.h>

#include <optional>
#include <string>
#include <string_view>

namespace tessera::server {

/// 128 random bits, as 32 hexadecimal digits.
[[nodiscard]] std::string random_token();

/// Why a request is refused.
struct Refusal {
  int status = 403;
  std::string error, hint;
};

/// Who may ask for what. The page itself is for everybody on this machine; everything under /api/ needs the
/// token of this start. A foreign page in the same browser is told apart by its Origin, and a name that
/// resolves to this machine by the Host.
///
/// Threads: any.
class RequestGuard {
 public:
  RequestGuard(int port, std::string token) : port_(std::to_string(port)), token_(std::move(token)) {}
  /// nullopt: it may pass.
  [[nodiscard]] std::optional<Refusal> refuse(const httplib::Request& request) const;

 private:
  [[nodiscard]] bool is_here(std::string_view authority) const;
  [[nodiscard]] bool comes_from_here(const httplib::Request& request) const;
  [[nodiscard]] bool has_token(const httplib::Request& request) const;
  std::string port_, token_;
};

}  // namespace tessera::server
