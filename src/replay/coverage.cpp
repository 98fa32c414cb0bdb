#include "replay/coverage.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <string_view>
#include <tuple>

namespace tessera::replay {

using net::Condition;
using net::Net;
using net::PlaceId;
using net::TransitionId;

// ---------------------------------------------------------------------------------------------- the counts

FiringCounts::FiringCounts(const Net& net)
    : firings_(net.transitions().size()), marked_(net.places().size()) {
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
    transitions_.emplace(net.transitions()[index].name, index);
  for (std::uint32_t index = 0; index < net.places().size(); ++index)
    places_.emplace(net.places()[index].name, index);
}

std::optional<Problem> FiringCounts::add(const Recording& recording) {
  std::vector<std::uint32_t> numbers;
  for (const Recording::Transition& transition : recording.transitions) {
    const auto found = transitions_.find(transition.name);
    if (found == transitions_.end())
      return Problem{fmt::format("the net has no transition '{}'", transition.name)};
    numbers.push_back(found->second);
  }
  for (const Recording::Entry& entry : recording.entries) {
    if (entry.event.kind() == Event::Kind::firing) ++firings_[numbers[entry.event.subject]];
    if (entry.event.kind() != Event::Kind::marking) continue;
    for (std::string_view left = entry.text; !left.empty();) {
      const std::string_view name = left.substr(0, left.find('\n'));
      left.remove_prefix(std::min(left.size(), name.size() + 1));
      if (const auto found = places_.find(std::string(name)); found != places_.end())
        marked_[found->second] = true;
    }
  }
  ++runs_;
  lacks_events_ = lacks_events_ || recording.truncated || recording.lost > 0 || lacks_beginning(recording);
  return std::nullopt;
}

std::optional<Problem> FiringCounts::add(const std::map<std::string, std::uint64_t>& firings,
                                         std::uint64_t runs) {
  for (const auto& [name, count] : firings)
    if (!transitions_.contains(name)) return Problem{fmt::format("the net has no transition '{}'", name)};
  for (const auto& [name, count] : firings) firings_[transitions_.at(name)] += count;
  runs_ += runs;
  return std::nullopt;
}

// ---------------------------------------------------------------------------------------------- the coverage

Coverage::Share& Coverage::Share::operator+=(const Share& more) {
  reached += more.reached;
  all += more.all;
  return *this;
}

double Coverage::Share::share() const {
  return all == 0 ? 1 : static_cast<double>(reached) / static_cast<double>(all);
}

namespace {

using Group = Coverage::Group;
using Missing = Coverage::Missing;

/// Which elements some run could reach, if conditions held whenever they can: tokens are never taken away.
struct Reachable {
  std::vector<bool> places, transitions;

  explicit Reachable(const Net& net) : places(net.places().size()), transitions(net.transitions().size()) {
    std::vector<std::vector<std::uint32_t>> users(net.places().size());
    std::vector<std::size_t> lacks(net.transitions().size());
    std::vector<std::uint32_t> fresh;
    for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
      lacks[index] = net.preset(TransitionId{index}).size();
      for (const net::Arc& arc : net.preset(TransitionId{index})) users[arc.place.value].push_back(index);
    }
    const auto mark = [&](std::uint32_t place) {
      if (places[place]) return;
      places[place] = true;
      fresh.push_back(place);
    };
    const auto enable = [&](std::uint32_t index) {
      if (net.transitions()[index].condition.known(/*failures=*/true).truth == Condition::Truth::never)
        return;
      transitions[index] = true;
      for (const net::Arc& arc : net.postset(TransitionId{index})) mark(arc.place.value);
    };
    for (std::uint32_t place = 0; place < net.places().size(); ++place)
      if (net.places()[place].tokens > 0) mark(place);
    for (std::uint32_t index = 0; index < lacks.size(); ++index)
      if (lacks[index] == 0) enable(index);
    while (!fresh.empty()) {
      const std::uint32_t place = fresh.back();
      fresh.pop_back();
      for (const std::uint32_t index : users[place])
        if (--lacks[index] == 0) enable(index);
    }
  }
};

/// Texts for transitions whose names are not clear.
const char* meaning_of(Step role) {
  switch (role) {
    case Step::overwrite:
      return "overwrites an unread value";
    case Step::skip:
      return "there is nothing to read";
    default:
      return "";
  }
}

/// The position of a condition of `next` in the order of its entries. "No entry holds" comes last.
std::uint32_t rank(const Condition& condition) { return condition.entry.value_or(UINT32_MAX); }

/// Whether the transition of `other` fires only if `condition` does not hold.
bool fires_instead(const Condition& condition, const Condition& other) {
  using Kind = Condition::Kind;
  switch (condition.kind) {
    case Kind::terminal:
      return other.kind == Kind::go_on;
    case Kind::error:
      return other.kind == Kind::go_on || other.kind == Kind::terminal;
    case Kind::next:  // the entries are tried in their order
      return other.kind == Kind::next && rank(other) > rank(condition);
    case Kind::elapsed:
      return other.kind != Kind::elapsed;
    case Kind::send:
      return other.kind == Kind::skip;
    case Kind::skip:
      return other.kind == Kind::send;
    case Kind::go_on:
    case Kind::none:
      break;
  }
  return false;
}

/// Fills a Coverage group by group.
class Measure {
 public:
  Measure(const net::HierarchicalNet& pages, const Net& net, const FiringCounts& counts)
      : pages_(pages), net_(net), counts_(counts), reachable_(net), marked_(net.places().size()) {
    for (std::uint32_t place = 0; place < marked_.size(); ++place)
      marked_[place] =
          counts.was_marked(PlaceId{place}) || (counts.runs() > 0 && net.places()[place].tokens > 0);
    for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
      if (counts.of(TransitionId{index}) > 0)
        for (const net::Arc& arc : net.postset(TransitionId{index})) marked_[arc.place.value] = true;
    find_users();
  }

