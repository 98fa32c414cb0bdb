#pragma once

#include <cstdint>

namespace tessera {

/// The orders of a process that holds a run and lets it go on, and what it is told: single bytes on a stream socket.
///
/// Threads: the supervisor's.
class RunOrders {
 public:
  enum class Order : char {
    none = 0,
    go_on = 'g',
    hold = 'h',  ///< the net stands still, and devices get their safe commands
    end = 'e'    ///< as by a signal, but the run has ended as asked. Also when the other process has gone.
  };
  enum class State : char {
    held = 'H',  ///< all devices have their safe commands
    runs = 'R'
  };
  /// The reason of a run that ended by an order.
  static constexpr const char* ended = "ended by its managed node";

  explicit RunOrders(int descriptor) : descriptor_(descriptor) {}
  /// Readable once an order has come; -1: the other process has gone.
  [[nodiscard]] int descriptor() const { return descriptor_; }
  /// The next order; none: there is none. An order that is not known is dropped.
  [[nodiscard]] Order take();
  void tell(State state) const;

 private:
  int descriptor_;
};

}  // namespace tessera
