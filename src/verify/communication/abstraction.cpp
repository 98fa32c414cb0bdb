#include "verify/communication/abstraction.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "tessera/net_words.hpp"

namespace tessera::verify {
namespace {

using net::Arc;
using net::Condition;
using net::PlaceId;
using net::TransitionId;

/// A place that behaviours leave through initial conditions; and the places of facts that these ask for, which say
/// with which values. The first place is that of the behaviour.
using ExitPlaces = std::vector<PlaceId>;

/// The knowledge about leaving through it.
struct Exit {
  bool certain = false;  ///< one of its conditions holds
  bool entered = false;  ///< something leads to it
  Condition::After none_follows{true, true};
};

/// Empty: several tokens leave.
ExitPlaces exit_of(const net::Net& net, TransitionId id) {
  ExitPlaces places, facts;
  for (const Arc& arc : net.preset(id)) {
    const net::FactId fact = net[arc.place].fact;
    if (!fact.valid()) places.push_back(arc.place);
    if (fact.valid() && std::ranges::count(net[id].condition.asked, fact) > 0) facts.push_back(arc.place);
  }
  if (places.size() != 1) return {};
  std::ranges::sort(facts);
  places.insert(places.end(), facts.begin(), facts.end());
  return places;
}

std::map<ExitPlaces, Exit> exits(const net::Net& net) {
  std::map<ExitPlaces, Exit> found;
  std::vector<bool> entered(net.places().size(), false);
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
    const TransitionId id{index};
    const Condition& condition = net[id].condition;
    if (condition.kind != Condition::Kind::next) continue;
    const ExitPlaces places = exit_of(net, id);
    if (places.empty()) continue;
    Exit& exit = found[places];
    exit.none_follows = condition.none_follows;
    exit.certain = exit.certain || condition.truth == Condition::Truth::always || condition.exhaustive;
  }
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
    const TransitionId id{index};
    if (!possible(net, id)) continue;
    for (const Arc& arc : net.postset(id)) entered[arc.place.value] = true;
  }
  for (auto& [places, exit] : found) exit.entered = entered[places.front().value];
  return found;
}

void add_outcome(net::Net& net, const ExitPlaces& exit, Condition::After none_follows) {
  const net::Place from = net[exit.front()];
  std::string values;  // of the facts: ".grant.missed"
  for (std::size_t fact = 1; fact < exit.size(); ++fact)
    values += net[exit[fact]].name.substr(net.parts()[from.subsystem].path.size());
  net::Place lost = from;
  lost.name = from.name + ".none" + values;
  lost.role = PlaceRole::no_successor;
  lost.tokens = 0;
  lost.operation = {};
  const PlaceId to = net.add(std::move(lost));
  net::Transition none;
  none.name = from.name + std::string(words::no_successor) + values;
  none.role = Step::no_successor;
  none.agent = from.agent;
  none.behaviour = from.behaviour;
  none.condition = {.kind = Condition::Kind::next, .truth = Condition::Truth::free, .text = "none holds"};
  none.condition.follows = none_follows;
  none.layer = net::Layer::subsystem;
  none.page = from.page;
  none.subsystem = from.subsystem;
  none.span = from.span;
  std::vector<Arc> takes{{exit.front(), 1}}, gives{{to, 1}};
  for (std::size_t fact = 1; fact < exit.size(); ++fact) {
    takes.push_back({exit[fact], 1});
    gives.push_back({exit[fact], 1});
  }
  net.add(std::move(none), takes, gives);
}

/// The links of channels between processes, one for each direction that carries something.
class Links {
 public:
  explicit Links(net::Net& to) : to_(to) {}

  /// The link that a transition needs; invalid: none.
  PlaceId needed_by(const net::Net& net, TransitionId id) {
    const Step role = net[id].role;
    const bool delivers = role == Step::deliver || role == Step::replace || role == Step::deliver_older;
    if (!delivers && !acknowledges(net, id)) return {};
    const auto [link, added] = links_.emplace(std::pair(net.channel_of(id), !delivers), PlaceId{});
    if (added) {
      net::Place place{
          .name = net.parts()[net.channel_of(id)] + std::string(delivers ? words::link : words::link_back),
          .tokens = 1,
          .layer = net::Layer::communication,
          .channel = net.channel_of(id)};
      place.role = delivers ? PlaceRole::link : PlaceRole::link_back;
      link->second = to_.add(std::move(place));
    }
    return link->second;
  }

  /// Each may fail once, for ever.
  void add_cuts() {
    for (const auto& [of, link] : links_) {
      net::Transition cut;
      cut.name = to_.parts()[of.first] + std::string(of.second ? words::cut_back : words::cut);
      cut.role = of.second ? Step::cut_back : Step::cut;
      to_.add(std::move(cut), std::vector<Arc>{{link, 1}}, {});
    }
  }

 private:
  /// A blocking sender learns over the network that its value was taken.
  static bool acknowledges(const net::Net& net, TransitionId id) {
    const auto has = [&](PlaceRole role) {
      return std::ranges::any_of(net.preset(id), [&](const Arc& arc) { return net[arc.place].role == role; });
    };
    return net[id].subsystem.valid() && net[id].condition.kind == Condition::Kind::none &&
           has(PlaceRole::idle) && has(PlaceRole::empty);
  }

  net::Net& to_;
  std::map<std::pair<net::ChannelId, bool>, PlaceId> links_;  // by channel and whether it leads back
};

