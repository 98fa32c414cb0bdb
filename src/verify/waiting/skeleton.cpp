#include "verify/waiting/skeleton.hpp"

#include <algorithm>

#include "verify/circuits/folding.hpp"

namespace tessera::verify {

Skeleton::Skeleton(const CommunicationStructure& structure, std::span<const SubsystemFlowId> subsystems)
    : structure_(structure), memory_(structure.channels.size()), places_of_(structure.subsystems.size()) {
  for (std::uint32_t channel = 0; channel < memory_.size(); ++channel)
    if (holds_up(structure.channels[channel])) memory_[channel] = {place(), place()};
  for (const SubsystemFlowId subsystem : subsystems) draw(subsystem);
}

std::uint32_t Skeleton::place(std::uint32_t tokens) {
  net::Place added;
  added.tokens = tokens;
  return net_.add(std::move(added)).value;
}

std::uint32_t Skeleton::point(SubsystemFlowId subsystem, std::uint32_t tokens) {
  places_of_[subsystem.value].push_back(place(tokens));
  return places_of_[subsystem.value].back();
}

void Skeleton::step(const std::vector<std::uint32_t>& from, const std::vector<std::uint32_t>& to) {
  const auto arcs = [](const std::vector<std::uint32_t>& places) {
    std::vector<net::Arc> all;
    for (const std::uint32_t one : places) all.push_back({{one}, 1});
    return all;
  };
  net_.add(net::Transition{}, arcs(from), arcs(to));
}

void Skeleton::draw(SubsystemFlowId subsystem) {
  const std::vector<BehaviourFlow>& behaviours = structure_[subsystem].behaviours;
  std::vector<std::uint32_t> starts;
  for (std::size_t index = 0; index < behaviours.size(); ++index)
    starts.push_back(point(subsystem, index == 0 ? 1 : 0));
  for (std::size_t index = 0; index < behaviours.size(); ++index) {
    const BehaviourFlow& behaviour = behaviours[index];
    std::uint32_t at = starts[index];
    for (const Stage& stage : behaviour.stages) at = draw_stage(subsystem, stage, at);
    if (behaviour.repeats) step({at}, {starts[index]});
    for (const std::uint32_t next : behaviour.next) step({at}, {starts[next]});
    if (behaviour.ends || !behaviour.complete) step({at}, {});
  }
}

/// Returns the point after the stage.
std::uint32_t Skeleton::draw_stage(SubsystemFlowId subsystem, const Stage& stage, std::uint32_t from) {
  std::vector<Communication> kept;
  std::ranges::copy_if(stage, std::back_inserter(kept), [&](const Communication& communication) {
    return holds_up(structure_[communication.flow]);
  });
  if (kept.empty()) return from;
  ++stages_;
  const std::uint32_t to = point(subsystem);
  if (kept.size() == 1) {
    draw_block(subsystem, kept.front(), from, to);
    return to;
  }
  const std::size_t first_stop = stops_.size(), first_point = places_of_[subsystem.value].size();
  std::vector<std::uint32_t> ins, outs;
  for (const Communication& communication : kept) {
    ins.push_back(point(subsystem));
    outs.push_back(point(subsystem));
    draw_block(subsystem, communication, ins.back(), outs.back());
  }
  step({from}, ins);
  step(outs, {to});
  for (std::size_t index = first_stop; index < stops_.size(); ++index)
    for (std::size_t other = first_point; other < places_of_[subsystem.value].size(); ++other)
      if (places_of_[subsystem.value][other] != stops_[index].place)
        stops_[index].beside.push_back(places_of_[subsystem.value][other]);
  return to;
}

void Skeleton::draw_block(SubsystemFlowId subsystem, const Communication& communication, std::uint32_t from,
                          std::uint32_t to) {
  if (communication.side == Side::send)
    draw_send(subsystem, communication.flow, from, to);
  else
    draw_receive(subsystem, communication.flow, from, to);
}

void Skeleton::draw_send(SubsystemFlowId subsystem, ChannelFlowId channel, std::uint32_t from,
                         std::uint32_t to) {
  const ChannelFlow& flow = structure_[channel];
  const Memory& memory = memory_[channel.value];
  if (!flow.send_blocks) return step({from}, {to, memory.full});
  const std::uint32_t wait = point(subsystem);
  step({from}, {wait, memory.full});
  step({wait, memory.acknowledged}, {to});
  if (flow.send_timeout)
    step({wait, memory.full}, {to});
  else
    stops_.push_back({wait, subsystem, channel, Side::send, {}, stages_});
}

void Skeleton::draw_receive(SubsystemFlowId subsystem, ChannelFlowId channel, std::uint32_t from,
                            std::uint32_t to) {
  const ChannelFlow& flow = structure_[channel];
  const Memory& memory = memory_[channel.value];
  if (flow.send_blocks)
    step({from, memory.full}, {to, memory.acknowledged});
  else
    step({from, memory.full}, {to});
  if (waits_to_receive(flow))
    stops_.push_back({from, subsystem, channel, Side::receive, {}, stages_});
  else
    step({from}, {to});
}

}  // namespace tessera::verify
