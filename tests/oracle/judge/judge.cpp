#include "judge.hpp"

#include <algorithm>
#include <map>

#include "conditions.hpp"

namespace oracle {
namespace {

bool contains(const std::vector<int>& places, int place) {
  return std::find(places.begin(), places.end(), place) != places.end();
}

/// Are two tokens, or more, in these places at some time? A place may be named twice.
bool ever_several(const ReachabilityGraph& graph, std::vector<int> places) {
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return some(graph.where([&](const Marking& marking) { return tokens_in(marking, places) > 1; }));
}

}  // namespace

bool Judge::has_ended(const Marking& marking, int subsystem) const {
  const auto& of = net_.subsystems[static_cast<std::size_t>(subsystem)];
  return has_token(marking, of.out) || has_token(marking, of.agent_out) || final(marking);
}

bool Judge::exclusive_channels() const {
  for (const auto& channel : net_.channels) {
    for (const auto& [slot, writing] : channel.writing) {
      std::vector<int> users = writing;
      if (const auto reading = channel.reading.find(slot); reading != channel.reading.end())
        users.insert(users.end(), reading->second.begin(), reading->second.end());
      if (ever_several(graph_, users)) return false;
    }
  }
  return true;
}

bool Judge::deadlock_free() const {
  for (std::size_t s = 0; s < graph_.size(); ++s)
    if (graph_.dead(s) && !final(graph_.marking(s))) return false;
  return true;
}

bool Judge::sound_pages() const {
  for (const auto& page : net_.pages) {
    // When its `out` is marked it is empty otherwise.
    if (some(graph_.where([&](const Marking& marking) {
          return has_token(marking, page.out) && tokens_in(marking, page.places) > 1;
        })))
      return false;
    // No token enters while another is inside.
    std::vector<char> entering(net_.transitions.size());
    for (std::size_t t = 0; t < net_.transitions.size(); ++t) {
      const auto is_inside = [&](int place) { return contains(page.places, place); };
      const std::vector<int>&pre = net_.transitions[t].pre, &post = net_.transitions[t].post;
      entering[t] = contains(post, page.in) && std::none_of(pre.begin(), pre.end(), is_inside) ? 1 : 0;
    }
    const ReachabilityGraph::States entered = graph_.where_enabled(entering);
    for (std::size_t s = 0; s < entered.size(); ++s)
      if (entered[s] != 0 && tokens_in(graph_.marking(s), page.places) > 0) return false;
  }
  return true;
}

ReachabilityGraph::States Judge::stuck(int subsystem) const {
  std::vector<char> own(net_.transitions.size());
  for (std::size_t t = 0; t < own.size(); ++t) own[t] = net_.transitions[t].subsystem == subsystem ? 1 : 0;
  ReachabilityGraph::States stuck = graph_.can_reach(graph_.where_enabled(own));
  for (std::size_t s = 0; s < stuck.size(); ++s)
    stuck[s] = stuck[s] == 0 && !has_ended(graph_.marking(s), subsystem) ? 1 : 0;
  return stuck;
}

bool Judge::goes_on() const {
  for (int s = 0; s < static_cast<int>(net_.subsystems.size()); ++s)
    if (some(stuck(s))) return false;
  return true;
}

ReachabilityGraph::States Judge::dry(int channel) const {
  const auto& of = net_.channels[static_cast<std::size_t>(channel)];
  std::vector<char> reads(net_.transitions.size());
  for (const int read : of.reads) reads[static_cast<std::size_t>(read)] = 1;
  ReachabilityGraph::States good = graph_.where_enabled(reads);
  for (std::size_t s = 0; s < good.size(); ++s)
    if (has_ended(graph_.marking(s), of.receiver)) good[s] = 1;
  return complement(graph_.can_reach(good));
}

bool Judge::channels_flow() const {
  for (int c = 0; c < static_cast<int>(net_.channels.size()); ++c)
    if (net_.channels[static_cast<std::size_t>(c)].received && some(dry(c))) return false;
  return true;
}

std::vector<std::string> Judge::dead_behaviours() const {
  std::vector<std::string> dead;
  for (const auto& behaviour : net_.behaviours)
    if (!some(graph_.where([&](const Marking& marking) { return has_token(marking, behaviour.in); })))
      dead.push_back(behaviour.path);
  return dead;
}

ReachabilityGraph::States Judge::bad(const CompiledProperty& property, Property::Kind kind) const {
  const auto first = graph_.where([&](const Marking& marking) { return property.first.holds(marking); });
  if (kind == Property::Kind::always) return complement(first);
  if (kind == Property::Kind::always_reachable) return complement(graph_.can_reach(first));
  if (kind != Property::Kind::leads_to) return first;
  // F, then past no G to where G can never become true.
  return graph_.losing(first,
                       graph_.where([&](const Marking& marking) { return property.second.holds(marking); }));
}

bool Judge::holds(const Specification& specification, const Property& property) const {
  for (const CompiledProperty& one : compile(specification, net_, property)) {
    const bool exists =
        some(bad(one, property.kind == Property::Kind::reachable ? Property::Kind::never : property.kind));
    if (exists != (property.kind == Property::Kind::reachable)) return false;
  }
  return true;
}

bool sound_model(const Model& model) {
  // A user at either side that never stops: `in` and `out` of a side are one place.
  FlatNet net;
  std::map<std::string, int> shared;
  const auto add = [&](const std::string& name, bool marked) {
    net.places.push_back({name, marked, false});
    return static_cast<int>(net.places.size()) - 1;
  };
  for (const auto& [name, tokens] : model.shared) shared[name] = add(name, tokens > 0);
  std::vector<char> reads;
  std::map<int, std::vector<int>> users;
  for (const ModelSide* side : {&model.send, &model.receive}) {
    std::map<std::string, int> place = shared;
    std::map<std::string, int> slot;
    place["in"] = place["out"] = add("use", true);
    for (const auto& one : side->places) {
      if (one.name != "in" && one.name != "out") place[one.name] = add(one.name, false);
      slot[one.name] = one.slot;
      if (one.slot > 0) users[one.slot].push_back(place[one.name]);
    }
    for (const auto& one : side->transitions) {
      FlatTransition transition;
      for (const auto& name : one.from) transition.pre.push_back(place.at(name));
      for (const auto& name : one.to) transition.post.push_back(place.at(name));
      transition.subsystem = side == &model.send ? 0 : 1;
      net.transitions.push_back(transition);
      reads.push_back(side == &model.receive && std::any_of(one.to.begin(), one.to.end(),
                                                            [&](const auto& name) { return slot[name] > 0; })
                          ? 1
                          : 0);
    }
  }
  const ReachabilityGraph graph(petri_net(net), 100000);
  const auto always_again = [&](const std::vector<char>& transitions) {
    return every(graph.can_reach(graph.where_enabled(transitions)));
  };
  if (!graph.complete() || !graph.safe() || !always_again(reads)) return false;
  for (const int side : {0, 1}) {
    std::vector<char> own;
    for (const auto& transition : net.transitions) own.push_back(transition.subsystem == side ? 1 : 0);
    if (!always_again(own)) return false;
  }
  for (const auto& [slot, places] : users)
    if (ever_several(graph, places)) return false;
  return true;
}

}  // namespace oracle
