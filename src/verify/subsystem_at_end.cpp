#include "verify/subsystem_at_end.hpp"

#include <array>
#include <cstddef>

namespace tessera::verify {

const char* name_of(SubsystemAtEnd::State state) {
  constexpr std::array<const char*, 5> names{"waits", "no_successor", "ended", "gives_no_more",
                                             "takes_no_more"};
  return names[static_cast<std::size_t>(state)];
}

const char* name_of(SubsystemAtEnd::Awaited awaited) {
  constexpr std::array<const char*, 4> names{"nothing", "value", "acknowledgement", "memory"};
  return names[static_cast<std::size_t>(awaited)];
}

}  // namespace tessera::verify
