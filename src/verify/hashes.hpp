#pragma once

#include <string>

#include "net/net.hpp"

namespace tessera::verify {

/// The identity of a net, as the runtime computes it: 32 hexadecimal digits.
[[nodiscard]] std::string hash_of(const net::Net& net);

}  // namespace tessera::verify
