#include "server/analysis/waits.hpp"

#include <iterator>

#include "verify/counterexample/waits.hpp"

namespace tessera::server {

std::vector<verify::SubsystemAtEnd> waits_in(const net::Net& net, const std::vector<std::uint32_t>& marked) {
  std::vector<std::uint32_t> tokens(net.places().size());
  for (const std::uint32_t place : marked)
    if (place < tokens.size()) tokens[place] = 1;
  const verify::Waits waits(net, std::move(tokens));
  std::vector<verify::SubsystemAtEnd> all;
  for (std::uint32_t index = 0; index < waits.subsystems(); ++index) {
    const net::SubsystemId subsystem{index};
    if (waits.moves(subsystem) || waits.has_ended(subsystem)) continue;
    std::vector<verify::SubsystemAtEnd> its = waits.waits_of(subsystem);
    all.insert(all.end(), std::make_move_iterator(its.begin()), std::make_move_iterator(its.end()));
  }
  return all;
}

}  // namespace tessera::server
