#include "verify/search/local_view.hpp"

#include <algorithm>
#include <span>
#include <tuple>
#include <utility>

#include "verify/communication/abstraction.hpp"

namespace tessera::verify {
namespace {

using explore::Formula;
using net::Arc;
using net::ChannelId;
using net::PlaceId;
using net::SubsystemId;
using net::TransitionId;

constexpr std::uint32_t left_out = 0xFFFFFFFFU;
const LocalViews::Members no_members;

}  // namespace

LocalViews::LocalViews(const net::Net& net)
    : net_(net),
      touching_(net.places().size()),
      places_(net.parts().subsystems.size()),
      local_(net.places().size(), left_out) {
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
    const TransitionId id{index};
    if (!possible(net, id)) continue;
    std::set<PlaceId> touched;
    for (const auto& side : {net.preset(id), net.postset(id)})
      for (const Arc& arc : side) touched.insert(arc.place);
    for (const PlaceId place : touched) {
      touching_[place.value].push_back(id);
      if (net[place].channel.valid() && net[id].subsystem.valid())
        users_[net[place].channel].insert(net[id].subsystem);
    }
  }
  for (std::uint32_t index = 0; index < net.places().size(); ++index) {
    const net::Place& place = net.places()[index];
    if (place.channel.valid())
      places_of_channel_[place.channel].push_back({index});
    else if (const SubsystemId of = owner({index}); of.valid())
      places_[of.value].push_back({index});
    else
      upper_.push_back({index});
  }
  for (const auto& [channel, users] : users_)
    for (const SubsystemId user : users) {
      channels_of_[user].push_back(channel);
      for (const SubsystemId other : users)
        if (other != user) peers_[user].insert(other);
    }
}

const LocalViews::Members& LocalViews::peers(SubsystemId subsystem) const {
  const auto found = peers_.find(subsystem);
  return found == peers_.end() ? no_members : found->second;
}

SubsystemId LocalViews::owner(PlaceId id) const {
  const net::Place& place = net_[id];
  if (place.channel.valid()) return {};
  return place.fact.valid() ? net_.parts()[place.fact].subsystem : place.subsystem;
}

/// One picture and its markings.
class LocalViews::Picture {
 public:
  Picture(LocalViews& views, const Members& members, const Question& question)
      : views_(views), net_(views.net_), members_(members), question_(question) {
    map_places();
    make_steps();
    join_chains();
  }
  ~Picture() {
    for (const PlaceId place : mapped_) views_.local_[place.value] = left_out;
  }
  Picture(const Picture&) = delete;
  Picture& operator=(const Picture&) = delete;
  Picture(Picture&&) = delete;
  Picture& operator=(Picture&&) = delete;

  [[nodiscard]] LocalNet net() && {
    return {std::move(initial_),        std::move(steps_),          question_.kind,
            translated(question_.what), translated(question_.then), !question_.any_of.empty()};
  }
  [[nodiscard]] const std::vector<PlaceId>& mapped() const { return mapped_; }
  [[nodiscard]] std::uint32_t local(PlaceId place) const { return views_.local_[place.value]; }

 private:
  void keep(PlaceId place) { add(place, fresh()); }
  std::uint32_t fresh() {
    members_of_.emplace_back();
    return static_cast<std::uint32_t>(members_of_.size() - 1);
  }
  void add(PlaceId place, std::uint32_t local) {
    views_.local_[place.value] = local;
    mapped_.push_back(place);
    members_of_[local].push_back(place);
  }
  [[nodiscard]] bool is_mapped(PlaceId place) const { return views_.local_[place.value] != left_out; }
  [[nodiscard]] bool is_member(SubsystemId subsystem) const { return members_.contains(subsystem); }

  void map_places() {
    for (const PlaceId place : std::set<PlaceId>(question_.places.begin(), question_.places.end()))
      keep(place);
    for (const SubsystemId member : members_) find_channels(member);
    for (const ChannelId channel : channels_)
      for (const PlaceId place : views_.places_of_channel_.at(channel))
        if (!is_mapped(place)) keep(place);
    for (const SubsystemId member : members_) map_subsystem(member, true);
    Members others;
    for (const ChannelId channel : channels_)
      for (const SubsystemId user : views_.users_.at(channel))
        if (!is_member(user)) others.insert(user);
    for (const SubsystemId other : others) map_subsystem(other, false);
    others.insert(members_.begin(), members_.end());
    std::set<net::AgentId> agents;
    for (const SubsystemId one : others) agents.insert(net_.parts()[one].agent);
    for (const PlaceId place : views_.upper_) {
      const net::Place& of = net_[place];
      const bool starts = of.tokens > 0 || (of.role == PlaceRole::input && agents.contains(of.agent));
      if (starts && !is_mapped(place)) keep(place);
    }
  }

