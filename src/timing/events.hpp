// The events of the iterations, and which come before which.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "timing/system.hpp"

namespace tessera::timing {

using EventId = std::uint32_t;

struct Event {
  enum class Kind : std::uint8_t {
    start,   ///< the release of the iteration
    finish,  ///< the end of the call; the device is commanded
    write,   ///< the value is in the channel
    acked,   ///< a blocking send goes on
    sent,    ///< all sends are done
    read,    ///< a receive is done
    end      ///< of the iteration
  };
  std::uint32_t subsystem = 0;
  Kind kind = Kind::start;
  std::uint32_t channel = 0;      ///< of write, acked and read
  std::vector<EventId> before{};  ///< in the same iteration
};

/// Events of one subsystem follow one another, in an order in which each comes after those before it.
class Events {
 public:
  explicit Events(const System& system);

  [[nodiscard]] std::size_t size() const { return events_.size(); }
  [[nodiscard]] const Event& operator[](EventId id) const { return events_[id]; }
  [[nodiscard]] EventId start(std::uint32_t subsystem) const { return first_[subsystem]; }
  [[nodiscard]] EventId finish(std::uint32_t subsystem) const { return first_[subsystem] + 1; }
  [[nodiscard]] EventId end(std::uint32_t subsystem) const { return first_[subsystem + 1] - 1; }
  [[nodiscard]] EventId write(std::uint32_t channel) const { return write_[channel]; }
  /// Precondition: the send blocks.
  [[nodiscard]] EventId acked(std::uint32_t channel) const { return acked_[channel]; }
  [[nodiscard]] EventId read(std::uint32_t channel) const { return read_[channel]; }
  /// Least time from the release of its iteration.
  [[nodiscard]] Time least(EventId id) const { return least_[id]; }

 private:
  EventId add(std::uint32_t subsystem, Event::Kind kind, std::uint32_t channel, std::vector<EventId> before);

  std::vector<Event> events_;
  std::vector<Time> least_;
  std::vector<EventId> first_;  ///< per subsystem, and the number of all events
  std::vector<EventId> write_, acked_, read_;
};

}  // namespace tessera::timing
