// The end of a computation on request.
#pragma once

#include <functional>
#include <stdexcept>

namespace tessera::timing {

/// Asked now and then during long work; true ends it with `Interrupted`. Empty: it goes on to its end.
using StopAsked = std::function<bool()>;

struct Interrupted : std::runtime_error {
  Interrupted() : std::runtime_error("the computation of times was stopped") {}
};

inline void check(const StopAsked& stop) {
  if (stop && stop()) throw Interrupted();
}

}  // namespace tessera::timing
