#include "sim/coppelia/listener.hpp"

#include <fcntl.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <memory>

#include "sim/coppelia/link_error.hpp"

namespace tessera::coppelia {
namespace {

struct FreeAddresses {
  void operator()(addrinfo* list) const { freeaddrinfo(list); }
};
using Addresses = std::unique_ptr<addrinfo, FreeAddresses>;

std::string place(const std::string& host, std::uint16_t port) { return host + ":" + std::to_string(port); }

Addresses addresses_of(const std::string& host, std::uint16_t port) {
  addrinfo wanted{};
  wanted.ai_socktype = SOCK_STREAM;
  addrinfo* list = nullptr;
  const int problem = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &wanted, &list);
  if (problem != 0) throw LinkError("the host '" + host + "' is not known: " + gai_strerror(problem));
  return Addresses(list);
}

/// 0, or the error number.
int wait_until_connected(int socket, Duration patience) {
  pollfd wish{socket, POLLOUT, 0};
  const auto end = std::chrono::steady_clock::now() + patience;
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    const int ready = left.count() <= 0 ? 0 : poll(&wish, 1, static_cast<int>(left.count()));
    if (ready == 0) return ETIMEDOUT;
    if (ready < 0 && errno == EINTR) continue;
    if (ready < 0) return errno;
    int problem = 0;
    socklen_t size = sizeof problem;
    return getsockopt(socket, SOL_SOCKET, SO_ERROR, &problem, &size) == 0 ? problem : errno;
  }
}

/// 0, or the error number.
int try_to_connect(const addrinfo& address, Duration patience) {
  const int socket = ::socket(address.ai_family, address.ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (socket < 0) return errno;
  int problem = connect(socket, address.ai_addr, address.ai_addrlen) == 0 ? 0 : errno;
  if (problem == EINPROGRESS) problem = wait_until_connected(socket, patience);
  close(socket);
  return problem;
}

}  // namespace

std::string listening_address(const std::string& host, std::uint16_t port, Duration patience) {
  const Addresses addresses = addresses_of(host, port);
  int problem = 0;
  for (const addrinfo* one = addresses.get(); one != nullptr; one = one->ai_next) {
    problem = try_to_connect(*one, patience);
    if (problem != 0) continue;
    std::array<char, NI_MAXHOST> text{};
    if (getnameinfo(one->ai_addr, one->ai_addrlen, text.data(), text.size(), nullptr, 0, NI_NUMERICHOST) == 0)
      return text.data();
  }
  if (problem == ECONNREFUSED)
    throw LinkError("no program listens at " + place(host, port) +
                    "; is CoppeliaSim running, with its add-on 'ZMQ remote API server'?");
  throw LinkError("cannot connect to " + place(host, port) + ": " + std::strerror(problem));
}

}  // namespace tessera::coppelia
