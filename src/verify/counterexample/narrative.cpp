#include "verify/counterexample/narrative.hpp"

#include <algorithm>
#include <span>
#include <string_view>

namespace tessera::verify {
namespace {

using net::Arc;
using net::Condition;
using net::Operation;
using net::TransitionId;

/// The last part of a path.
std::string_view leaf(std::string_view path) { return path.substr(path.rfind('.') + 1); }

/// The description of one firing.
struct Deed {
  std::string behaviour;          ///< in which it happens; empty: between behaviours
  std::string text;               ///< empty: belongs to the deed before
  std::string done;               ///< replaces text once a deed of the same block without text follows
  std::string reason{};           ///< the condition that held; told in plain words
  std::string alone = "goes on";  ///< replaces an empty text if no earlier deed is told with it
  net::BlockId block{};
  std::string transition;   ///< as drawn
  bool then_waits = false;  ///< for an acknowledgement
};

bool touches_wait(const net::Net& net, std::span<const Arc> arcs) {
  return std::ranges::any_of(arcs, [&](const Arc& arc) { return net[arc.place].role == PlaceRole::waiting; });
}

class Teller {
 public:
  Teller(const net::Net& net, Wording wording) : net_(net), plain_(wording == Wording::plain) {}

  [[nodiscard]] std::string subsystem(TransitionId id) const {
    const net::SubsystemId owner = net_[id].subsystem;
    return owner.valid() ? net_.parts()[owner].path : std::string();
  }

  [[nodiscard]] Deed deed(TransitionId id) const {
    if (net_[id].layer == net::Layer::subsystem) return between(id);
    Deed deed;
    deed.behaviour = behaviour_name(net_[id].subsystem, net_[id].behaviour);
    deed.transition = leaf(drawn_name(id));
    deed.block = net_[id].block;
    if (net_[id].layer == net::Layer::behaviour)
      within(id, deed);
    else
      communicate(id, deed);
    return deed;
  }

 private:
  [[nodiscard]] const std::string& behaviour_name(net::SubsystemId subsystem,
                                                  net::BehaviourId behaviour) const {
    return net_.parts()[subsystem].behaviours[behaviour.value];
  }

  /// The name without the facts whose tokens it takes: "t2" of "t2.grant.missed". They are the state before it.
  [[nodiscard]] std::string_view drawn_name(TransitionId id) const {
    std::string_view name = net_[id].name;
    for (const net::Arc& arc : net_.preset(id)) {
      const net::Place& place = net_[arc.place];
      if (place.role != PlaceRole::fact || !place.fact.valid()) continue;
      const net::Parts::Fact& fact = net_.parts()[place.fact];
      const std::size_t at = name.rfind("." + fact.name + "." + fact.values.at(place.value));
      if (at != std::string_view::npos) name = name.substr(0, at);
    }
    return name;
  }

  /// The start of the subsystem and the initial conditions.
  [[nodiscard]] Deed between(TransitionId id) const {
    Deed deed;
    deed.transition = drawn_name(id).substr(subsystem(id).size() + 1);
    if (net_[id].role == Step::no_successor) {
      const net::Place& left = net_[net_.postset(id).front().place];
      deed.text = "leaves " +
                  (left.behaviour.valid() ? behaviour_name(left.subsystem, left.behaviour) : "a behaviour") +
                  ", and none of its initial conditions holds";
      return deed;
    }
    const net::Place& to = net_[net_.postset(id).front().place];
    if (to.is(net::Layer::subsystem, PlaceRole::output)) {
      deed.text = "ends";
    } else if (to.is_of_group() && to.page == net_[id].page) {
      deed.text = "leaves " + behaviour_name(to.subsystem, to.behaviour);
    } else {
      deed.behaviour = behaviour_name(to.subsystem, to.behaviour);
      deed.text = (net_[id].role == Step::start         ? "starts in "
                   : net_[id].role == Step::begin_group ? "begins "
                                                        : "goes on to ") +
                  deed.behaviour;
    }
    const Condition& condition = net_[id].condition;
    if (condition.kind == Condition::Kind::next) deed.reason = condition.text;
    return deed;
  }

