#include "verify/search/merged_places.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <span>
#include <utility>

namespace tessera::verify {

using net::Arc;
using net::PlaceId;
using net::TransitionId;

class MergedPlaces::Finder {
 public:
  Finder(MergedPlaces& found, const net::Net& net, const Surroundings& surroundings,
         const std::set<net::SubsystemId>& subsystems, const std::set<PlaceId>& asked, std::size_t few)
      : found_(found),
        net_(net),
        surroundings_(surroundings),
        subsystems_(subsystems),
        asked_(asked),
        few_(few) {}

  void find() {
    find_joining_channels();
    std::vector<Group> groups;
    for (const net::SubsystemId subsystem : subsystems_) {
      find_what_matters(subsystem);
      if (holds_one_token(subsystem)) find_groups(subsystem, groups);
    }
    std::size_t most = few_;
    for (const Group& group : groups) most = std::max(most, group.behaviours.size());
    for (const Group& group : groups)
      if (group.behaviours.size() > few_ && 2 * group.behaviours.size() > most) merge(group.places);
    for (const net::SubsystemId subsystem : subsystems_) find_values(subsystem);
  }

 private:
  struct Group {
    std::vector<PlaceId> places;
    std::set<net::BehaviourId> behaviours;
  };
  using Behaviour = std::pair<net::SubsystemId, net::BehaviourId>;

  [[nodiscard]] bool is_control(PlaceId place, net::SubsystemId subsystem) const {
    return surroundings_.controlled_by(place) == subsystem;
  }

  /// Whether the place belongs to a channel between the subsystems.
  [[nodiscard]] bool joins(PlaceId place) const {
    const net::ChannelId channel = net_[place].channel;
    return channel.valid() && joining_[channel.value];
  }

  void find_joining_channels() {
    joining_.resize(net_.parts().channels.size(), false);
    for (std::uint32_t channel = 0; channel < joining_.size(); ++channel)
      joining_[channel] = surroundings_.is_between({channel}, subsystems_);
  }

  template <class Do>
  void each_arc(TransitionId id, Do on) const {
    for (const auto arcs : {net_.preset(id), net_.postset(id)})
      for (const Arc& arc : arcs) on(arc.place);
  }

  void find_what_matters(net::SubsystemId subsystem) {
    for (const PlaceId place : asked_)
      if (net_[place].behaviour.valid()) matters_.insert({net_[place].subsystem, net_[place].behaviour});
    std::map<PlaceId, std::set<Behaviour>> givers;  // of values that are asked about
    const auto behaviours_of = [&](TransitionId id, std::set<Behaviour>& to) {
      each_arc(id, [&](PlaceId place) {
        if (net_[place].behaviour.valid() && !net_[place].fused())
          to.insert({net_[place].subsystem, net_[place].behaviour});
      });
    };
    for (const TransitionId id : surroundings_.transitions(subsystem)) {
      bool joined = false;
      each_arc(id, [&](PlaceId place) {
        joined = joined || joins(place) || (net_[place].fused() && asked_.contains(place));
      });
      if (joined) behaviours_of(id, matters_);
      for (const Arc& arc : net_.postset(id))
        if (net_[arc.place].fact.valid() && asked_.contains(arc.place) &&
            std::ranges::count(net_.preset(id), arc) == 0)
          behaviours_of(id, givers[arc.place]);
    }
    for (const auto& [value, behaviours] : givers)
      if (behaviours.size() <= few_) matters_.insert(behaviours.begin(), behaviours.end());
  }

  /// Whether what the subsystem does is always one token.
  [[nodiscard]] bool holds_one_token(net::SubsystemId subsystem) const {
    std::vector<bool> met(net_.places().size(), false);
    std::size_t tokens = 0;
    for (const TransitionId id : surroundings_.transitions(subsystem)) {
      const auto count = [&](std::span<const Arc> arcs) {
        std::size_t sum = 0;
        for (const Arc& arc : arcs)
          if (is_control(arc.place, subsystem)) sum += arc.weight;
        return sum;
      };
      if (count(net_.postset(id)) > count(net_.preset(id))) return false;
      each_arc(id, [&](PlaceId place) {
        if (!is_control(place, subsystem) || met[place.value]) return;
        met[place.value] = true;
        tokens += net_[place].tokens + (surroundings_.is_started(place) ? 1 : 0);
      });
    }
    return tokens <= 1;
  }

  [[nodiscard]] bool may_merge(PlaceId place, net::SubsystemId subsystem) const {
    if (!is_control(place, subsystem) || asked_.contains(place) || joins(place)) return false;
    return net_[place].fused() || (net_[place].behaviour.valid() && !surroundings_.is_started(place) &&
                                   !matters_.contains({subsystem, net_[place].behaviour}));
  }

