#include "managed/run_orders.hpp"

#include <sys/socket.h>

#include <cerrno>

namespace tessera {

RunOrders::Order RunOrders::take() {
  while (descriptor_ >= 0) {
    char order = 0;
    const ssize_t count = recv(descriptor_, &order, 1, MSG_DONTWAIT);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return Order::none;
    if (count <= 0) {
      descriptor_ = -1;
      return Order::end;
    }
    if (order == static_cast<char>(Order::go_on) || order == static_cast<char>(Order::hold) ||
        order == static_cast<char>(Order::end))
      return static_cast<Order>(order);
  }
  return Order::none;
}

void RunOrders::tell(State state) const {
  const char byte = static_cast<char>(state);
  if (descriptor_ >= 0) [[maybe_unused]]
    const ssize_t sent = send(descriptor_, &byte, 1, MSG_DONTWAIT | MSG_NOSIGNAL);
}

}  // namespace tessera
