#include "chains/followed_chains.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace tessera {
namespace {

/// A way from a device to a channel: the readings that stand beside its values are of one moment.
struct Prefix {
  std::uint32_t channel = 0, parent = nobody_before;
  std::uint32_t number = 0;  ///< among those of its channel

  static constexpr std::uint32_t nobody_before = UINT32_MAX;
};

/// The channels of the part, by their numbers in the whole.
std::vector<std::uint32_t> numbers_here(const ProcessPart& part) {
  std::vector<std::uint32_t> here(part.whole->channels.size(), UINT32_MAX);
  for (std::uint32_t index = 0; index < part.channels.size(); ++index) here[part.channels[index]] = index;
  return here;
}

/// "joints to motors", "robot[3].eye -> robot[3].control -> robot[3].motor"
std::string_view name_of(const ChainMember& member, std::span<char> room) {
  if (member.member == UINT32_MAX) return member.chain->name;
  const auto number = fmt::format_int(member.member);
  std::size_t size = 0;
  const auto put = [&](char letter) {
    if (size < room.size()) room[size++] = letter;
  };
  for (const char letter : member.chain->name) {
    put(letter);
    if (letter == '[') std::ranges::for_each(std::string_view(number.data(), number.size()), put);
  }
  return {room.data(), size};
}

}  // namespace

FollowedChains::FollowedChains(const ProcessPart& part) {
  const System& system = part.system;
  if (system.chain_ways.empty()) return;
  in_channel_.resize(system.channels.size());
  through_.resize(system.instances.size());
  const std::vector<std::uint32_t> here = numbers_here(part);
  const auto is_followed = [&](std::uint32_t channel) {
    return here[channel] != UINT32_MAX && !part.is_networked(here[channel]);
  };

  struct Way {
    std::uint32_t last = 0;  ///< prefix
    ChainMember* member = nullptr;
  };
  std::vector<Prefix> prefixes;
  std::vector<Way> ways;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known;           // of parent and channel
  std::map<std::pair<std::uint32_t, std::uint32_t>, ChainMember*> member_of_chain;  // of row and member
  for (const ChainWay& way : system.chain_ways) {
    if (!std::ranges::all_of(way.channels, is_followed)) continue;
    std::uint32_t at = Prefix::nobody_before;
    for (const std::uint32_t of_whole : way.channels) {
      const std::uint32_t channel = here[of_whole];
      const auto [found, is_new] =
          known.emplace(std::pair(at, channel), static_cast<std::uint32_t>(prefixes.size()));
      if (is_new) prefixes.push_back({channel, at, in_channel_[channel]++});
      at = found->second;
    }
    ChainMember*& member = member_of_chain[{way.chain, way.member}];
    if (member == nullptr) {
      member = &members_.emplace_back();
      member->chain = &system.chains[way.chain];
      member->member = way.member;
      through_[system.channels[here[*way.channels.begin()]].from.instance].layout.begun.push_back(member);
    }
    ways.push_back({at, member});
  }

  std::vector<std::uint32_t> first_of(system.channels.size());  // reading of the receiver
  for (std::uint32_t channel = 0; channel < system.channels.size(); ++channel) {
    if (in_channel_[channel] == 0) continue;
    const End& to = system.channels[channel].to;
    CarriedReadings::Layout& layout = through_[to.instance].layout;
    first_of[channel] = layout.readings;
    layout.readings += in_channel_[channel];
    layout.arrivals.push_back({to.port, first_of[channel], in_channel_[channel]});
    const End& from = system.channels[channel].from;
    CarriedReadings::Layout::Departure departure{from.port, {}};
    departure.readings.resize(in_channel_[channel]);
    through_[from.instance].layout.departures.push_back(std::move(departure));
  }
  const auto reading_of = [&](std::uint32_t prefix) {
    return prefix == Prefix::nobody_before ? 0 : first_of[prefixes[prefix].channel] + prefixes[prefix].number;
  };
  for (const Prefix& prefix : prefixes) {
    const End& from = system.channels[prefix.channel].from;
    auto& departures = through_[from.instance].layout.departures;
    const auto departure =
        std::ranges::find(departures, from.port, &CarriedReadings::Layout::Departure::port);
    departure->readings[prefix.number] = reading_of(prefix.parent);
  }
  for (const Way& way : ways)
    through_[system.channels[prefixes[way.last].channel].to.instance].layout.ends.push_back(
        {reading_of(way.last), way.member});
  for (std::uint32_t instance = 0; instance < through_.size(); ++instance)
    through_[instance].ports = system.instances[instance].net->ports.size();
}

std::unique_ptr<CarriedReadings> FollowedChains::readings_of(std::uint32_t instance) const {
  if (instance >= through_.size()) return nullptr;
  const Through& through = through_[instance];
  if (through.layout.arrivals.empty() && through.layout.departures.empty()) return nullptr;
  return std::make_unique<CarriedReadings>(through.layout, through.ports);
}

std::vector<ChainTimes> FollowedChains::times() const {
  std::vector<ChainTimes> all;
  std::map<const Chain*, std::size_t> row_of;
  const auto proved = [](Duration bound) {
    return bound > Duration::zero() ? std::optional(bound) : std::nullopt;
  };
  const auto raise = [](std::optional<Duration>& most, const std::atomic<std::int64_t>& gauge) {
    const std::int64_t ns = gauge.load(std::memory_order_relaxed);
    if (ns >= 0) most = std::max(most.value_or(Duration::zero()), Duration(ns));
  };
  for (const ChainMember& member : members_) {
    const auto [row, is_new] = row_of.emplace(member.chain, all.size());
    if (is_new) {
      ChainTimes& one = all.emplace_back();
      one.name = member.chain->name;
      one.proved_age = proved(member.chain->age);
      one.proved_reaction = proved(member.chain->reaction);
    }
    ChainTimes& one = all[row->second];
    const AgeGauges& gauges = member.gauges;
    ++one.members;
    one.commands += gauges.commands.load(std::memory_order_relaxed);
    one.over += gauges.over.load(std::memory_order_relaxed);
    raise(one.age, gauges.age_ns);
    raise(one.longest_age, gauges.longest_age_ns);
    raise(one.reaction, gauges.reaction_ns);
    raise(one.longest_reaction, gauges.longest_reaction_ns);
  }
  return all;
}

std::string_view text_of(const ChainExcess& excess, std::span<char> room) {
  std::array<char, 256> name;
  const Chain& chain = *excess.of->chain;
  const auto end =
      fmt::format_to_n(room.data(), room.size(), "{}: {} {:.6g} ms{}, and at most {:.6g} ms is proved",
                       name_of(*excess.of, name), excess.is_reaction ? "a reaction took" : "a command was",
                       seconds(excess.measured) * 1e3, excess.is_reaction ? "" : " old",
                       seconds(excess.is_reaction ? chain.reaction : chain.age) * 1e3);
  return {room.data(), std::min(end.size, room.size())};
}

}  // namespace tessera