  /// Behaviours that do not matter and lead to one another.
  void find_groups(net::SubsystemId subsystem, std::vector<Group>& groups) const {
    constexpr std::uint32_t none = ~0U;
    std::vector<std::uint32_t> leads(net_.places().size(), none);  // towards the one that stands for all
    std::vector<PlaceId> places;
    const auto first = [&](std::uint32_t place) {
      while (leads[place] != place) place = leads[place] = leads[leads[place]];
      return place;
    };
    for (const TransitionId id : surroundings_.transitions(subsystem)) {
      std::optional<PlaceId> before;
      each_arc(id, [&](PlaceId place) {
        if (leads[place.value] == none) {
          if (!may_merge(place, subsystem)) return;
          leads[place.value] = place.value;
          places.push_back(place);
        }
        if (before) leads[first(place.value)] = first(before->value);
        before = place;
      });
    }
    std::map<std::uint32_t, Group> all;
    for (const PlaceId place : places) {
      Group& group = all[first(place.value)];
      group.places.push_back(place);
      if (net_[place].behaviour.valid()) group.behaviours.insert(net_[place].behaviour);
    }
    for (auto& [place, group] : all) groups.push_back(std::move(group));
  }

  void merge(const std::vector<PlaceId>& places) {
    for (const PlaceId place : places) {
      found_.stands_for_[place.value] = places.front();
      found_.merged_[place.value] = true;
    }
  }

  struct Values {
    std::set<PlaceId> all, given;
    std::size_t tokens = 0;
    bool joined = false;  // a use of a channel between the subsystems changes it
    bool one_token = true;
  };

  [[nodiscard]] std::map<net::FactId, Values> facts_of(net::SubsystemId subsystem) const {
    std::map<net::FactId, Values> facts;
    for (const TransitionId id : surroundings_.transitions(subsystem)) {
      bool joined = false, is_apart = false;
      std::vector<net::FactId> taken, given;
      const auto note = [&](PlaceId place, std::vector<net::FactId>& to) {
        joined = joined || joins(place);
        is_apart = is_apart || (is_control(place, subsystem) && !found_.merged_[place.value]);
        if (net_[place].fact.valid()) to.push_back(net_[place].fact);
      };
      for (const Arc& arc : net_.preset(id)) note(arc.place, taken);
      for (const Arc& arc : net_.postset(id)) note(arc.place, given);
      if (taken.empty() && given.empty()) continue;
      each_arc(id, [&](PlaceId place) {
        if (!net_[place].fact.valid()) return;
        Values& values = facts[net_[place].fact];
        if (values.all.insert(place).second) values.tokens += net_[place].tokens;
      });
      for (const Arc& arc : net_.postset(id)) {
        const net::FactId fact = net_[arc.place].fact;
        if (!fact.valid()) continue;
        Values& values = facts[fact];
        if (std::ranges::count(given, fact) > std::ranges::count(taken, fact)) values.one_token = false;
        if (is_apart) values.given.insert(arc.place);
        if (joined && std::ranges::count(net_.preset(id), arc) == 0) values.joined = true;
      }
    }
    return facts;
  }

  void find_values(net::SubsystemId subsystem) {
    for (const auto& [fact, values] : facts_of(subsystem)) {
      const bool is_memory = net_.parts()[fact].kind == net::Parts::Fact::Kind::memory;
      const bool is_apart = is_memory || values.joined || std::ranges::any_of(values.all, [&](PlaceId place) {
                              return asked_.contains(place);
                            });
      std::vector<PlaceId> others;
      for (const PlaceId place : values.all)
        if (!asked_.contains(place) && (!is_apart || !values.given.contains(place))) others.push_back(place);
      if (others.size() < 2 || !values.one_token || values.tokens > 1) continue;
      merge(others);
      if (others.size() < values.all.size()) continue;
      for (const PlaceId place : others) found_.stands_for_[place.value] = {};  // it is always there
    }
  }

  MergedPlaces& found_;
  const net::Net& net_;
  const Surroundings& surroundings_;
  const std::set<net::SubsystemId>& subsystems_;
  const std::set<PlaceId>& asked_;
  const std::size_t few_;
  std::set<Behaviour> matters_;
  std::vector<bool> joining_;  // per channel
};

MergedPlaces::MergedPlaces(const net::Net& net, const Surroundings& surroundings,
                           const std::set<net::SubsystemId>& subsystems, const std::set<PlaceId>& asked,
                           std::size_t few)
    : merged_(net.places().size(), false) {
  for (std::uint32_t place = 0; place < net.places().size(); ++place) stands_for_.push_back({place});
  Finder(*this, net, surroundings, subsystems, asked, few).find();
}

}  // namespace tessera::verify
