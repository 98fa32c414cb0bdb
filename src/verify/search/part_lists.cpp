#include "verify/search/part_lists.hpp"

#include <algorithm>
#include <optional>
#include <tuple>

namespace tessera::verify {

using net::Arc;
using net::PlaceId;
using net::TransitionId;

namespace {

const std::vector<PlaceId>& found(const std::map<PartLists::Subsystems, std::vector<PlaceId>>& all,
                                  const PartLists::Subsystems& subsystems) {
  static const std::vector<PlaceId> none;
  const auto at = all.find(subsystems);
  return at == all.end() ? none : at->second;
}

void sort_unique(std::vector<PlaceId>& places) {
  std::ranges::sort(places);
  places.erase(std::unique(places.begin(), places.end()), places.end());
}

}  // namespace

PartLists::PartLists(const net::Net& net, const Surroundings& surroundings)
    : net_(net), surroundings_(surroundings), starts_(net.places().size() + 1, 0) {
  const auto each = [&](auto what) {
    for (std::uint32_t subsystem = 0; subsystem < net.parts().subsystems.size(); ++subsystem)
      for (const TransitionId id : surroundings.transitions({subsystem})) {
        for (const Arc& arc : net.preset(id)) what(id, arc.place);
        for (const Arc& arc : net.postset(id))
          if (std::ranges::find(net.preset(id), arc.place, &Arc::place) == net.preset(id).end())
            what(id, arc.place);
      }
  };
  each([&](TransitionId, PlaceId place) { ++starts_[place.value + 1]; });
  for (std::size_t place = 1; place < starts_.size(); ++place) starts_[place] += starts_[place - 1];
  touching_.resize(starts_.back());
  std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
  each([&](TransitionId id, PlaceId place) { touching_[next[place.value]++] = id; });
  for (std::uint32_t index = 0; index < net.places().size(); ++index) {
    const PlaceId place{index};
    if (!net[place].fused()) continue;
    if (surroundings.users(place).size() > 1) used_by_[surroundings.users(place)].push_back(place);
    of_channels_[surroundings.members(net[place].channel)].push_back(place);
  }
}

std::span<const TransitionId> PartLists::touching(PlaceId place) const {
  return std::span(touching_).subspan(starts_[place.value], starts_[place.value + 1] - starts_[place.value]);
}

const std::vector<PlaceId>& PartLists::used_by(const Subsystems& users) const {
  return found(used_by_, users);
}

const std::vector<PlaceId>& PartLists::of_channels(const Subsystems& members) const {
  return found(of_channels_, members);
}

bool PartLists::may_merge(PlaceId place, net::SubsystemId subsystem) const {
  if (surroundings_.controlled_by(place) != subsystem) return false;
  return net_[place].fused() || (net_[place].behaviour.valid() && !surroundings_.is_started(place));
}

PlaceId PartLists::stands_for(net::FactId fact) const {
  return {static_cast<std::uint32_t>(net_.places().size() + net_.parts().subsystems.size()) + fact.value};
}

class PartLists::Maker {
 public:
  Maker(const PartLists& all, net::SubsystemId subsystem)
      : all_(all), net_(all.net_), surroundings_(all.surroundings_), subsystem_(subsystem) {
    made_.rest = {static_cast<std::uint32_t>(net_.places().size()) + subsystem.value};
  }

  SubsystemLists made() {
    const std::vector<TransitionId>& transitions = surroundings_.transitions(subsystem_);
    for (const TransitionId id : transitions) note(id);
    for (const PlaceId place : control_) {
      tokens_ += net_[place].tokens + (surroundings_.is_started(place) ? 1 : 0);
      if (net_[place].tokens > 0 || surroundings_.is_started(place)) made_.filled.push_back(place);
      if (!net_[place].fused() && all_.may_merge(place, subsystem_))
        made_.behaviours[net_[place].behaviour].push_back(place);
      else
        made_.others.push_back(place);
    }
    made_.is_one_token = !grows_ && tokens_ <= 1;
    made_.keeps_token = !grows_ && !shrinks_ && tokens_ == 1;
    for (auto& [fact, one] : made_.facts) {
      one.is_memory = net_.parts()[fact].kind == net::Parts::Fact::Kind::memory;
      for (const PlaceId place : one.values) one.filled.insert(one.filled.end(), net_[place].tokens, place);
      if (!one.may_merge() || !one.given_first.empty()) made_.special.push_back(fact);
    }
    for (const TransitionId id : transitions) sort_in(id);
    return std::move(made_);
  }