  void within(TransitionId id, Deed& deed) const {
    const Condition::Kind kind = net_[id].condition.kind;
    const auto starts_from = [&](Operation::Kind operation) {
      return std::ranges::any_of(net_.preset(id),
                                 [&](const Arc& arc) { return net_[arc.place].operation.kind == operation; });
    };
    if (kind == Condition::Kind::go_on) deed.text = "begins the next round";
    if (kind == Condition::Kind::terminal) deed.text = plain_ ? terminal_words(id) : "is terminal";
    if (kind == Condition::Kind::error) deed.text = "fails";
    if (kind == Condition::Kind::none && starts_from(Operation::Kind::transition_function))
      deed.text = "computes";
  }

  [[nodiscard]] std::string terminal_words(TransitionId id) const {
    return net_[id].condition.truth == Condition::Truth::always ? "is done" : "meets its terminal condition";
  }

  void communicate(TransitionId id, Deed& deed) const {
    const std::string buffer = deed.block.valid() ? net_.parts()[deed.block].name : std::string();
    const bool overwrites = net_[id].role == Step::overwrite;
    if (net_[id].condition.kind == Condition::Kind::elapsed) {
      deed.text = "waits for " + buffer + " until its timeout" + fate_of_value(id);
      return;
    }
    for (const Arc& arc : net_.postset(id)) {
      const Operation::Kind operation = net_[arc.place].operation.kind;
      if (operation == Operation::Kind::write) {
        deed.text = (overwrites ? "overwrites " : "writes ") + buffer;
        deed.done = (overwrites ? "overwrites " : "sends ") + buffer;
      }
      if (operation == Operation::Kind::read) {
        deed.text = "reads " + buffer;
        deed.done = "receives " + buffer;
      }
    }
    const bool sends = std::ranges::any_of(net_.postset(id), [&](const Arc& arc) {
      return net_[arc.place].role == PlaceRole::sent || net_[arc.place].role == PlaceRole::more;
    });
    if (sends) deed.alone = "sends " + buffer;
    if (touches_wait(net_, net_.preset(id))) deed.text = "is acknowledged";
    if (net_[id].role == Step::skip)
      deed.text =
          (net_[id].condition.kind == Condition::Kind::skip ? "sends no " : "finds nothing new in ") + buffer;
    deed.then_waits = touches_wait(net_, net_.postset(id));
  }

  /// The end of a wait over a network: what becomes of the value, which the sender does not know.
  [[nodiscard]] std::string fate_of_value(TransitionId id) const {
    const auto takes = [&](PlaceRole role) {
      return std::ranges::any_of(net_.preset(id),
                                 [&](const Arc& arc) { return net_[arc.place].role == role; });
    };
    if (takes(PlaceRole::sent) || takes(PlaceRole::more)) return ", and the value never arrives";
    if (takes(PlaceRole::idle)) return ", and the value is called back unread";
    return "";
  }

  const net::Net& net_;
  bool plain_;
};

/// The deeds of one act as a sentence.
class Sentence {
 public:
  explicit Sentence(Wording wording) : plain_(wording == Wording::plain) {}

  void add(const Deed& deed) {
    if (deed.text.empty() && !clauses_.empty() && clauses_.back().behaviour == deed.behaviour) {
      Clause& last = clauses_.back();
      last.transitions.push_back(deed.transition);
      if (!last.done.empty() && last.block == deed.block) last.text = last.done;
    } else {
      clauses_.push_back({deed.behaviour,
                          deed.text.empty() ? deed.alone : deed.text,
                          deed.done,
                          deed.reason,
                          deed.block,
                          {deed.transition}});
    }
    if (deed.then_waits)
      clauses_.push_back({deed.behaviour, "waits for the acknowledgement", "", "", deed.block, {}});
  }

