#include "run/steady_links.hpp"

#include <algorithm>

namespace tessera {
namespace {

// The longest wait, so that the thread checks regularly whether the run is to stop.
constexpr Duration longest_wait_for_network = std::chrono::milliseconds(100);
// Times after the end: how long repeated values are still answered, and how long values that were not taken
// are sent.
constexpr Duration farewell = std::chrono::milliseconds(250), longest_farewell = std::chrono::seconds(2);

}  // namespace

void serve_links_until_end(Assembly& assembly, const SteadyClock& clock, const std::atomic<bool>& net_ended) {
  Links& links = *assembly.links;
  while (!assembly.control.stopping()) links.serve(clock.now() + longest_wait_for_network);
  if (!net_ended.load(std::memory_order_acquire)) return;
  const Time stopped = clock.now();
  while (clock.now() < stopped + (links.pending() ? longest_farewell : farewell))
    links.serve(clock.now() + longest_wait_for_network);
}

bool waits_for_network(const Assembly& assembly) {
  return std::ranges::any_of(assembly.executors, [](const auto& executor) {
    return std::ranges::any_of(executor->operations().parts().ports, [](const PortLink& port) {
      return port.end != nullptr && port.channel->waiting(port.side) != SharedChannel::Waiting::no;
    });
  });
}

}  // namespace tessera