  Coverage all() {
    make_groups();
    for (std::uint32_t place = 0; place < net_.places().size(); ++place) add_place(place);
    for (std::uint32_t index = 0; index < net_.transitions().size(); ++index) add_transition(index);
    coverage_.groups.push_back(std::move(channels_));
    std::erase_if(coverage_.groups,
                  [](const Group& group) { return group.places.all + group.transitions.all == 0; });
    for (const Group& group : coverage_.groups) {
      coverage_.places += group.places;
      coverage_.transitions += group.transitions;
      coverage_.conditions += group.conditions;
      if (group.kind == Group::Kind::behaviour) coverage_.behaviours += {group.reached ? 1U : 0U, 1};
    }
    coverage_.runs = counts_.runs();
    coverage_.lacks_events = counts_.lacks_events();
    return std::move(coverage_);
  }

 private:
  using Key = std::tuple<net::AgentId, net::SubsystemId, net::BehaviourId>;

  void find_users() {
    users_.resize(net_.places().size());
    for (std::uint32_t index = 0; index < net_.transitions().size(); ++index)
      for (const net::Arc& arc : net_.preset(TransitionId{index}))
        if (const net::Place& place = net_[arc.place]; !place.fused() && !place.fact.valid())
          users_[arc.place.value].push_back(index);
  }

  void make_groups() {
    const net::Parts& parts = net_.parts();
    for (const net::Page& page : pages_.pages) {
      if (page.layer == net::Layer::communication) continue;
      const Key key{page.agent, page.subsystem, page.behaviour};
      if (!groups_.emplace(key, coverage_.groups.size()).second) continue;
      Group group{.path = {}, .kind = Group::Kind::system, .span = page.span};
      if (page.behaviour.valid()) {
        // A group of behaviours has no function; it counts like the subsystem around it.
        group.kind = page.is_group() ? Group::Kind::subsystem : Group::Kind::behaviour;
        group.path = parts.behaviour_path(page.subsystem, page.behaviour);
      } else if (page.subsystem.valid()) {
        group.kind = Group::Kind::subsystem;
        group.path = parts[page.subsystem].path;
      } else if (page.agent.valid()) {
        group.kind = Group::Kind::agent;
        group.path = parts[page.agent];
      }
      coverage_.groups.push_back(std::move(group));
    }
  }

  template <class Element>
  Group& group_of(const Element& element) {
    const auto found = groups_.find({element.agent, element.subsystem, element.behaviour});
    return found == groups_.end() ? channels_ : coverage_.groups[found->second];
  }

  static void count(Group& group, Coverage::Share& share, bool reached, Missing missing) {
    ++share.all;
    if (reached)
      ++share.reached;
    else
      group.missing.push_back(std::move(missing));
  }

  void add_place(std::uint32_t index) {
    const net::Place& place = net_.places()[index];
    if (!reachable_.places[index]) {
      ++coverage_.unreachable;
      return;
    }
    Group& group = place.fused() ? channels_ : group_of(place);
    count(group, group.places, marked_[index], {Missing::Kind::place, place.name, "", place.span});
    const bool enters =
        group.kind != Group::Kind::behaviour || place.is(net::Layer::behaviour, PlaceRole::input);
    if (enters && marked_[index]) group.reached = true;
  }

  void add_transition(std::uint32_t index) {
    const net::Transition& transition = net_.transitions()[index];
    if (!reachable_.transitions[index]) {
      ++coverage_.unreachable;
      return;
    }
    Group& group = group_of(transition);
    const bool fired = counts_.of(TransitionId{index}) > 0;
    count(group, group.transitions, fired,
          {Missing::Kind::transition, transition.name, meaning_of(transition.role), transition.span});
    const Condition& condition = transition.condition;
    if (condition.known(/*failures=*/true).truth != Condition::Truth::free ||
        condition.kind == Condition::Kind::go_on)
      return;
    count(group, group.conditions, fired,
          {Missing::Kind::holds, transition.name, condition.text, transition.span});
    bool can_be_false = false, was_false = false;
    for (const net::Arc& arc : net_.preset(TransitionId{index}))
      for (const std::uint32_t other : users_[arc.place.value]) {
        if (other == index || !reachable_.transitions[other] ||
            !fires_instead(condition, net_.transitions()[other].condition))
          continue;
        can_be_false = true;
        was_false = was_false || counts_.of(TransitionId{other}) > 0;
      }
    if (can_be_false)
      count(group, group.conditions, was_false,
            {Missing::Kind::does_not_hold, transition.name, condition.text, transition.span});
  }

  const net::HierarchicalNet& pages_;
  const Net& net_;
  const FiringCounts& counts_;
  Reachable reachable_;
  std::vector<bool> marked_;  // per place, in some run
  std::vector<std::vector<std::uint32_t>>
      users_;  // per place of a subsystem or above, except facts: transitions that take from it
  std::map<Key, std::size_t> groups_;
  Group channels_{.path = "channels", .kind = Group::Kind::channels};
  Coverage coverage_;
};

}  // namespace

Coverage coverage_of(const net::HierarchicalNet& pages, const Net& net, const FiringCounts& counts) {
  return Measure(pages, net, counts).all();
}

}  // namespace tessera::replay
