#include "verify/circuits/circuit_criterion.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>

#include "verify/circuits/event_graph.hpp"
#include "verify/circuits/folding.hpp"
#include "verify/circuits/recurring_uses.hpp"

namespace tessera::verify {
namespace {

using Edge = EventGraph::Edge;

/// The numbers of the groups of subsystems that are joined by channels at which one of them may have to wait.
std::vector<std::uint32_t> groups_of(const CommunicationStructure& structure) {
  std::vector<std::uint32_t> leader(structure.subsystems.size());
  std::iota(leader.begin(), leader.end(), 0U);
  const auto find = [&](std::uint32_t at) {
    while (leader[at] != at) at = leader[at] = leader[leader[at]];
    return at;
  };
  for (const ChannelFlow& channel : structure.channels)
    if (channel.sender.valid() && channel.receiver.valid() && holds_up(channel)) {
      const std::uint32_t a = find(channel.sender.value), b = find(channel.receiver.value);
      leader[std::max(a, b)] = std::min(a, b);
    }
  std::vector<std::uint32_t> number(leader.size());
  std::uint32_t groups = 0;
  for (std::uint32_t index = 0; index < leader.size(); ++index)
    number[index] = find(index) == index ? groups++ : number[find(index)];
  return number;
}

/// The events of one channel in the rounds of its two subsystems.
struct ChannelEvents {
  std::optional<std::uint32_t> send, wait, receive;
  bool primed = false;
};

/// The event graph of all subsystems that fold, and its channels.
class Drawing {
 public:
  Drawing(const CommunicationStructure& structure, const std::vector<Folded>& folded)
      : structure_(structure), events(structure.channels.size()) {
    for (std::uint32_t subsystem = 0; subsystem < folded.size(); ++subsystem)
      if (folded[subsystem].why_not.empty()) draw_round({subsystem}, folded[subsystem]);
    for (std::uint32_t channel = 0; channel < events.size(); ++channel) draw_channel({channel});
    graph.close();
  }

 private:
  const CommunicationStructure& structure_;

 public:
  EventGraph graph;
  std::vector<ChannelEvents> events;  // per channel

 private:
  void draw_round(SubsystemFlowId subsystem, const Folded& folded) {
    const std::uint32_t start = graph.node(subsystem);
    std::uint32_t at = start;
    for (const Stage& stage : folded.cycle) at = draw_stage(subsystem, stage, at);
    graph.edge({.from = at, .to = start, .token = true});
    for (const ChannelFlowId channel : folded.primed) events[channel.value].primed = true;
  }

  /// Returns the event after which the stage is over.
  std::uint32_t draw_stage(SubsystemFlowId subsystem, const Stage& stage, std::uint32_t before) {
    std::vector<std::uint32_t> ends;
    for (const Communication& communication : stage) {
      const std::uint32_t event = graph.node(subsystem);
      graph.edge({.from = before, .to = event});
      ChannelEvents& channel = events[communication.flow.value];
      if (communication.side == Side::receive) {
        channel.receive = event;
      } else {
        channel.send = event;
        if (waits_to_send(structure_[communication.flow])) {
          channel.wait = graph.node(subsystem);
          graph.edge({.from = event, .to = *channel.wait});
        }
      }
      ends.push_back(communication.side == Side::send ? channel.wait.value_or(event) : event);
    }
    if (ends.size() == 1) return ends.front();
    const std::uint32_t join = graph.node(subsystem);
    for (const std::uint32_t end : ends) graph.edge({.from = end, .to = join});
    return join;
  }

  void draw_channel(ChannelFlowId id) {
    const ChannelFlow& channel = structure_[id];
    const ChannelEvents& at = events[id.value];
    if (at.send && at.receive && waits_to_receive(channel))
      graph.edge({*at.send, *at.receive, at.primed, channel.send_timeout, id});
    if (at.wait && at.receive) graph.edge({*at.receive, *at.wait, false, !waits_to_receive(channel), id});
  }
};

/// Judges the groups to which the criterion applies.
class Judgement {
 public:
  explicit Judgement(const CommunicationStructure& structure)
      : structure_(structure),
        group_of_(groups_of(structure)),
        folded_(fold_all()),
        drawing_(structure, folded_),
        uses_(structure) {}

