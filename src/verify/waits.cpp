#include "verify/waits.hpp"

#include <algorithm>
#include <set>

namespace tessera::verify {
namespace {

using net::PlaceId;
using net::TransitionId;

struct Line {
  std::uint32_t subsystem = 0;
  std::uint32_t peer = net::no_subsystem;
  std::string text;
};

class Waits {
 public:
  Waits(const net::Net& net, const std::vector<TransitionId>& run)
      : net_(net), names_(subsystem_names(net)), tokens_(net.places().size(), 0) {
    for (std::uint32_t place = 0; place < tokens_.size(); ++place)
      tokens_[place] = net.places()[place].tokens;
    for (const TransitionId id : run) {
      for (const net::Arc& arc : net.preset(id)) tokens_[arc.place.value] -= arc.weight;
      for (const net::Arc& arc : net.postset(id)) tokens_[arc.place.value] += arc.weight;
    }
  }

  std::vector<Line> lines() {
    std::set<std::uint32_t> moving;
    for (std::uint32_t index = 0; index < net_.transitions().size(); ++index)
      if (possible({index}) && enabled({index})) moving.insert(net_.transitions()[index].subsystem);
    std::vector<Line> lines;
    for (std::uint32_t index = 0; index < net_.transitions().size(); ++index) {
      const TransitionId id{index};
      const std::uint32_t subsystem = net_[id].subsystem;
      if (subsystem == net::no_subsystem || moving.contains(subsystem) || !possible(id)) continue;
      // Who waits with a timeout is told of by what it waits for, not by what the timeout takes back.
      if (net_[id].condition.kind == net::Condition::Kind::elapsed) continue;
      if (const PlaceId missing = missing_memory(id); missing.valid())
        lines.push_back(line(subsystem, missing));
    }
    for (std::uint32_t index = 0; index < tokens_.size(); ++index)
      if (tokens_[index] > 0 && net_.places()[index].name.ends_with(".none"))
        lines.push_back({net_.places()[index].subsystem, net::no_subsystem,
                         names_[net_.places()[index].subsystem] +
                             " left a behaviour, and none of its initial conditions held"});
    return lines;
  }

 private:
  [[nodiscard]] bool possible(TransitionId id) const {
    return net_[id].condition.truth != net::Condition::Truth::never;
  }
  [[nodiscard]] bool enabled(TransitionId id) const {
    return std::ranges::all_of(net_.preset(id),
                               [&](const net::Arc& arc) { return tokens_[arc.place.value] >= arc.weight; });
  }

  /// The channel place without a token, if that is all that a transition lacks.
  [[nodiscard]] PlaceId missing_memory(TransitionId id) const {
    PlaceId missing;
    for (const net::Arc& arc : net_.preset(id)) {
      if (tokens_[arc.place.value] >= arc.weight) continue;
      if (!net_[arc.place].fused()) return {};
      missing = arc.place;
    }
    return missing;
  }

  [[nodiscard]] Line line(std::uint32_t subsystem, PlaceId missing) const {
    const std::string& name = net_[missing].name;
    const std::size_t dot = name.rfind('.');
    const std::string state = name.substr(dot + 1);
    const std::uint32_t peer = giver(missing, subsystem);
    std::string what = " waits for the memory of ";
    if (state == "full") what = " waits for a value of ";
    if (state == "ack") what = " waits for the acknowledgement of ";
    const std::string from = peer == net::no_subsystem ? ", which nobody gives" : " from " + names_[peer];
    return {subsystem, peer, names_[subsystem] + what + name.substr(0, dot) + from};
  }

  /// Another subsystem that can put a token into the place.
  [[nodiscard]] std::uint32_t giver(PlaceId place, std::uint32_t not_this) const {
    for (std::uint32_t index = 0; index < net_.transitions().size(); ++index) {
      const net::Transition& transition = net_.transitions()[index];
      if (transition.subsystem == not_this || !possible({index})) continue;
      for (const net::Arc& arc : net_.postset({index}))
        if (arc.place == place) return transition.subsystem;
    }
    return net::no_subsystem;
  }

  const net::Net& net_;
  std::vector<std::string> names_;
  std::vector<std::uint32_t> tokens_;
};

}  // namespace

std::vector<std::string> subsystem_names(const net::Net& net) {
  std::vector<std::string> names;
  for (const net::Place& place : net.places()) {
    if (place.subsystem == net::no_subsystem || place.layer != net::Layer::subsystem) continue;
    if (place.subsystem >= names.size()) names.resize(std::size_t{place.subsystem} + 1);
    if (place.name.ends_with(".in")) names[place.subsystem] = place.name.substr(0, place.name.size() - 3);
  }
  return names;
}

std::vector<std::string> waits_after(const net::Net& net, const std::vector<TransitionId>& run,
                                     const std::vector<std::uint32_t>& only) {
  const std::vector<Line> lines = Waits(net, run).lines();
  std::set<std::uint32_t> wanted(only.begin(), only.end());
  for (bool grew = !only.empty(); grew;) {
    grew = false;
    for (const Line& line : lines)
      if (wanted.contains(line.subsystem) && line.peer != net::no_subsystem)
        grew = wanted.insert(line.peer).second || grew;
  }
  std::vector<std::string> texts;
  for (const Line& line : lines)
    if ((only.empty() || wanted.contains(line.subsystem)) && std::ranges::count(texts, line.text) == 0)
      texts.push_back(line.text);
  return texts;
}

}  // namespace tessera::verify
