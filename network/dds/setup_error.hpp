#pragma once

#include <stdexcept>

namespace tessera::dds {

/// Why a carrier cannot be made, for a person to read.
class SetupError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace tessera::dds