  CircuitReport result() {
    const std::uint32_t groups =
        group_of_.empty() ? 0 : *std::max_element(group_of_.begin(), group_of_.end()) + 1;
    report_.groups.resize(groups);
    for (std::uint32_t subsystem = 0; subsystem < group_of_.size(); ++subsystem) {
      CircuitGroup& group = report_.groups[group_of_[subsystem]];
      group.subsystems.push_back({subsystem});
      if (group.why_not.empty()) group.why_not = folded_[subsystem].why_not;
    }
    find_free_of_tokens();
    find_losses();
    find_missing_peers();
    spread();
    decide();
    decide_channels();
    return std::move(report_);
  }

 private:
  std::vector<Folded> fold_all() {
    std::vector<Folded> all;
    std::vector<std::string> refused(structure_.subsystems.size());  // per group
    for (std::uint32_t subsystem = 0; subsystem < structure_.subsystems.size(); ++subsystem) {
      all.push_back(fold(structure_.subsystems[subsystem], structure_));
      if (!all.back().why_not.empty()) refused[group_of_[subsystem]] = all.back().why_not;
    }
    for (std::uint32_t subsystem = 0; subsystem < all.size(); ++subsystem)
      all[subsystem].why_not = refused[group_of_[subsystem]];
    return all;
  }

  [[nodiscard]] CircuitGroup& group_of(SubsystemFlowId subsystem) {
    return report_.groups[group_of_[subsystem.value]];
  }
  [[nodiscard]] const CircuitGroup& group_of(SubsystemFlowId subsystem) const {
    return report_.groups[group_of_[subsystem.value]];
  }
  [[nodiscard]] CircuitGroup& group_of_event(std::uint32_t event) {
    return group_of(drawing_.graph.subsystem(event));
  }

  void find_free_of_tokens() {
    const auto free = [](const Edge& edge) { return !edge.token; };
    const std::vector<std::uint32_t> component = drawing_.graph.components(free);
    for (const Edge& edge : drawing_.graph.edges())
      if (free(edge) && component[edge.from] == component[edge.to])
        blame(edge, CircuitGroup::Cause::no_token, free);
  }

  void find_losses() {
    const auto any = [](const Edge&) { return true; };
    const std::vector<std::uint32_t> component = drawing_.graph.components(any);
    for (const Edge& edge : drawing_.graph.edges())
      if (edge.lossy && component[edge.from] == component[edge.to])
        blame(edge, CircuitGroup::Cause::lost_token, any);
  }

  void find_missing_peers() {
    for (std::uint32_t index = 0; index < structure_.channels.size(); ++index) {
      const ChannelFlow& channel = structure_.channels[index];
      const ChannelEvents& events = drawing_.events[index];
      if (events.receive && waits_to_receive(channel))
        examine_peer({index}, Side::receive, *events.receive, channel.sender, !events.send);
      if (events.wait) examine_peer({index}, Side::send, *events.wait, channel.receiver, !events.receive);
    }
  }

  void examine_peer(ChannelFlowId channel, Side side, std::uint32_t event, SubsystemFlowId peer,
                    bool peer_absent) {
    const SubsystemFlowId subsystem = drawing_.graph.subsystem(event);
    const bool may_end = peer.valid() && peer != subsystem && folded_[peer.value].can_end;
    if (!peer_absent && !may_end) return;
    if (peer_absent) sources_.push_back(event);
    CircuitGroup& group = group_of(subsystem);
    if (group.cause != CircuitGroup::Cause::none) return;
    group.cause = peer_absent ? CircuitGroup::Cause::peer_absent : CircuitGroup::Cause::peer_ended;
    group.circuit = {{subsystem, channel, side, peer}};
  }