net::Net copied(const net::Net& net, Assume assume) {
  net::Net copy(net.shared_parts());
  for (const net::Place& place : net.places()) copy.add(place);
  Links links(copy);
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
    const TransitionId id{index};
    net::Transition transition = net[id];
    const Condition::Known known = transition.condition.known(assume == Assume::exceptions);
    transition.condition.truth = known.truth;
    transition.condition.exhaustive = known.exhaustive;
    const PlaceId link = assume == Assume::partition ? links.needed_by(net, id) : PlaceId{};
    std::vector<Arc> from(net.preset(id).begin(), net.preset(id).end());
    std::vector<Arc> to(net.postset(id).begin(), net.postset(id).end());
    if (link.valid()) {
      from.push_back({link, 1});
      to.push_back({link, 1});
    }
    copy.add(std::move(transition), from, to);
  }
  links.add_cuts();
  return copy;
}

/// Transitions of a subsystem that take it to its end: into its page's output place, which none of its
/// own transitions empties.
std::vector<bool> last_transitions(const net::Net& net) {
  std::vector<bool> left(net.places().size(), false);
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
    if (net.transitions()[index].subsystem.valid())
      for (const Arc& arc : net.preset(TransitionId{index})) left[arc.place.value] = true;
  std::vector<bool> last(net.transitions().size(), false);
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
    const TransitionId id{index};
    if (!net[id].subsystem.valid() || !possible(net, id)) continue;
    last[index] = std::ranges::any_of(net.postset(id), [&](const Arc& arc) {
      const net::Place& place = net[arc.place];
      return place.is(net::Layer::subsystem, PlaceRole::output) && !left[arc.place.value];
    });
  }
  return last;
}

}  // namespace

bool is_deployed(const net::Net& net) {
  return std::ranges::any_of(net.places(), [](const net::Place& place) { return is_networked(place.role); });
}

bool possible(const net::Net& net, net::TransitionId id) {
  return net[id].condition.truth != net::Condition::Truth::never;
}

net::Net abstract_net(const net::Net& net, Assume assume) {
  net::Net abstract = copied(net, assume);
  for (const auto& [places, exit] : exits(abstract))
    if (exit.entered && !exit.certain) add_outcome(abstract, places, exit.none_follows);
  return abstract;
}

net::Net possible_part(const net::Net& net, std::vector<TransitionId>* fires) {
  net::Net part(net.shared_parts());
  for (const net::Place& place : net.places()) part.add(place);
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
    const TransitionId id{index};
    if (!possible(net, id)) continue;
    part.add(net[id], net.preset(id), net.postset(id));
    if (fires != nullptr) fires->push_back(id);
  }
  return part;
}

ProbedNet probed_net(const net::Net& abstract) {
  const std::vector<bool> last = last_transitions(abstract);
  std::map<net::SubsystemId, PlaceId> ended;  // per subsystem that may end
  std::vector<PlaceId> more(abstract.transitions().size());
  auto next = static_cast<std::uint32_t>(abstract.places().size());
  for (std::uint32_t index = 0; index < more.size(); ++index) {
    if (!last[index]) continue;
    const auto [entry, added] = ended.emplace(abstract.transitions()[index].subsystem, PlaceId{next});
    if (added) ++next;
    more[index] = entry->second;
  }
  // The places that the arcs above speak of have to be there first.
  net::Net places(abstract.shared_parts());
  for (const net::Place& place : abstract.places()) places.add(place);
  std::map<PlaceId, net::SubsystemId> in_order;
  for (const auto& [subsystem, place] : ended) in_order.emplace(place, subsystem);
  for (const auto& [place, subsystem] : in_order) {
    net::Place mark;
    mark.name = "ended " + std::to_string(subsystem.value);
    mark.layer = net::Layer::subsystem;
    mark.subsystem = subsystem;
    places.add(std::move(mark));
  }
  ProbedNet probed;
  probed.net = std::move(places);
  std::map<net::SubsystemId, std::vector<TransitionId>> subsystems;
  std::map<net::ChannelId, std::vector<TransitionId>> channels;
  std::map<net::ChannelId, net::SubsystemId> reader;
  for (std::uint32_t index = 0; index < abstract.transitions().size(); ++index) {
    const TransitionId id{index};
    std::vector<Arc> outputs(abstract.postset(id).begin(), abstract.postset(id).end());
    if (more[index].valid()) outputs.push_back({more[index], 1});
    probed.net.add(abstract[id], abstract.preset(id), outputs);
    if (!abstract[id].subsystem.valid()) continue;
    std::vector<TransitionId>& of_subsystem = subsystems[abstract[id].subsystem];
    if (possible(abstract, id)) of_subsystem.push_back(id);
    for (const Arc& arc : abstract.postset(id)) {
      const net::Operation& operation = abstract[arc.place].operation;
      if (operation.kind != net::Operation::Kind::read) continue;
      channels[operation.channel].push_back(id);
      reader[operation.channel] = abstract[id].subsystem;
    }
  }
  probed.transitions = abstract.transitions().size();
  std::map<net::SubsystemId, TransitionId> probes;
  for (const auto& [place, subsystem] : in_order) {
    net::Transition probe;
    probe.name = "ended " + std::to_string(subsystem.value) + "?";
    const std::vector<Arc> loop{{place, 1}};
    probes[subsystem] = probed.net.add(std::move(probe), loop, loop);
  }
  for (auto& [subsystem, any_of] : subsystems) {
    if (probes.contains(subsystem)) any_of.push_back(probes[subsystem]);
    probed.subsystems.push_back({subsystem, std::move(any_of)});
  }
  for (auto& [channel, any_of] : channels) {
    if (probes.contains(reader[channel])) any_of.push_back(probes[reader[channel]]);
    probed.channels.push_back({channel, std::move(any_of)});
  }
  return probed;
}

}  // namespace tessera::verify
