#include "timing/conduct.hpp"

#include "timing/conduct/certain.hpp"

namespace tessera::timing {
namespace {

class Judge {
 public:
  Judge(const Declared& declared, const Bounds& bounds)
      : declared_(declared),
        system_(declared.system),
        all_(bounds),
        bounds_(bounds.occurrences()),
        certain_(bounds) {}

  Conduct take() {
    for (std::uint32_t i = 0; i < system_.subsystems.size(); ++i) {
      if (system_.subsystems[i].period > 0) conduct_.rates.push_back(rate(i));
      for (EventId z = bounds_.events().start(i); z <= bounds_.events().end(i); ++z)
        if (bounds_.wait_of(z) != Occurrences::Wait::none) conduct_.waits.push_back(wait(z));
      if (declared_.stale[i] > 0)
        for (const std::uint32_t c : system_.subsystems[i].receives) conduct_.stale.push_back(stale(i, c));
    }
    return std::move(conduct_);
  }

 private:
  RateVerdict rate(std::uint32_t i) {
    const Events& events = bounds_.events();
    const Time period = system_.subsystems[i].period, longest_time = all_.between_iterations(i);
    // The first one begins at time 0, and the others at instants of the grid.
    const bool keeps = bounds_.periodic(i) || (longest_time <= period && !bounds_.begins_late(i));
    RateVerdict verdict{i, keeps, period, longest_time, !bounds_.never_overruns(i), i};
    Time longest = -1;
    for (EventId z = events.start(i); z <= events.end(i); ++z) {
      if (bounds_.wait_of(z) == Occurrences::Wait::none || bounds_.wait(z) <= longest) continue;
      longest = bounds_.wait(z);
      const Channel& channel = system_.channels[events[z].channel];
      verdict.waits_for = channel.from == i ? channel.to : channel.from;
    }
    return verdict;
  }

  WaitVerdict wait(EventId z) {
    const Event& event = bounds_.events()[z];
    const Time timeout = bounds_.timeout_of(z);
    const bool never = timeout == 0 || bounds_.timeout_never_fires(z);
    return {event.subsystem, event.channel, event.kind == Event::Kind::read,
            bounds_.wait(z), timeout,       fires(never, !never && certain_.times_out(z)),
            certain_.wait(z)};
  }

  StaleVerdict stale(std::uint32_t i, std::uint32_t c) {
    const Time oldest = all_.staleness(c), limit = declared_.stale[i];
    const bool never = oldest <= limit && bounds_.first_value(c) <= limit;
    const bool must = !never && certain_.gets_stale(c, limit);
    return {i, c, limit, oldest, fires(never, must), certain_.staleness(c)};
  }

  static Fires fires(bool never, bool must) { return never ? Fires::never : must ? Fires::must : Fires::may; }

  const Declared& declared_;
  const System& system_;
  const Bounds& all_;
  const Occurrences& bounds_;
  const Certain certain_;
  Conduct conduct_;
};

}  // namespace

Conduct conduct_of(const Declared& declared, const Bounds& bounds) { return Judge(declared, bounds).take(); }

}  // namespace tessera::timing