  [[nodiscard]] std::string text() const {
    std::string all, behaviour;
    for (const Clause& clause : clauses_) {
      const bool arrives = clause.text.ends_with(" in " + clause.behaviour) ||
                           clause.text.ends_with(" to " + clause.behaviour);
      if (!all.empty()) all += all.ends_with(':') ? " " : ", ";
      if (clause.behaviour != behaviour && !arrives && !clause.behaviour.empty())
        all += "in " + clause.behaviour + ": ";
      behaviour = clause.behaviour;
      all += clause.text;
      if (plain_ && !clause.reason.empty()) all += " because " + clause.reason;
      if (arrives)
        all += ":";
      else if (!plain_ && !clause.transitions.empty())
        all += " (" + joined(clause.transitions) + ")";
    }
    if (all.ends_with(':')) all.pop_back();
    return all;
  }

 private:
  struct Clause {
    std::string behaviour, text, done, reason;
    net::BlockId block{};
    std::vector<std::string> transitions;
  };

  static std::string joined(const std::vector<std::string>& names) {
    std::string all;
    for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
    return all;
  }

  std::vector<Clause> clauses_;
  bool plain_;
};

/// The layers above: starts and ends of the system and its agents.
std::string upper_text(const net::Net& net, std::span<const TransitionId> run) {
  constexpr std::size_t shown = 4;
  std::string system;
  std::vector<std::string> starts, ends;
  for (const TransitionId id : run) {
    const bool enters = is_start(net[id].role);
    if (!net[id].agent.valid())
      system += (system.empty() ? "the system " : " and ") + std::string(enters ? "starts" : "ends");
    else
      (enters ? starts : ends).push_back(net.parts()[net[id].agent]);
  }
  std::string text = system;
  const auto tell = [&](const std::vector<std::string>& agents, const char* does) {
    if (agents.empty()) return;
    text += (text.empty() ? "" : ", ") + std::string(agents.size() == 1 ? "agent " : "agents ");
    for (std::size_t index = 0; index < std::min(shown, agents.size()); ++index)
      text += (index > 0 ? ", " : "") + agents[index];
    if (agents.size() > shown) text += " and " + std::to_string(agents.size() - shown) + " more";
    text += std::string(" ") + does + (agents.size() == 1 ? "s" : "");
  };
  tell(starts, "start");
  tell(ends, "end");
  return text;
}

/// The transitions of the network between processes.
std::string medium_text(const net::Net& net, std::span<const TransitionId> run) {
  std::string text;
  for (const TransitionId id : run) {
    const std::string& channel = net.parts()[net.channel_of(id)];
    std::string one;
    switch (net[id].role) {
      case Step::deliver:
        one = "delivers " + channel;
        break;
      case Step::replace:
        one = "delivers " + channel + " over a value that was not read";
        break;
      case Step::deliver_older:
        one = "delivers an older value of " + channel;
        break;
      case Step::lose_older:
        one = "loses the older values of " + channel + " on the way";
        break;
      case Step::cut_back:
        one = "is cut for acknowledgements of " + channel;
        break;
      default:
        one = "is cut for " + channel;
        break;
    }
    text += (text.empty() ? "" : ", ") + one;
  }
  return text;
}

}  // namespace

std::vector<Act> narrate(const net::Net& net, const std::vector<TransitionId>& run, Wording wording) {
  const Teller teller(net, wording);
  std::vector<Act> acts;
  for (std::size_t first = 0, end = 0; first < run.size(); first = end) {
    const net::SubsystemId subsystem = net[run[first]].subsystem;
    const bool medium = is_of_medium(net[run[first]].role);
    const auto same = [&](TransitionId id) {
      return net[id].subsystem == subsystem && is_of_medium(net[id].role) == medium;
    };
    for (end = first; end < run.size() && same(run[end]);) ++end;
    const std::span<const TransitionId> part = std::span(run).subspan(first, end - first);
    Act& act = acts.emplace_back();
    act.first = first + 1;
    act.last = end;
    act.who = teller.subsystem(part.front());
    const std::uint32_t line = net[part.front()].span.line;
    act.line = net.parts().sources.own_line(line);
    act.included = net.parts().sources.included_line(line);
    if (medium) {
      act.who = "the network";
      act.text = medium_text(net, part);
      continue;
    }
    if (!subsystem.valid()) {
      act.text = upper_text(net, part);
      continue;
    }
    Sentence sentence(wording);
    for (const TransitionId id : part) sentence.add(teller.deed(id));
    act.text = sentence.text();
  }
  return acts;
}

}  // namespace tessera::verify