  /// Kept channels: between members, and all of members with few peers.
  void find_channels(SubsystemId member) {
    const auto found = views_.channels_of_.find(member);
    if (found == views_.channels_of_.end()) return;
    for (const ChannelId channel : found->second)
      if (!views_.has_many_peers(member) ||
          std::ranges::all_of(views_.users_.at(channel), [&](SubsystemId user) { return is_member(user); }))
        channels_.insert(channel);
  }

  void map_subsystem(SubsystemId subsystem, bool member) {
    const std::vector<bool> kept = kept_behaviours(subsystem, member);
    std::map<std::string, std::uint32_t> groups;
    const auto group = [&](PlaceId place, const std::string& name) {
      const auto [entry, added] = groups.emplace(name, 0);
      if (added) entry->second = fresh();
      add(place, entry->second);
    };
    for (const PlaceId place : views_.places_[subsystem.value]) {
      const net::Place& of = net_[place];
      if (is_mapped(place) || of.fact.valid()) continue;
      if (member && (!of.behaviour.valid() || kept[of.behaviour.value]))
        keep(place);
      else
        group(place, where(of));
    }
    std::set<net::FactId> given;  // those of which a kept behaviour gives a value
    for (const PlaceId place : views_.places_[subsystem.value])
      if (net_[place].fact.valid() && is_given(place)) given.insert(net_[place].fact);
    for (const PlaceId place : views_.places_[subsystem.value]) {
      const net::Place& of = net_[place];
      if (is_mapped(place) || !of.fact.valid()) continue;
      if (member && given.contains(of.fact) && (of.tokens > 0 || is_given(place)))
        keep(place);
      else
        group(place, "fact " + std::to_string(of.fact.value));
    }
  }

  /// Places outside blocks of kept channels are somewhere else; in such blocks, the same places are one.
  [[nodiscard]] std::string where(const net::Place& place) const {
    if (!place.block.valid() || !channels_.contains(net_.parts()[place.block].channel)) return "elsewhere";
    return std::to_string(net_.parts()[place.block].channel.value) +
           (net_.parts()[place.block].sends ? "s" : "r") + place.name.substr(place.name.rfind('.'));
  }

  /// Behaviours that use no channel, or a kept one; of a member with few peers all.
  [[nodiscard]] std::vector<bool> kept_behaviours(SubsystemId subsystem, bool member) const {
    const std::size_t count = net_.parts()[subsystem].behaviours.size();
    if (!member) return std::vector<bool>(count, false);
    if (!views_.has_many_peers(subsystem)) return std::vector<bool>(count, true);
    std::vector<bool> uses(count, false), uses_kept(count, false);
    for (const PlaceId place : views_.places_[subsystem.value]) {
      const net::Place& of = net_[place];
      if (!of.behaviour.valid()) continue;
      if (std::ranges::count(question_.places, place) > 0) uses_kept[of.behaviour.value] = true;
      if (!of.block.valid()) continue;
      uses[of.behaviour.value] = true;
      if (channels_.contains(net_.parts()[of.block].channel)) uses_kept[of.behaviour.value] = true;
    }
    for (std::size_t behaviour = 0; behaviour < count; ++behaviour)
      if (!uses[behaviour]) uses_kept[behaviour] = true;
    return uses_kept;
  }

  /// Whether a transition of a kept behaviour gives that value of a fact.
  [[nodiscard]] bool is_given(PlaceId place) const {
    return std::ranges::any_of(views_.touching_[place.value], [&](TransitionId id) {
      const auto gives = [&](const Arc& arc) { return arc.place == place; };
      return std::ranges::any_of(net_.postset(id), gives) && std::ranges::none_of(net_.preset(id), gives) &&
             (touches_kept(net_.preset(id)) || touches_kept(net_.postset(id)));
    });
  }
  [[nodiscard]] bool touches_kept(std::span<const Arc> arcs) const {
    return std::ranges::any_of(arcs, [&](const Arc& arc) {
      const std::uint32_t local = views_.local_[arc.place.value];
      return local != left_out && members_of_[local].size() == 1 && net_[arc.place].behaviour.valid();
    });
  }