 private:
  [[nodiscard]] bool is_control(PlaceId place) const {
    return surroundings_.controlled_by(place) == subsystem_;
  }

  void note(TransitionId id) {
    std::size_t control_in = 0, control_out = 0;
    bool is_first = false;
    std::map<net::FactId, int> gained;
    const auto look = [&](const Arc& arc, std::size_t& control, int sign) {
      if (is_control(arc.place)) {
        control += arc.weight;
        control_.insert(arc.place);
        is_first = is_first || !all_.may_merge(arc.place, subsystem_);
      }
      if (const net::FactId fact = net_[arc.place].fact; fact.valid()) {
        made_.facts[fact].values.insert(arc.place);
        gained[fact] += sign;
      }
    };
    for (const Arc& arc : net_.preset(id)) look(arc, control_in, -1);
    for (const Arc& arc : net_.postset(id)) look(arc, control_out, 1);
    grows_ = grows_ || control_out > control_in;
    shrinks_ = shrinks_ || control_out < control_in;
    for (const auto& [fact, sum] : gained)
      if (sum > 0) made_.facts[fact].is_one_token = false;
    if (!is_first) return;
    for (const Arc& arc : net_.postset(id))
      if (net_[arc.place].fact.valid()) made_.facts[net_[arc.place].fact].given_first.insert(arc.place);
  }

  /// The places of one side of a transition, once all behaviours count as one place. nullopt: it stays apart.
  struct Side {
    std::vector<PlaceId> places{}, values{};
    std::vector<net::FactId> facts{};
    bool rests = false;
  };
  [[nodiscard]] std::optional<Side> side(std::span<const Arc> arcs) const {
    Side side;
    for (const Arc& arc : arcs) {
      const net::Place& place = net_[arc.place];
      if (place.fact.valid()) {
        const SubsystemLists::Fact& fact = made_.facts.at(place.fact);
        if (!fact.may_merge()) return std::nullopt;
        if (fact.is_memory) side.values.push_back(arc.place);
        continue;
      }
      if (is_control(arc.place)) {
        const bool merged = all_.may_merge(arc.place, subsystem_);
        side.rests = side.rests || merged;
        side.places.push_back(merged ? made_.rest : arc.place);
      } else if (!place.fused()) {
        return std::nullopt;
      }
    }
    std::ranges::sort(side.values, {}, [&](PlaceId place) { return std::pair(net_[place].fact, place); });
    for (const PlaceId place : side.values) side.facts.push_back(net_[place].fact);
    if (std::ranges::adjacent_find(side.facts) != side.facts.end()) return std::nullopt;
    sort_unique(side.places);
    return side;
  }

  void sort_in(TransitionId id) {
    std::optional<Side> in = side(net_.preset(id)), out = side(net_.postset(id));
    if (!made_.is_one_token || !in || !out || !in->rests ||
        in->values.size() + out->values.size() > SubsystemLists::most_values) {
      made_.single.push_back(id);
      return;
    }
    const Key key{in->places, out->places, in->facts, out->facts};
    const auto [entry, added] = numbers_.try_emplace(key, static_cast<std::uint32_t>(made_.alike.size()));
    if (added) made_.alike.push_back({in->places, out->places, in->facts, out->facts});
    std::vector<PlaceId> values = std::move(in->values);
    values.insert(values.end(), out->values.begin(), out->values.end());
    for (std::uint32_t kept = 0; kept < 1U << values.size(); ++kept) {
      std::vector<PlaceId> some = values;
      for (std::size_t at = 0; at < some.size(); ++at)
        if ((kept >> at & 1U) == 0) some[at] = {};
      ++made_.alike[entry->second].count[std::move(some)];
    }
    made_.entries.emplace(id.value, SubsystemLists::Entry{entry->second, std::move(values)});
  }

  using Key = std::tuple<std::vector<PlaceId>, std::vector<PlaceId>, std::vector<net::FactId>,
                         std::vector<net::FactId>>;

  const PartLists& all_;
  const net::Net& net_;
  const Surroundings& surroundings_;
  const net::SubsystemId subsystem_;
  SubsystemLists made_{};
  std::set<PlaceId> control_{};
  std::size_t tokens_ = 0;
  bool grows_ = false, shrinks_ = false;
  std::map<Key, std::uint32_t> numbers_{};
};

const SubsystemLists& PartLists::operator[](net::SubsystemId subsystem) const {
  std::unique_ptr<const SubsystemLists>& lists = subsystems_[subsystem.value];
  if (!lists) lists = std::make_unique<const SubsystemLists>(Maker(*this, subsystem).made());
  return *lists;
}

}  // namespace tessera::verify
