#include "timing/steps.hpp"

#include <algorithm>
#include <utility>

namespace tessera::timing {
namespace {

using StepKind = Step::Kind;

class StepList {
 public:
  explicit StepList(const Bounds& bounds) : bounds_(bounds.occurrences()) {}

  /// An iteration up to `last`, a write or the command. waits: the part before its release.
  void iteration(EventId last, Time from, Time to, StepKind waits) {
    const std::uint32_t i = bounds_.events()[last].subsystem;
    const System& system = bounds_.system();
    Time own = std::min(to - from, bounds_.since_start(last));
    add(waits, i, 0, to - from - own);
    const Time longest = std::min(own, system.subsystems[i].longest);
    own -= longest;
    const Time preempted = std::min(own, bounds_.response(i) - system.subsystems[i].longest);
    own -= preempted;
    const Time late = system.subsystems[i].period > 0 ? std::min(own, system.latency) : 0;
    own -= late;
    add(StepKind::latency, i, 0, late);
    add(StepKind::processor, i, 0, preempted);
    add(StepKind::takes, i, 0, longest);
    add(StepKind::until_sent, i, 0, own);
  }
  void add(StepKind kind, std::uint32_t subsystem, std::uint32_t channel, Time time) {
    if (time > 0) steps_.push_back({kind, subsystem, channel, time});
  }
  std::vector<Step> take() { return std::move(steps_); }

 private:
  const Occurrences& bounds_;
  std::vector<Step> steps_;
};

std::vector<Step> along(const Bounds& bounds, const Chain& chain, const Route& route, StepKind first_wait) {
  const Occurrences& occurrences = bounds.occurrences();
  const Events& events = occurrences.events();
  StepList steps(bounds);
  steps.iteration(events.write(chain.front()), 0, route.sent, first_wait);
  Time last = route.sent;
  for (std::size_t hop = 0; hop < chain.size(); ++hop) {
    const std::uint32_t to = occurrences.system().channels[chain[hop]].to;
    const Route::Hop& passed = route.hops[hop];
    steps.add(StepKind::until_read, to, chain[hop], passed.read - last);
    steps.iteration(hop + 1 < chain.size() ? events.write(chain[hop + 1]) : events.finish(to), passed.read,
                    passed.given, StepKind::until_begin);
    last = passed.given;
  }
  return steps.take();
}

}  // namespace

ChainSteps steps_of(const Bounds& bounds, const std::vector<Chain>& ways) {
  const Chain *oldest = &ways.front(), *slowest = oldest;
  for (const Chain& way : ways) {
    if (bounds.chain(way).age > bounds.chain(*oldest).age) oldest = &way;
    if (bounds.chain(way).reaction > bounds.chain(*slowest).reaction) slowest = &way;
  }
  return {along(bounds, *oldest, bounds.routes(*oldest).age, StepKind::until_sent),
          along(bounds, *slowest, bounds.routes(*slowest).reaction, StepKind::next_reading)};
}

}  // namespace tessera::timing
