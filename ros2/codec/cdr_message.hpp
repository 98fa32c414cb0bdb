#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "ros2/codec/cdr.hpp"

namespace tessera::ros2 {

/// The whole message of which `write` puts the members, with its header.
template <class Write>
[[nodiscard]] std::vector<std::byte> cdr_message(Write&& write) {
  std::vector<std::byte> message;
  CdrWriter writer(message);
  std::forward<Write>(write)(writer);
  writer.finish();
  return message;
}

}  // namespace tessera::ros2
