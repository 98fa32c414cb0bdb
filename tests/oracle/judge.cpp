#include "judge.hpp"

#include <algorithm>
#include <map>

#include "conditions.hpp"

namespace oracle {
namespace {

bool some(const StateGraph::Set& set) {
  return std::any_of(set.begin(), set.end(), [](char in) { return in != 0; });
}

Marking marking_of(const std::vector<int>& places) {
  Marking marking;
  for (const int place : places) marking.set(place);
  return marking;
}

/// Two tokens, or more, in these places?
bool several(const Marking& marking, const Marking& places) {
  int tokens = 0;
  for (std::size_t w = 0; w < Marking::words; ++w)
    tokens += __builtin_popcountll(marking.bits[w] & places.bits[w]);
  return tokens > 1;
}

}  // namespace

bool Judge::has_ended(const Marking& marking, int subsystem) const {
  const auto& of = net_.subsystems[static_cast<std::size_t>(subsystem)];
  return marking.has(of.out) || marking.has(of.agent_out) || marking.has(net_.system_out);
}

bool Judge::exclusive_channels() const {
  for (const auto& channel : net_.channels) {
    for (const auto& [slot, writing] : channel.writing) {
      std::vector<int> users = writing;
      if (const auto reading = channel.reading.find(slot); reading != channel.reading.end())
        users.insert(users.end(), reading->second.begin(), reading->second.end());
      const Marking places = marking_of(users);
      if (some(graph_.where([&](const Marking& marking) { return several(marking, places); }))) return false;
    }
  }
  return true;
}

bool Judge::deadlock_free() const {
  for (int s = 0; s < static_cast<int>(graph_.size()); ++s)
    if (graph_.dead(s) && !final(graph_.marking(s))) return false;
  return true;
}

bool Judge::sound_pages() const {
  for (const auto& page : net_.pages) {
    const Marking inside = marking_of(page.places);
    // When its `out` is marked it is empty otherwise.
    if (some(graph_.where([&](const Marking& m) { return m.has(page.out) && several(m, inside); })))
      return false;
    // Nothing enters while something is inside.
    std::vector<char> entering(net_.transitions.size());
    for (std::size_t t = 0; t < net_.transitions.size(); ++t) {
      const Marking pre = marking_of(net_.transitions[t].pre), post = marking_of(net_.transitions[t].post);
      entering[t] = post.has(page.in) && !pre.meets(inside) ? 1 : 0;
    }
    const StateGraph::Set entered = graph_.where_enabled(entering);
    for (std::size_t s = 0; s < entered.size(); ++s)
      if (entered[s] != 0 && graph_.marking(static_cast<int>(s)).meets(inside)) return false;
  }
  return true;
}

StateGraph::Set Judge::stuck(int subsystem) const {
  std::vector<char> own(net_.transitions.size());
  for (std::size_t t = 0; t < own.size(); ++t) own[t] = net_.transitions[t].subsystem == subsystem ? 1 : 0;
  StateGraph::Set stuck = graph_.can_reach(graph_.where_enabled(own));
  for (std::size_t s = 0; s < stuck.size(); ++s)
    stuck[s] = stuck[s] == 0 && !has_ended(graph_.marking(static_cast<int>(s)), subsystem) ? 1 : 0;
  return stuck;
}

bool Judge::goes_on() const {
  for (int s = 0; s < static_cast<int>(net_.subsystems.size()); ++s)
    if (some(stuck(s))) return false;
  return true;
}

StateGraph::Set Judge::dry(int channel) const {
  const auto& of = net_.channels[static_cast<std::size_t>(channel)];
  std::vector<char> reads(net_.transitions.size());
  for (const int read : of.reads) reads[static_cast<std::size_t>(read)] = 1;
  StateGraph::Set good = graph_.where_enabled(reads);
  for (std::size_t s = 0; s < good.size(); ++s)
    if (has_ended(graph_.marking(static_cast<int>(s)), of.receiver)) good[s] = 1;
  StateGraph::Set dry = graph_.can_reach(good);
  for (char& state : dry) state = state == 0 ? 1 : 0;
  return dry;
}

bool Judge::channels_flow() const {
  for (int c = 0; c < static_cast<int>(net_.channels.size()); ++c)
    if (net_.channels[static_cast<std::size_t>(c)].received && some(dry(c))) return false;
  return true;
}

std::vector<std::string> Judge::dead_behaviours() const {
  std::vector<std::string> dead;
  for (const auto& behaviour : net_.behaviours)
    if (!some(graph_.where([&](const Marking& marking) { return marking.has(behaviour.in); })))
      dead.push_back(behaviour.path);
  return dead;
}

StateGraph::Set Judge::bad(const CompiledProperty& property, Property::Kind kind) const {
  const auto first = graph_.where([&](const Marking& marking) { return property.first.holds(marking); });
  StateGraph::Set bad = first;
  if (kind == Property::Kind::always)
    for (char& state : bad) state = state == 0 ? 1 : 0;
  if (kind == Property::Kind::always_reachable) {
    bad = graph_.can_reach(first);
    for (char& state : bad) state = state == 0 ? 1 : 0;
  }
  if (kind == Property::Kind::leads_to) {
    // F, then past no G to where G can never become true.
    const auto second = graph_.where([&](const Marking& marking) { return property.second.holds(marking); });
    StateGraph::Set never = graph_.can_reach(second), not_second = second;
    for (char& state : never) state = state == 0 ? 1 : 0;
    for (char& state : not_second) state = state == 0 ? 1 : 0;
    const auto lost = graph_.can_reach(never, not_second);
    for (std::size_t s = 0; s < bad.size(); ++s) bad[s] = first[s] != 0 && lost[s] != 0 ? 1 : 0;
  }
  return bad;
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
  // Somebody at either side who uses it for ever: `in` and `out` of a side are one place.
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
  const StateGraph graph(net, 100000);
  const auto always_again = [&](const std::vector<char>& transitions) {
    const auto can = graph.can_reach(graph.where_enabled(transitions));
    return std::all_of(can.begin(), can.end(), [](char in) { return in != 0; });
  };
  if (!graph.complete() || !graph.safe() || !always_again(reads)) return false;
  for (const int side : {0, 1}) {
    std::vector<char> own;
    for (const auto& transition : net.transitions) own.push_back(transition.subsystem == side ? 1 : 0);
    if (!always_again(own)) return false;
  }
  for (const auto& [slot, places] : users) {
    const Marking marking = marking_of(places);
    if (some(graph.where([&](const Marking& m) { return several(m, marking); }))) return false;
  }
  return true;
}

}  // namespace oracle