  void make_steps() {
    steps_.clear();
    initial_.assign(members_of_.size(), '\0');
    for (const PlaceId place : mapped_)
      initial_[views_.local_[place.value]] =
          static_cast<char>(initial_[views_.local_[place.value]] + static_cast<char>(net_[place].tokens));
    std::set<TransitionId> touched;
    for (const PlaceId place : mapped_)
      touched.insert(views_.touching_[place.value].begin(), views_.touching_[place.value].end());
    const std::set<TransitionId> counted(question_.any_of.begin(), question_.any_of.end());
    std::map<std::tuple<std::vector<std::uint32_t>, std::vector<std::uint32_t>, bool>,
             std::set<std::vector<PlaceId>>>
        presets;
    for (const TransitionId id : touched) {
      bool whole = true;
      std::vector<PlaceId> preset;
      std::vector<std::uint32_t> takes, gives;
      for (const Arc& arc : net_.preset(id)) {
        const std::uint32_t local = views_.local_[arc.place.value];
        whole = whole && local != left_out;
        if (local == left_out) continue;
        preset.push_back(arc.place);
        takes.insert(takes.end(), arc.weight, local);
      }
      for (const Arc& arc : net_.postset(id))
        if (const std::uint32_t local = views_.local_[arc.place.value]; local != left_out)
          gives.insert(gives.end(), arc.weight, local);
      std::ranges::sort(takes);
      std::ranges::sort(gives);
      std::ranges::sort(preset);
      if (takes == gives && !counted.contains(id)) continue;
      auto& whole_presets = presets[{std::move(takes), std::move(gives), counted.contains(id)}];
      const bool stays = std::ranges::none_of(preset, [&](PlaceId place) { return passes_.contains(place); });
      if (whole && stays) whole_presets.insert(std::move(preset));
    }
    for (const auto& [step, whole_presets] : presets) {
      const auto& [takes, gives, counts] = step;
      std::size_t ways = 1;
      bool single = true;  // at most one token of each place
      for (std::size_t at = 0; at < takes.size(); ++at) {
        ways *= static_cast<std::size_t>(std::ranges::count_if(
            members_of_[takes[at]], [&](PlaceId place) { return !passes_.contains(place); }));
        single = single && (at == 0 || takes[at] != takes[at - 1]);
      }
      steps_.push_back({takes, gives, single && whole_presets.size() == ways, counts});
    }
  }

  /// A token that can only move on to one place, whatever else happens, counts as if it had done so.
  void join_chains() {
    std::vector<std::uint32_t> consumers(members_of_.size(), 0), to(members_of_.size());
    for (std::uint32_t local = 0; local < to.size(); ++local) to[local] = local;
    for (const LocalNet::Step& step : steps_)
      for (const std::uint32_t local : step.takes) ++consumers[local];
    const auto end_of = [&](std::uint32_t local) {
      while (to[local] != local) local = to[local];
      return local;
    };
    const auto is_free = [&](std::uint32_t local) {
      return members_of_[local].size() == 1 &&
             std::ranges::count(question_.places, members_of_[local].front()) == 0;
    };
    for (const LocalNet::Step& step : steps_) {
      if (!step.certain || step.counts || step.takes.size() != 1 || step.gives.size() != 1) continue;
      const std::uint32_t from = step.takes.front(), next = step.gives.front();
      if (consumers[from] != 1 || !is_free(from) || !is_free(next) || end_of(next) == from) continue;
      to[from] = next;
      passes_.insert(members_of_[from].front());
    }
    std::vector<std::vector<PlaceId>> joined;
    std::vector<std::uint32_t> number(to.size(), left_out);
    for (std::uint32_t local = 0; local < to.size(); ++local) {
      std::uint32_t& group = number[end_of(local)];
      if (group == left_out) {
        group = static_cast<std::uint32_t>(joined.size());
        joined.emplace_back();
      }
      joined[group].insert(joined[group].end(), members_of_[local].begin(), members_of_[local].end());
    }
    members_of_ = std::move(joined);
    for (std::uint32_t local = 0; local < members_of_.size(); ++local)
      for (const PlaceId place : members_of_[local]) views_.local_[place.value] = local;
    make_steps();
  }

  /// A formula over places of the net, over local ones.
  [[nodiscard]] Formula translated(Formula formula) const {
    if (formula.kind == Formula::Kind::at_least) formula.node = views_.local_[formula.node];
    for (Formula& part : formula.parts) part = translated(std::move(part));
    return formula;
  }

  LocalViews& views_;
  const net::Net& net_;
  const Members& members_;
  const Question& question_;
  std::set<ChannelId> channels_;
  std::vector<PlaceId> mapped_;
  std::set<PlaceId> passes_;  // a token in them moves on to another place that counts as one with them
  std::vector<std::vector<PlaceId>> members_of_;  // per local place
  std::vector<LocalNet::Step> steps_;
  std::string initial_;
};

LocalViews::Answer LocalViews::judge(const Members& members, const Question& question,
                                     const explore::Budget& budget) {
  Picture picture(*this, members, question);
  const LocalNet net = std::move(picture).net();
  auto [known, added] = known_.try_emplace(net.key());
  if (added) known->second = net.doubts(budget, most_markings);
  const std::optional<LocalNet::Doubts>& doubts = known->second;
  Answer answer{.known = doubts.has_value(), .holds = doubts && !doubts->any};
  if (!answer.known || answer.holds) return answer;
  for (const PlaceId place : picture.mapped())
    if (!std::ranges::binary_search(doubts->places, picture.local(place))) answer.settled.insert(place);
  return answer;
}

}  // namespace tessera::verify
