#include "network/dds/closed_sockets.hpp"

#include <dirent.h>
#include <linux/filter.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <memory>

#include "network/dds/settings.hpp"
#include "network/dds/setup_error.hpp"

namespace tessera::dds {
namespace {

struct FolderCloser {
  void operator()(DIR* folder) const { closedir(folder); }
};

/// Whether the socket is bound to all addresses, at a port of the domain.
bool is_receiver_of(int domain, int file) {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  if (getsockname(file, reinterpret_cast<sockaddr*>(&address), &size) != 0) return false;
  if (address.sin_family != AF_INET || address.sin_addr.s_addr != htonl(INADDR_ANY)) return false;
  const int port = ntohs(address.sin_port);
  return port >= first_port(domain) && port < first_port(domain) + ports_of_a_host;
}

/// Accepts packets from these two interfaces only. Messages of a host to its own address come from loopback.
void accept_only_from(int file, unsigned interface, unsigned loopback) {
  constexpr auto whole = std::numeric_limits<std::uint32_t>::max();
  const auto load = static_cast<std::uint32_t>(SKF_AD_OFF + SKF_AD_IFINDEX);
  std::array<sock_filter, 5> program{{
      {.code = BPF_LD | BPF_W | BPF_ABS, .jt = 0, .jf = 0, .k = load},
      {.code = BPF_JMP | BPF_JEQ | BPF_K, .jt = 2, .jf = 0, .k = interface},
      {.code = BPF_JMP | BPF_JEQ | BPF_K, .jt = 1, .jf = 0, .k = loopback},
      {.code = BPF_RET | BPF_K, .jt = 0, .jf = 0, .k = 0},
      {.code = BPF_RET | BPF_K, .jt = 0, .jf = 0, .k = whole},
  }};
  const sock_fprog filter{.len = program.size(), .filter = program.data()};
  if (setsockopt(file, SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof filter) != 0)
    throw SetupError("the sockets cannot be closed to other interfaces");
}

}  // namespace

OpenSockets open_sockets() {
  const std::unique_ptr<DIR, FolderCloser> folder(opendir("/proc/self/fd"));
  if (!folder) throw SetupError("/proc/self/fd cannot be read");
  OpenSockets sockets;
  while (const dirent* entry = readdir(folder.get())) {
    if (entry->d_name[0] == '.') continue;
    const int file = std::atoi(entry->d_name);
    struct stat status {};
    if (fstat(file, &status) == 0 && S_ISSOCK(status.st_mode)) sockets.emplace(status.st_ino, file);
  }
  return sockets;
}

void close_sockets_to_other_interfaces(const OpenSockets& before, int domain, const Location& location) {
  int closed = 0;
  for (const auto& [inode, file] : open_sockets()) {
    if (before.contains(inode) || !is_receiver_of(domain, file)) continue;
    accept_only_from(file, location.interface_index, if_nametoindex("lo"));
    ++closed;
  }
  if (closed == 0) throw SetupError("the sockets of the middleware were not found");
}

}  // namespace tessera::dds
