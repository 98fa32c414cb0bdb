#pragma once

#include <cstddef>
#include <string>

#include "assembly/assembly.hpp"

namespace tessera {

/// Makes the links of a part that has channels to other processes; has no effect on another part.
void make_links(Assembly& assembly, const Clock& clock);

/// The type of the values at an end of a channel.
struct CarriedValue {
  std::size_t bytes = 0;  ///< in memory
  const ValueEncoding* encoding = nullptr;
  const ValueType* type = nullptr;
};
/// Makes one end of channel `index` of the part: its word, and its entry in the links.
struct MadeEnd {
  SharedChannel* word;
  NetworkEnd* end;
};
[[nodiscard]] MadeEnd make_end(Assembly& assembly, const Clock& clock, std::uint32_t index, Side side,
                               const CarriedValue& value, network::Incarnation incarnation);

/// Opens the library of the network, or makes the network in memory. Precondition: all ends are made.
///
/// Errors: as open_carrier and read_network: false and `error`.
[[nodiscard]] bool open_network(Assembly& assembly, const Clock& clock, std::string& error);

}  // namespace tessera
