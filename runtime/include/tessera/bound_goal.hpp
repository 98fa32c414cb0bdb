#pragma once

#include <cstdint>
#include <initializer_list>
#include <string_view>
#include <type_traits>
#include <vector>

namespace tessera {

/// A goal whose life the net keeps in a memory cell: its buffers, and the behaviours that order it.
struct BoundGoal {
  /// A behaviour whose beginning orders a new goal.
  struct Order {
    std::uint16_t behaviour;
    bool cancel_on_leave;
  };
  struct Progress {
    std::uint32_t call;
    std::uint8_t state;
  };
  std::string_view cell;  ///< of the memory
  void* goal;             ///< the value of the output
  const void* progress;   ///< the value of the input
  void (*write)(void* goal, std::uint32_t call, bool cancel);
  Progress (*read)(const void* progress);
  std::vector<Order> orders;
};

/// goal: an output with the fields `call` and perhaps `cancel`; progress: an input with `call` and `state`.
template <class Out, class In>
[[nodiscard]] BoundGoal bound_goal(std::string_view cell, Out& goal, In& progress,
                                   std::initializer_list<BoundGoal::Order> orders) {
  using Ordered = std::remove_reference_t<decltype(payload(goal))>;
  using Told = std::remove_reference_t<decltype(payload(progress))>;
  return {cell,
          &payload(goal),
          &payload(progress),
          [](void* value, std::uint32_t call, bool cancel) {
            static_cast<Ordered*>(value)->call = call;
            if constexpr (requires(Ordered one) { one.cancel; })
              static_cast<Ordered*>(value)->cancel = cancel;
          },
          [](const void* value) {
            const auto& told = *static_cast<const Told*>(value);
            return BoundGoal::Progress{told.call, told.state};
          },
          orders};
}

}  // namespace tessera