  /// The edge lies on a circuit of edges that pass the filter. The first circuit of a group is kept.
  void blame(const Edge& edge, CircuitGroup::Cause cause, const EventGraph::Filter& filter) {
    sources_.push_back(edge.to);
    CircuitGroup& group = group_of_event(edge.to);
    if (group.cause != CircuitGroup::Cause::none) return;
    group.cause = cause;
    std::vector<Edge> circuit = drawing_.graph.path(edge.to, edge.from, filter);
    circuit.push_back(edge);
    // An edge leads from the awaited subsystem to the waiting one; the text starts with the waiting one.
    std::ranges::reverse(circuit);
    for (const Edge& step : circuit)
      if (step.channel.valid())
        group.circuit.push_back(
            {drawing_.graph.subsystem(step.to), step.channel,
             drawing_.events[step.channel.value].receive == step.to ? Side::receive : Side::send,
             drawing_.graph.subsystem(step.from)});
  }

  /// A subsystem that waits for an event that may never come again may wait for ever, and so on.
  void spread() {
    stuck_.assign(structure_.subsystems.size(), false);
    const std::vector<bool> reached = drawing_.graph.reached(sources_);
    for (std::uint32_t event = 0; event < reached.size(); ++event)
      if (reached[event]) stuck_[drawing_.graph.subsystem(event).value] = true;
    spread_endings();
    for (std::uint32_t subsystem = 0; subsystem < stuck_.size(); ++subsystem)
      if (stuck_[subsystem]) group_of({subsystem}).stuck.push_back({subsystem});
  }

  /// A subsystem that depends on another one which may end can get stuck; its own end does not count. So it
  /// is enough to remember two that may end for each event.
  void spread_endings() {
    const EventGraph& graph = drawing_.graph;
    std::vector<std::array<SubsystemFlowId, 2>> endings(graph.size());
    std::vector<std::uint32_t> open;
    const auto note = [&](std::uint32_t event, SubsystemFlowId subsystem) {
      auto& [first, second] = endings[event];
      if (!subsystem.valid() || first == subsystem || second.valid()) return;
      (first.valid() ? second : first) = subsystem;
      open.push_back(event);
    };
    for (std::uint32_t event = 0; event < graph.size(); ++event)
      if (folded_[graph.subsystem(event).value].can_end) note(event, graph.subsystem(event));
    while (!open.empty()) {
      const std::uint32_t event = open.back();
      open.pop_back();
      for (const Edge& edge : graph.from(event))
        for (const SubsystemFlowId subsystem : endings[event]) note(edge.to, subsystem);
    }
    for (std::uint32_t event = 0; event < graph.size(); ++event)
      for (const SubsystemFlowId subsystem : endings[event])
        if (subsystem.valid() && subsystem != graph.subsystem(event))
          stuck_[graph.subsystem(event).value] = true;
  }

  void decide() {
    bool all_apply = true, some_stuck = false, some_run_for_ever = false;
    for (const CircuitGroup& group : report_.groups) {
      all_apply = all_apply && group.applies();
      if (!group.applies()) continue;
      some_stuck = some_stuck || !group.stuck.empty();
      for (const SubsystemFlowId subsystem : group.subsystems)
        some_run_for_ever =
            some_run_for_ever || (!stuck_[subsystem.value] && !folded_[subsystem.value].can_end);
    }
    const auto otherwise = [](bool known, Answer answer) { return known ? answer : Answer::unknown; };
    report_.goes_on = some_stuck ? Answer::no : otherwise(all_apply, Answer::yes);
    report_.deadlock_free =
        some_run_for_ever ? Answer::yes : otherwise(all_apply, some_stuck ? Answer::no : Answer::yes);
  }

  void decide_channels() {
    for (std::uint32_t index = 0; index < structure_.channels.size(); ++index) {
      const ChannelFlowId channel{index};
      const Answer answer = flows(channel);
      if (answer == Answer::no) report_.dry.push_back(channel);
      if (answer == Answer::unknown) report_.unclear.push_back(channel);
    }
    report_.channels_flow = Answer::yes;
    if (!report_.unclear.empty()) report_.channels_flow = Answer::unknown;
    if (!report_.dry.empty()) report_.channels_flow = Answer::no;
  }

