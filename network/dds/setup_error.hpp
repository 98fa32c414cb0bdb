#pragma once

#include <stdexcept>

namespace tessera::dds {

/// The reason why a carrier cannot be made, as text for people.
class SetupError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace tessera::dds
