#include "timing/events.hpp"

#include <utility>

namespace tessera::timing {

Events::Events(const System& system)
    : write_(system.channels.size()), acked_(system.channels.size()), read_(system.channels.size()) {
  using enum Event::Kind;
  for (std::uint32_t i = 0; i < system.subsystems.size(); ++i) {
    const Subsystem& subsystem = system.subsystems[i];
    first_.push_back(static_cast<EventId>(events_.size()));
    const EventId begun = add(i, start, 0, {});
    const EventId finished = add(i, finish, 0, {begun});
    std::vector<EventId> last{finished};
    const auto follow = [&](EventId id) {
      if (subsystem.parallel)
        last.push_back(id);
      else
        last = {id};
    };
    for (const std::uint32_t c : subsystem.sends) {
      write_[c] = add(i, write, c, subsystem.parallel ? std::vector{finished} : last);
      if (system.channels[c].send_blocks) acked_[c] = add(i, acked, c, {write_[c]});
      follow(system.channels[c].send_blocks ? acked_[c] : write_[c]);
    }
    const EventId all_sent = add(i, sent, 0, std::move(last));
    last = {all_sent};
    for (const std::uint32_t c : subsystem.receives) {
      read_[c] = add(i, read, c, subsystem.parallel ? std::vector{all_sent} : last);
      follow(read_[c]);
    }
    add(i, end, 0, std::move(last));
  }
  first_.push_back(static_cast<EventId>(events_.size()));
  for (const Event& event : events_)
    least_.push_back(event.kind == start ? 0 : system.subsystems[event.subsystem].shortest);
}

EventId Events::add(std::uint32_t subsystem, Event::Kind kind, std::uint32_t channel,
                    std::vector<EventId> before) {
  events_.push_back({subsystem, kind, channel, std::move(before)});
  return static_cast<EventId>(events_.size()) - 1;
}

}  // namespace tessera::timing
