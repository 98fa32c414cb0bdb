#include "project/process/control_connection.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <thread>

#include "tessera/monitor.hpp"

namespace tessera::project {

namespace fs = std::filesystem;

namespace {

/// 0: no limit.
void limit(int descriptor, int direction, std::chrono::milliseconds time) {
  const timeval given{.tv_sec = time.count() / 1000, .tv_usec = time.count() % 1000 * 1000};
  setsockopt(descriptor, SOL_SOCKET, direction, &given, sizeof given);
}

}  // namespace

ControlConnection::Attempt ControlConnection::attempt(const fs::path& socket_file) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string& name = socket_file.native();
  if (name.size() >= sizeof address.sun_path) return {};
  std::memcpy(address.sun_path, name.c_str(), name.size() + 1);
  const int descriptor = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (descriptor < 0) return {.connection = {}, .may_listen = true};
  ControlConnection made(descriptor);
  const auto* raw = reinterpret_cast<const sockaddr*>(&address);
  if (connect(descriptor, raw, sizeof address) != 0)
    return {.connection = {}, .may_listen = errno != ECONNREFUSED && errno != ENOENT};
  fcntl(descriptor, F_SETFL, fcntl(descriptor, F_GETFL) & ~O_NONBLOCK);
  return {.connection = std::move(made), .may_listen = true};
}

std::optional<ControlConnection> ControlConnection::to(const fs::path& socket_file) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(1);
  for (;;) {
    Attempt made = attempt(socket_file);
    if (made.connection || !made.may_listen || std::chrono::steady_clock::now() >= end)
      return std::move(made.connection);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

ControlConnection::~ControlConnection() {
  if (descriptor_) close(*descriptor_);
}

void ControlConnection::limit_waits(std::chrono::milliseconds time) const {
  for (const int direction : {SO_RCVTIMEO, SO_SNDTIMEO}) limit(*descriptor_, direction, time);
}

bool ControlConnection::send(std::string_view text) const {
  while (!text.empty()) {
    const ssize_t count = ::send(*descriptor_, text.data(), text.size(), MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

bool ControlConnection::is_process(std::int64_t id) const {
  ucred peer{};
  socklen_t size = sizeof peer;
  return getsockopt(*descriptor_, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 && peer.pid == id;
}

ControlConnection::Received ControlConnection::receive_at_once(ControlReader& to) const {
  return receive(to, MSG_DONTWAIT);
}

ControlConnection::Received ControlConnection::receive(ControlReader& to, int flags) const {
  std::array<char, 65536> bytes{};
  ssize_t count = -1;
  do count = recv(*descriptor_, bytes.data(), bytes.size(), flags);
  while (count < 0 && errno == EINTR);
  if (count < 0 && errno == EAGAIN) return Received::nothing;
  if (count <= 0) return Received::over;
  to.add({bytes.data(), static_cast<std::size_t>(count)});
  return Received::bytes;
}

void ControlConnection::wait_for_any(const std::vector<const ControlConnection*>& connections,
                                     std::chrono::milliseconds time) {
  std::vector<pollfd> sources;
  sources.reserve(connections.size());
  for (const ControlConnection* one : connections)
    sources.push_back({.fd = *one->descriptor_, .events = POLLIN, .revents = 0});
  poll(sources.data(), sources.size(), static_cast<int>(time.count()));
}

std::vector<fs::path> control_sockets(const fs::path& folder) {
  std::vector<fs::path> found;
  // Another user's sockets would answer what that user likes.
  if (folder == monitor_folder() && wrong_with_monitor_folder()) return found;
  std::error_code ignored;
  for (fs::directory_iterator entry(folder, ignored), end; !ignored && entry != end; entry.increment(ignored))
    if (entry->path().extension() == ".sock") found.push_back(entry->path());
  std::ranges::sort(found);
  return found;
}

}  // namespace tessera::project
