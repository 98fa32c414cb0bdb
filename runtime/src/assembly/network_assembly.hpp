#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "assembly/assembly.hpp"
#include "tessera/subsystem.hpp"

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

/// The network on which a process meets the others: from the options of the run, or else from the specification.
struct NetworkPlace {
  int domain = 0;
  std::string_view interface;
  std::vector<std::string_view> peers;
};
/// Precondition: the assembly is of one process. Views are valid as long as the assembly.
[[nodiscard]] NetworkPlace place_of(const Assembly& assembly);

/// Opens the library of the network, or makes the network in memory. Precondition: all ends are made.
///
/// Errors: as open_carrier and read_network: false and `error`.
[[nodiscard]] bool open_network(Assembly& assembly, const Clock& clock, std::string& error);

}  // namespace tessera
