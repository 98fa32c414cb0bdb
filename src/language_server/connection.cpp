#include "language_server/connection.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>

#include "project/files/files.hpp"

namespace tessera::language_server {
namespace {

constexpr std::size_t largest_message = std::size_t{256} * 1024 * 1024;
constexpr std::size_t longest_header = 8192;

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

}  // namespace

bool Connection::fill() {
  std::array<char, 65536> part{};
  for (;;) {
    const ssize_t got = ::read(in_, part.data(), part.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    buffer_.append(part.data(), static_cast<std::size_t>(got));
    return true;
  }
}

std::optional<std::size_t> Connection::read_header() {
  std::size_t end = 0;
  while ((end = buffer_.find("\r\n\r\n")) == std::string::npos)
    if (buffer_.size() > longest_header || !fill()) return std::nullopt;
  const std::string header = lower(buffer_.substr(0, end));
  buffer_.erase(0, end + 4);
  constexpr std::string_view name = "content-length:";
  std::size_t at = header.find(name);
  if (at == std::string::npos) return std::nullopt;
  at = header.find_first_not_of(" \t", at + name.size());
  std::size_t length = 0;
  if (at == std::string::npos) return std::nullopt;
  const auto [rest, problem] = std::from_chars(header.data() + at, header.data() + header.size(), length);
  if (problem != std::errc() || length > largest_message) return std::nullopt;
  return length;
}

std::optional<Connection::Incoming> Connection::read() {
  const std::optional<std::size_t> length = read_header();
  if (!length) return std::nullopt;
  while (buffer_.size() < *length)
    if (!fill()) return std::nullopt;
  Incoming incoming;
  incoming.message = nlohmann::json::parse(
      buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(*length), nullptr, false);
  buffer_.erase(0, *length);
  if (incoming.message.is_discarded()) incoming = {nullptr, false};
  return incoming;
}

void Connection::write(const nlohmann::json& message) {
  // A text of the user may be no UTF-8; JSON is.
  const std::string body = message.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  const std::lock_guard lock(writing_);
  (void)project::write_all(out_, "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body);
}

}  // namespace tessera::language_server
