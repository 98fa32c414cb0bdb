#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace tessera {

/// A place/transition net of any origin (drawn by hand, imported) that a NetExecutor can run: the net itself,
/// and the C++ functions of its places and transitions.
struct ExecutableNet {
  /// Selects the thread that runs the operation of a place.
  enum class Runs : std::uint8_t {
    inline_with_firing,  ///< the thread of the executor, which fires nothing in the meantime
    on_worker            ///< a worker thread; the operations of several tokens of one place may run at once
  };

  struct Place {
    std::string name{};
    std::uint32_t tokens = 0;           ///< initially
    std::function<void()> operation{};  ///< started by each token that is put into the place; empty: none
    Runs runs = Runs::inline_with_firing;
  };
  struct Arc {
    std::uint32_t place = 0;  ///< index into places
    std::uint32_t weight = 1;
  };
  struct Transition {
    std::string name{};
    std::vector<Arc> inputs{}, outputs{};  ///< arcs with the same place add up
    std::function<bool()> condition{};     ///< empty: always true
    std::int32_t priority = 0;             ///< the transition with the higher priority fires first
  };

  std::vector<Place> places;
  std::vector<Transition> transitions;
};

}  // namespace tessera