  /// Does the subsystem for ever come back to its side of the channel?
  [[nodiscard]] Answer comes_back(SubsystemFlowId subsystem, ChannelFlowId channel, Side side) const {
    if (!group_of(subsystem).applies() || folded_[subsystem.value].can_end) return Answer::unknown;
    if (stuck_[subsystem.value]) return Answer::no;
    return uses_.always(channel, side) ? Answer::yes : Answer::no;
  }

  [[nodiscard]] Answer flows(ChannelFlowId id) const {
    const ChannelFlow& channel = structure_[id];
    if (!channel.receiver.valid()) return Answer::unknown;
    const Answer received = comes_back(channel.receiver, id, Side::receive);
    if (received != Answer::yes) return received;
    if (!channel.always_readable && !channel.sender.valid()) return Answer::no;
    if (channel.always_readable) return Answer::yes;
    const Answer sent = comes_back(channel.sender, id, Side::send);
    if (sent == Answer::unknown && folded_[channel.sender.value].can_end &&
        group_of(channel.sender).applies())
      return Answer::no;  // it may end while the receiver goes on
    if (sent != Answer::yes) return sent;
    // A value stays until it is read, unless its sender may take it back while its receiver passes by.
    if (!channel.send_timeout || waits_to_receive(channel)) return Answer::yes;
    return meet(channel.sender, channel.receiver) ? Answer::yes : Answer::unknown;
  }

  /// If one of them never depends on the other, it can wait at the channel until the other comes.
  [[nodiscard]] bool meet(SubsystemFlowId a, SubsystemFlowId b) const {
    if (group_of_[a.value] != group_of_[b.value]) return true;
    return !depends(a, b) || !depends(b, a);
  }

  [[nodiscard]] bool depends(SubsystemFlowId subsystem, SubsystemFlowId on) const {
    std::vector<std::uint32_t> events;
    for (std::uint32_t event = 0; event < drawing_.graph.size(); ++event)
      if (drawing_.graph.subsystem(event) == on) events.push_back(event);
    const std::vector<bool> reached = drawing_.graph.reached(events);
    for (std::uint32_t event = 0; event < reached.size(); ++event)
      if (reached[event] && drawing_.graph.subsystem(event) == subsystem) return true;
    return false;
  }

  const CommunicationStructure& structure_;
  std::vector<std::uint32_t> group_of_;  // per subsystem
  std::vector<Folded> folded_;           // per subsystem; refused if any of its group is
  Drawing drawing_;
  RecurringUses uses_;
  std::vector<std::uint32_t> sources_;  // events that may never happen again
  std::vector<bool> stuck_;             // per subsystem
  CircuitReport report_;
};

}  // namespace

CircuitReport judge_circuits(const CommunicationStructure& structure) {
  return Judgement(structure).result();
}

std::string with_absence(std::string text, const ChannelFlow& channel) {
  return channel.absence.empty() ? text : text + ", and " + channel.absence;
}

std::string in_words(const CommunicationStructure& structure, const CircuitGroup& group) {
  std::string text;
  for (const SubsystemAtEnd& wait : at_end(structure, group)) text += (text.empty() ? "" : "; ") + wait.text;
  return text;
}

std::vector<SubsystemAtEnd> at_end(const CommunicationStructure& structure, const CircuitGroup& group) {
  std::vector<SubsystemAtEnd> all;
  for (const Wait& wait : group.circuit) {
    using Awaited = SubsystemAtEnd::Awaited;
    SubsystemAtEnd& one = all.emplace_back();
    one.awaited = wait.side == Side::send ? Awaited::acknowledgement : Awaited::value;
    one.path = structure[wait.subsystem].name;
    one.channel = structure[wait.channel].name;
    const ChannelFlow& channel = structure[wait.channel];
    if (wait.waiting_for.valid())
      one.from = {structure[wait.waiting_for].name};
    else if (!channel.absent.empty())
      one.from = {channel.absent};
    one.text = one.path +
               (wait.side == Side::send ? " waits for the acknowledgement of " : " waits for a value of ") +
               one.channel + " from " + (one.from.empty() ? "nobody" : one.from.front());
    one.text = with_absence(std::move(one.text), channel);
  }
  return all;
}

}  // namespace tessera::verify
