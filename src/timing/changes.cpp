#include "timing/changes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace tessera::timing {
namespace {

using ChangeKind = Change::Kind;

/// The subsystems that a chain can depend on, with the channels between them: a fleet has many others.
struct Part {
  System system;
  std::vector<Chain> ways;
  std::vector<ForeignHop> foreign;
  std::vector<std::uint32_t> subsystems, channels;  ///< their numbers in the whole system
};

std::set<std::uint32_t> connected(const System& system, const std::vector<Chain>& ways) {
  std::vector<std::vector<std::uint32_t>> neighbours(system.subsystems.size());
  const auto join = [&](std::uint32_t a, std::uint32_t b) {
    neighbours[a].push_back(b);
    neighbours[b].push_back(a);
  };
  for (const Channel& channel : system.channels) join(channel.from, channel.to);
  std::map<int, std::uint32_t> on_processor;
  for (std::uint32_t i = 0; i < system.subsystems.size(); ++i) {
    const int processor = system.subsystems[i].processor;
    if (processor < 0) continue;
    const auto [first, is_new] = on_processor.try_emplace(processor, i);
    if (!is_new) join(first->second, i);
  }
  std::set<std::uint32_t> found;  // the parts of a chain over a foreign hop may not be joined
  for (const Chain& way : ways)
    for (const std::uint32_t c : way) found.insert(system.channels[c].from);
  std::vector<std::uint32_t> waiting(found.begin(), found.end());
  while (!waiting.empty()) {
    const std::uint32_t i = waiting.back();
    waiting.pop_back();
    for (const std::uint32_t other : neighbours[i])
      if (found.insert(other).second) waiting.push_back(other);
  }
  return found;
}

Part part_of(const System& system, const std::vector<Chain>& ways) {
  Part part;
  part.system.latency = system.latency;
  std::map<std::uint32_t, std::uint32_t> subsystem, channel;
  for (const std::uint32_t i : connected(system, ways)) {
    subsystem[i] = static_cast<std::uint32_t>(part.subsystems.size());
    part.subsystems.push_back(i);
  }
  for (std::uint32_t c = 0; c < system.channels.size(); ++c) {
    if (!subsystem.contains(system.channels[c].from)) continue;
    channel[c] = static_cast<std::uint32_t>(part.channels.size());
    part.channels.push_back(c);
    Channel& mine = part.system.channels.emplace_back(system.channels[c]);
    mine.from = subsystem[mine.from];
    mine.to = subsystem[mine.to];
  }
  const auto renumber = [&](std::vector<std::uint32_t>& channels) {
    for (std::uint32_t& c : channels) c = channel[c];
  };
  for (const std::uint32_t i : part.subsystems) {
    Subsystem& mine = part.system.subsystems.emplace_back(system.subsystems[i]);
    renumber(mine.sends);
    renumber(mine.receives);
  }
  part.ways = ways;
  for (Chain& way : part.ways) renumber(way);
  return part;
}

std::vector<Change> candidates(const System& system, const std::vector<Chain>& ways) {
  std::vector<Change> all;
  std::set<std::uint32_t> subsystems, channels;
  for (const Chain& way : ways) {
    for (const std::uint32_t c : way) {
      subsystems.insert(system.channels[c].from);
      subsystems.insert(system.channels[c].to);
      channels.insert(c);
    }
  }
  for (const std::uint32_t i : subsystems) {
    if (system.subsystems[i].period > 0) all.push_back({ChangeKind::twice_the_rate, i, 0});
    if (system.subsystems[i].processor >= 0) all.push_back({ChangeKind::own_processor, i, 0});
  }
  for (const std::uint32_t c : channels) {
    const Channel& channel = system.channels[c];
    if (system.subsystems[channel.to].period > 0) all.push_back({ChangeKind::event_driven, channel.to, c});
    all.push_back(
        {channel.receive_blocks ? ChangeKind::receive_goes_on : ChangeKind::receive_waits, channel.to, c});
    all.push_back({channel.send_blocks ? ChangeKind::send_goes_on : ChangeKind::send_waits, channel.from, c});
  }
  return all;
}

ChainBound bound_in(const System& system, const Part& part, const StopAsked& stop) {
  const Bounds bounds(system, stop);
  ChainBound most{0, 0, 0, true};
  for (const Chain& way : part.ways) {
    const ChainBound one = bound_of(bounds, way, part.foreign);
    most.age = std::max(most.age, one.age);
    most.reaction = std::max(most.reaction, one.reaction);
  }
  return most;
}

/// Somebody who has no rate and never waits for another one would call without a pause.
bool has_pause(const System& system, std::uint32_t i) {
  const Subsystem& one = system.subsystems[i];
  const auto blocks = [&](bool Channel::*mode) {
    return [&system, mode](std::uint32_t c) { return system.channels[c].*mode; };
  };
  return one.period > 0 || std::ranges::any_of(one.receives, blocks(&Channel::receive_blocks)) ||
         std::ranges::any_of(one.sends, blocks(&Channel::send_blocks));
}

}  // namespace

System with_change(System system, const Change& change) {
  Subsystem& subsystem = system.subsystems[change.subsystem];
  switch (change.kind) {
    case ChangeKind::twice_the_rate:
      subsystem.period = std::max<Time>(1, std::llround(static_cast<double>(subsystem.period) / 2));
      break;
    case ChangeKind::event_driven:
      subsystem.period = 0;
      subsystem.catch_up = false;
      system.channels[change.channel].receive_blocks = true;
      break;
    case ChangeKind::receive_waits:
      system.channels[change.channel].receive_blocks = true;
      break;
    case ChangeKind::receive_goes_on:
      system.channels[change.channel].receive_blocks = false;
      system.channels[change.channel].receive_timeout = 0;
      break;
    case ChangeKind::send_waits:
      system.channels[change.channel].send_blocks = true;
      break;
    case ChangeKind::send_goes_on:
      system.channels[change.channel].send_blocks = false;
      system.channels[change.channel].send_timeout = 0;
      break;
    case ChangeKind::own_processor:
      subsystem.processor = -1;
      break;
  }
  return system;
}

std::vector<Change> changes_for(const Declared& declared, const DeclaredChain& chain, const StopAsked& stop) {
  std::vector<Change> helpful;
  if (chain.ways.empty()) return helpful;
  Part part = part_of(declared.system, chain.ways);
  part.foreign = chain.foreign;
  const ChainBound now = bound_in(part.system, part, stop);
  for (Change change : candidates(part.system, part.ways)) {
    const System changed = with_change(part.system, change);
    if (!has_pause(changed, change.subsystem)) continue;
    const ChainBound then = bound_in(changed, part, stop);
    if (then.age > now.age || then.reaction > now.reaction) continue;
    if (then.age == now.age && then.reaction == now.reaction) continue;
    change.age = then.age;
    change.reaction = then.reaction;
    change.subsystem = part.subsystems[change.subsystem];
    change.channel = part.channels[change.channel];
    helpful.push_back(change);
  }
  std::ranges::stable_sort(helpful, {}, [](const Change& one) { return std::pair(one.reaction, one.age); });
  return helpful;
}

}  // namespace tessera::timing
