#include "server/http/guard.hpp"

#include <sys/random.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace tessera::server {

namespace {

constexpr std::size_t longest_path = 512;
constexpr std::string_view bearer = "Bearer ";

/// Takes the same time for every position of the first difference.
bool same(std::string_view given, std::string_view wanted) {
  if (given.size() != wanted.size()) return false;
  unsigned difference = 0;
  for (std::size_t at = 0; at < wanted.size(); ++at)
    difference |= static_cast<unsigned>(static_cast<unsigned char>(given[at] ^ wanted[at]));
  return difference == 0;
}

bool is_api(const httplib::Request& request) { return request.path.starts_with("/api/"); }

}  // namespace

std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw std::runtime_error(std::string("no random numbers: ") + std::strerror(errno));
  std::string digits;
  for (const unsigned char byte : bytes) {
    digits += "0123456789abcdef"[byte >> 4U];
    digits += "0123456789abcdef"[byte & 15U];
  }
  return digits;
}

std::optional<Refusal> RequestGuard::refuse(const httplib::Request& request) const {
  if (request.path.size() > longest_path) return Refusal{414, "the address is too long", ""};
  if (request.get_header_value_count("Host") != 1 || !is_here(request.get_header_value("Host")))
    return Refusal{403, "this address is not the studio's",
                   "open http://127.0.0.1:" + port_ + "; through a tunnel, with the same port at both ends"};
  if (!comes_from_here(request)) return Refusal{403, "requests of other pages are not answered", ""};
  // Refuses bodies that would be decompressed, assembled or read without end.
  if (request.has_header("Transfer-Encoding")) return Refusal{411, "a body needs a Content-Length", ""};
  if (request.has_header("Content-Encoding")) return Refusal{415, "a body must not be compressed", ""};
  if (request.has_header("Range")) return Refusal{416, "there are no parts of an answer", ""};
  if (is_api(request) && !has_token(request))
    return Refusal{401, "this page does not know the token of the studio that runs now",
                   "open the address that `tessera studio` printed"};
  return std::nullopt;
}

bool RequestGuard::is_here(std::string_view authority) const {
  return authority == "127.0.0.1:" + port_ || authority == "localhost:" + port_;
}

bool RequestGuard::comes_from_here(const httplib::Request& request) const {
  constexpr std::string_view scheme = "http://";
  if (request.has_header("Origin")) {
    const std::string origin = request.get_header_value("Origin");
    if (request.get_header_value_count("Origin") != 1 || !origin.starts_with(scheme) ||
        !is_here(std::string_view(origin).substr(scheme.size())))
      return false;
  }
  // A header that browsers add to requests of pages. Pages cannot set it.
  const std::string site = request.get_header_value("Sec-Fetch-Site");
  return !is_api(request) || site.empty() || site == "same-origin" || site == "none";
}

bool RequestGuard::has_token(const httplib::Request& request) const {
  const std::string header = request.get_header_value("Authorization");
  if (header.starts_with(bearer)) return same(std::string_view(header).substr(bearer.size()), token_);
  // EventSource can set no header.
  return request.path == "/api/events" && same(request.get_param_value("token"), token_);
}

}  // namespace tessera::server
