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
    const bool crosses = occurrences.system().crosses(chain[hop]);
    const Time sent =
        crosses ? std::min(passed.read - last, occurrences.arrived(chain[hop], last) - last) : 0;
    steps.add(StepKind::network, to, chain[hop], sent);
    steps.add(StepKind::until_read, to, chain[hop], passed.read - last - sent);
    steps.iteration(hop + 1 < chain.size() ? events.write(chain[hop + 1]) : events.finish(to), passed.read,
                    passed.given, StepKind::until_begin);
    last = passed.given;
  }
  return steps.take();
}

/// A part of a way behind a foreign hop begins with an event: an answer. Readings before the last part are those that
/// are in force.
std::vector<Step> all_along(const Bounds& bounds, const Chain& way, const std::vector<ForeignHop>& foreign,
                            bool is_age) {
  std::vector<Step> steps;
  const std::vector<Chain> parts = parts_of(way, foreign);
  for (std::size_t at = 0; at < parts.size(); ++at) {
    const ChainRoutes routes = bounds.routes(parts[at]);
    const bool counts_age = is_age && at + 1 == parts.size();
    if (at > 0)
      steps.push_back({StepKind::foreign, bounds.occurrences().system().channels[parts[at].front()].from,
                       static_cast<std::uint32_t>(at - 1), foreign[at - 1].longest});
    const std::vector<Step> more = along(bounds, parts[at], counts_age ? routes.age : routes.reaction,
                                         counts_age ? StepKind::until_sent : StepKind::next_reading);
    steps.insert(steps.end(), more.begin(), more.end());
  }
  return steps;
}

}  // namespace

ChainSteps steps_of(const Bounds& bounds, const std::vector<Chain>& ways,
                    const std::vector<ForeignHop>& foreign) {
  const Chain *oldest = &ways.front(), *slowest = oldest;
  for (const Chain& way : ways) {
    if (bound_of(bounds, way, foreign).age > bound_of(bounds, *oldest, foreign).age) oldest = &way;
    if (bound_of(bounds, way, foreign).reaction > bound_of(bounds, *slowest, foreign).reaction)
      slowest = &way;
  }
  return {all_along(bounds, *oldest, foreign, /*is_age=*/true),
          all_along(bounds, *slowest, foreign, /*is_age=*/false)};
}

}  // namespace tessera::timing
