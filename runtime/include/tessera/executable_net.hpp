#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace tessera {

/// A place/transition net of any origin (drawn by hand, imported), made to be run by a NetExecutor: the net
/// itself, and the C++ that its places and transitions stand for.
struct ExecutableNet {
  /// Who runs the operation of a place.
  enum class Runs : std::uint8_t {
    inline_with_firing,  ///< the thread of the executor, which fires nothing meanwhile
    on_worker            ///< a worker thread; several tokens of one place may be worked on at once
  };

  struct Place {
    std::string name{};
    std::uint32_t tokens = 0;           ///< initially
    std::function<void()> operation{};  ///< what a token put into the place starts; empty: nothing
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
    std::int32_t priority = 0;             ///< the higher goes first
  };

  std::vector<Place> places;
  std::vector<Transition> transitions;
};

}  // namespace tessera
