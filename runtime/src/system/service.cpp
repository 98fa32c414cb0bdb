#include "system/service.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <string>

namespace tessera {
namespace {

/// nullopt: not set, or not a number.
[[nodiscard]] std::optional<std::int64_t> number_in_environment(const char* name) {
  const char* const text = std::getenv(name);
  if (text == nullptr) return std::nullopt;
  std::int64_t number = 0;
  const char* const end = text + std::strlen(text);
  const auto [stop, problem] = std::from_chars(text, end, number);
  if (problem != std::errc{} || stop != end) return std::nullopt;
  return number;
}

/// The limit, if the manager watches this process or does not name one.
[[nodiscard]] std::optional<Duration> watchdog_limit() {
  const std::optional<std::int64_t> limit_us = number_in_environment("WATCHDOG_USEC");
  if (!limit_us || *limit_us <= 0 || *limit_us > INT64_MAX / 1000) return std::nullopt;
  if (std::getenv("WATCHDOG_PID") != nullptr && number_in_environment("WATCHDOG_PID") != getpid())
    return std::nullopt;
  return std::chrono::microseconds(*limit_us);
}

}  // namespace

ServiceManager::ServiceManager() {
  const char* const name = std::getenv("NOTIFY_SOCKET");
  const std::size_t length = name == nullptr ? 0 : std::strlen(name);
  // A path, or the name of an abstract socket, which has no zero at its end.
  const bool usable = length > 1 && length < sizeof address_.sun_path && (name[0] == '/' || name[0] == '@');
  if (usable) {
    address_.sun_family = AF_UNIX;
    std::copy_n(name, length, address_.sun_path);
    const bool abstract = name[0] == '@';
    if (abstract) address_.sun_path[0] = '\0';
    address_bytes_ = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + length + (abstract ? 0 : 1));
    socket_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    // Twice within the manager's limit, as sd_watchdog_enabled(3) advises, and
    // once more for a late wake-up.
    if (const std::optional<Duration> limit = watchdog_limit()) period_ = *limit / 3;
  }
  for (const char* const variable : {"NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"}) unsetenv(variable);
}

ServiceManager::~ServiceManager() {
  if (socket_ >= 0) close(socket_);
}

void ServiceManager::status(std::string_view text) { send("STATUS=" + std::string(text)); }

Time ServiceManager::beat(Time now) {
  if (!period_ || socket_ < 0) return Time::max();
  if (now >= next_) {
    send("WATCHDOG=1");
    next_ = now + *period_;
  }
  return next_;
}

void ServiceManager::send(std::string_view message) const {
  if (socket_ < 0) return;
  [[maybe_unused]] const ssize_t sent =
      sendto(socket_, message.data(), message.size(), MSG_NOSIGNAL | MSG_DONTWAIT,
             reinterpret_cast<const sockaddr*>(&address_), address_bytes_);
}

bool writes_to_journal() {
  const char* const stream = std::getenv("JOURNAL_STREAM");
  if (stream == nullptr) return false;
  unsigned long long device = 0, inode = 0;
  const char* const end = stream + std::strlen(stream);
  const auto [colon, problem] = std::from_chars(stream, end, device);
  if (problem != std::errc{} || colon == end || *colon != ':') return false;
  if (std::from_chars(colon + 1, end, inode).ec != std::errc{}) return false;
  struct stat target {};
  return fstat(STDERR_FILENO, &target) == 0 && target.st_dev == device && target.st_ino == inode;
}

}  // namespace tessera
