#include "tessera/process_claim.hpp"

#include <fmt/core.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstring>
#include <thread>

namespace tessera {
namespace {

/// A guardian process that gives the safe commands for its dead controller still holds the claim. It takes at most
/// 4 s, and some time more on a busy machine.
constexpr auto longest_work_of_a_guardian = std::chrono::seconds(10);
constexpr auto between_tries = std::chrono::milliseconds(10);

/// Names of abstract sockets are short, so this is a hash (FNV-1a).
std::string name_of(std::span<const std::string> parts) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const std::string& part : parts) {
    for (const char letter : part) hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001b3U;
    hash *= 0x100000001b3U;
  }
  return fmt::format("tessera-process-{:016x}", hash);
}

std::array<std::string, 4> parts_of(const ClaimedProcess& process) {
  return {process.system, process.process, std::to_string(process.domain),
          process.interface.empty() ? "lo" : process.interface};
}

std::int64_t owner_of(const sockaddr_un& address, socklen_t size) {
  const int client = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  ucred owner{};
  socklen_t length = sizeof owner;
  const bool known = client >= 0 && connect(client, reinterpret_cast<const sockaddr*>(&address), size) == 0 &&
                     getsockopt(client, SOL_SOCKET, SO_PEERCRED, &owner, &length) == 0;
  if (client >= 0) close(client);
  return known ? owner.pid : 0;
}

bool is_alive(std::int64_t process) { return kill(static_cast<pid_t>(process), 0) == 0 || errno != ESRCH; }

}  // namespace

ProcessClaim::ProcessClaim(const ClaimedProcess& process) : ProcessClaim(parts_of(process)) {}

ProcessClaim::ProcessClaim(std::span<const std::string> parts)
    : socket_(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string name = name_of(parts);
  std::memcpy(address.sun_path + 1, name.data(), name.size());  // a name that begins with 0 is abstract
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  if (socket_ < 0) return;
  const auto until = std::chrono::steady_clock::now() + longest_work_of_a_guardian;
  const auto is_bound = [&] { return bind(socket_, reinterpret_cast<const sockaddr*>(&address), size) == 0; };
  bool bound = is_bound();
  while (!bound && errno == EADDRINUSE) {
    other_ = owner_of(address, size);
    if (*other_ == 0 || is_alive(*other_) || std::chrono::steady_clock::now() > until) return;
    std::this_thread::sleep_for(between_tries);
    bound = is_bound();
  }
  other_.reset();
  if (bound)
    // Whoever asks for the owner stays in the queue, since nobody accepts. The kernel limits the number.
    static_cast<void>(listen(socket_, SOMAXCONN));
}

ProcessClaim::~ProcessClaim() {
  if (socket_ >= 0) close(socket_);
}

std::string runs_already(const ClaimedProcess& process, std::int64_t other) {
  return fmt::format(
      "process {} of {} runs on this machine already{}, in domain {} on interface {}: stop it first, "
      "or use another --domain",
      process.process, process.system, other > 0 ? fmt::format(" (number {})", other) : "", process.domain,
      process.interface.empty() ? "lo" : process.interface);
}

}  // namespace tessera
