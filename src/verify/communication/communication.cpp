#include "verify/communication/communication.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "net/token_game.hpp"
#include "verify/communication/absences.hpp"
#include "verify/communication/blocks.hpp"

namespace tessera::verify {
namespace {

using net::Condition;
using net::Operation;
using net::PlaceId;

/// Follows the token of one subsystem through its pages.
class SubsystemReader {
 public:
  SubsystemReader(const Steps& steps, Assume assume) : steps_(steps), net_(steps.net()), assume_(assume) {}

  /// entry: the place at which the upper layers start the subsystem.
  std::optional<SubsystemFlow> read(PlaceId entry) {
    flow_.id = net_[entry].subsystem;
    flow_.name = net_.parts()[flow_.id].path;
    std::optional<PlaceId> start = silent_step(entry);
    if (start) start = past_groups(*start);
    if (!start || !behaviour_at(*start)) return fail("does not start with a behaviour", entry);
    for (std::size_t index = 0; index < entries_.size(); ++index) {
      flow_.behaviours.emplace_back();
      flow_.behaviours[index].name = net_.parts().behaviour_path(flow_.id, net_[entries_[index]].behaviour);
      if (!read_behaviour(static_cast<std::uint32_t>(index))) return std::nullopt;
    }
    return std::move(flow_);
  }

  [[nodiscard]] const std::string& why_not() const { return why_not_; }

 private:
  std::nullopt_t fail(const std::string& what, PlaceId at) {
    if (why_not_.empty()) why_not_ = "'" + net_[at].name + "' " + what;
    return std::nullopt;
  }

  /// The index of the behaviour that starts at the place.
  std::optional<std::uint32_t> behaviour_at(PlaceId place) {
    if (!net_[place].is(net::Layer::behaviour, PlaceRole::input)) return std::nullopt;
    const auto [entry, added] = numbers_.emplace(place, static_cast<std::uint32_t>(entries_.size()));
    if (added) entries_.push_back(place);
    return entry->second;
  }

  /// The place after `from`, if the only transition from there has no condition and touches no channel.
  [[nodiscard]] std::optional<PlaceId> silent_step(PlaceId from) const {
    const auto steps = steps_.from(from);
    if (steps.size() != 1 || !steps.front().from.valid() || !steps.front().to.valid()) return std::nullopt;
    if (steps.front().channel.valid()) return std::nullopt;
    if (net_[steps.front().id].condition.kind != Condition::Kind::none) return std::nullopt;
    return steps.front().to;
  }

  /// The place to which a token goes on through the places of groups, as long as there is no choice.
  [[nodiscard]] PlaceId past_groups(PlaceId place) const {
    for (std::size_t steps = 0; net_[place].is_of_group() && steps <= net_.places().size(); ++steps) {
      const std::optional<PlaceId> next = silent_step(place);
      if (!next) break;
      place = *next;
    }
    return place;
  }

  bool read_behaviour(std::uint32_t number) {
    std::vector<Stage> stages;
    PlaceId at = entries_[number];
    // A page has no way back before its end, so this stops unless the net is of another shape.
    for (std::size_t steps = 0; steps <= net_.places().size(); ++steps) {
      if (is_end(at)) {
        flow_.behaviours[number].stages = std::move(stages);
        return read_end(number, at);
      }
      const std::optional<PlaceId> next = advance(at, stages);
      if (!next)
        return fail(may_be_skipped(steps_, at) ? "begins a send that an iteration may skip"
                                               : "starts nothing that we know",
                    at),
               false;
      at = *next;
    }
    return fail("is passed for ever", at), false;
  }

  std::optional<PlaceId> advance(PlaceId at, std::vector<Stage>& stages) const {
    // A sender over a network begins to write without a look at the channel, so blocks come first.
    if (const auto block = block_at(steps_, at)) {
      stages.push_back({block->communication});
      return block->out;
    }
    if (const auto next = silent_step(at)) return next;
    return parallel_transfer(at, stages);
  }

  std::optional<PlaceId> parallel_transfer(PlaceId at, std::vector<Stage>& stages) const {
    const auto fork = steps_.from(at);
    if (fork.size() != 1 || !fork.front().from.valid() || fork.front().channel.valid()) return std::nullopt;
    if (net_[fork.front().id].condition.kind != Condition::Kind::none) return std::nullopt;
    Stage stage;
    std::optional<TokenStep> join;
    for (const net::Arc& branch : net_.postset(fork.front().id)) {
      const std::optional<Block> block = block_at(steps_, branch.place);
      if (!block) return std::nullopt;
      const auto end = steps_.from(block->out);
      if (end.size() != 1 || (join && join->id != end.front().id)) return std::nullopt;
      join = end.front();
      stage.push_back(block->communication);
    }
    if (!join || !join->to.valid() || join->channel.valid() ||
        net_[join->id].condition.kind != Condition::Kind::none ||
        net_.preset(join->id).size() != stage.size())
      return std::nullopt;
    stages.push_back(std::move(stage));
    return join->to;
  }

  [[nodiscard]] bool is_end(PlaceId at) const {
    return std::ranges::any_of(steps_.from(at), [&](const TokenStep& step) {
      const Condition::Kind kind = net_[step.id].condition.kind;
      return kind == Condition::Kind::go_on || kind == Condition::Kind::terminal ||
             kind == Condition::Kind::error;
    });
  }

  [[nodiscard]] Condition::Known known(const Condition& condition) const {
    return condition.known(assume_ == Assume::exceptions);
  }
  [[nodiscard]] bool possible(const Condition& condition) const {
    return known(condition).truth != Condition::Truth::never;
  }

  /// t4, t5 and t6.
  bool read_end(std::uint32_t number, PlaceId at) {
    std::optional<PlaceId> left;
    for (const TokenStep& step : steps_.from(at)) {
      const Condition& condition = net_[step.id].condition;
      if (!step.from.valid() || !step.to.valid() || step.channel.valid())
        return fail("ends in an unknown way", at), false;
      BehaviourFlow& behaviour = flow_.behaviours[number];
      if (condition.kind == Condition::Kind::go_on) {
        if (step.to != entries_[number]) return fail("goes on elsewhere", at), false;
        behaviour.repeats = possible(condition);
        continue;
      }
      if (condition.kind != Condition::Kind::terminal && condition.kind != Condition::Kind::error)
        return fail("ends in an unknown way", at), false;
      if (left && *left != step.to) return fail("ends in two places", at), false;
      left = step.to;
      behaviour.leaves = behaviour.leaves || possible(condition);
    }
    if (!left || !flow_.behaviours[number].leaves) return true;
    return read_next(number, *left);
  }

  /// The initial conditions of the behaviours that may follow. If a group is left, those of the group are asked
  /// next.
  bool read_next(std::uint32_t number, PlaceId out) {
    flow_.behaviours[number].complete = true;
    std::vector<PlaceId> outs{out};
    for (std::size_t at = 0; at < outs.size(); ++at) {
      bool complete = false;
      for (const TokenStep& step : steps_.from(outs[at])) {
        const Condition& condition = net_[step.id].condition;
        if (!step.from.valid() || !step.to.valid() || step.channel.valid() ||
            (condition.kind != Condition::Kind::none && condition.kind != Condition::Kind::next))
          return fail("is left in an unknown way", outs[at]), false;
        complete =
            complete || known(condition).truth == Condition::Truth::always || known(condition).exhaustive;
        if (possible(condition) && !follow(number, past_groups(step.to), outs)) return false;
      }
      flow_.behaviours[number].complete = flow_.behaviours[number].complete && complete;
    }
    return true;
  }

  /// outs: gets the place if a group is left there.
  bool follow(std::uint32_t number, PlaceId to, std::vector<PlaceId>& outs) {
    if (net_[to].is_of_group()) {
      if (std::ranges::find(outs, to) == outs.end()) outs.push_back(to);
    } else if (const auto next = behaviour_at(to)) {
      flow_.behaviours[number].next.push_back(*next);
    } else if (steps_.from(to).empty()) {
      flow_.behaviours[number].ends = true;
    } else {
      return fail("follows a behaviour and is none", to), false;
    }
    return true;
  }

  const Steps& steps_;
  const net::Net& net_;
  Assume assume_;
  SubsystemFlow flow_;
  std::vector<PlaceId> entries_;  // per behaviour
  std::map<PlaceId, std::uint32_t> numbers_;
  std::string why_not_;
};

/// Plays the upper layers from the initial marking: where do they put the tokens that start the subsystems?
class Start {
 public:
  explicit Start(const net::Net& net) : net_(net), tokens_(net.places().size(), 0) {
    for (std::uint32_t place = 0; place < tokens_.size(); ++place)
      if (!net.places()[place].fused()) tokens_[place] = net.places()[place].tokens;
    for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
      if (!net.transitions()[index].subsystem.valid() && !is_of_medium(net.transitions()[index].role))
        upper_.push_back({index});
    // Parents come before children, so one pass in order starts everything.
    for (const net::TransitionId id : upper_)
      if (net::enabled(net_, id, tokens_)) net::fire(net_, id, tokens_);
  }

  /// The entry places, one per subsystem, or why there are none.
  std::vector<PlaceId> entries(std::string& why_not) {
    for (const net::TransitionId id : upper_)
      if (net::enabled(net_, id, tokens_)) why_not = "'" + net_[id].name + "' can fire again";
    std::vector<PlaceId> marked;
    for (std::uint32_t place = 0; place < tokens_.size(); ++place) {
      if (tokens_[place] == 0) continue;
      const PlaceId id{place};
      if (tokens_[place] > 1 || !net_[id].subsystem.valid())
        why_not = "'" + net_[id].name + "' holds a token once all has started";
      if (!marked.empty() && net_[marked.back()].subsystem == net_[id].subsystem)
        why_not = "'" + net_[id].name + "' is a second start of its subsystem";
      marked.push_back(id);
    }
    return marked;
  }

 private:
  const net::Net& net_;
  std::vector<std::uint32_t> tokens_;
  std::vector<net::TransitionId> upper_;
};

/// Numbers the used channels and collects the holders of both ends, with their modes.
class Channels {
 public:
  explicit Channels(const Steps& steps)
      : steps_(steps),
        parts_(steps.net().parts()),
        flows_(steps.channel_count()),
        exchanges_(steps.channel_count(), false) {
    for (const net::Place& place : steps.net().places())
      if (place.role == PlaceRole::lock || place.role == PlaceRole::sent_memory ||
          place.role == PlaceRole::received_memory)
        exchanges_[place.channel.value] = true;
  }

  /// Sets the flow of the communication; false if another subsystem or another mode holds the same end.
  bool enlist(SubsystemFlowId subsystem, Communication& communication) {
    const net::ChannelId id = communication.channel;
    ChannelFlowId& flow = flows_[id.value];
    if (!flow.valid()) {
      flow = {static_cast<std::uint32_t>(all.size())};
      all.push_back({.id = id,
                     .name = parts_[id],
                     .sender = {},
                     .receiver = {},
                     .networked = steps_.networked(id),
                     .always_readable = exchanges_[id.value]});
    }
    communication.flow = flow;
    ChannelFlow& channel = all[flow.value];
    channel.own_model = channel.own_model || communication.own_model;
    const bool sends = communication.side == Side::send;
    SubsystemFlowId& end = sends ? channel.sender : channel.receiver;
    bool& blocks = sends ? channel.send_blocks : channel.receive_blocks;
    bool& timeout = sends ? channel.send_timeout : channel.receive_timeout;
    if (!end.valid()) {
      end = subsystem;
      blocks = communication.blocking;
      timeout = communication.timeout;
    }
    return end == subsystem && blocks == communication.blocking && timeout == communication.timeout;
  }

  std::vector<ChannelFlow> all;

 private:
  const Steps& steps_;
  const net::Parts& parts_;
  std::vector<ChannelFlowId> flows_;  // per channel of the net
  std::vector<bool> exchanges_;       // the same
};

/// Does the transition touch nothing but the memory of one channel between processes?
bool joins_one_channel(const net::Net& net, net::TransitionId id) {
  for (const auto& arcs : {net.preset(id), net.postset(id)})
    for (const net::Arc& arc : arcs)
      if (!net[arc.place].fused() || net[arc.place].channel != net.channel_of(id) || arc.weight != 1)
        return false;
  return net.channel_of(id).valid();
}

/// Transitions that would move tokens behind the back of the readers.
std::string stray_transition(const net::Net& net, const Steps& steps) {
  for (const net::Place& place : net.places())
    if (place.subsystem.valid() && place.subsystem.value >= net.parts().subsystems.size())
      return "'" + place.name + "' is of a subsystem that the net does not name";
  if (steps.stray()) return "'" + net[*steps.stray()].name + "' joins more than a subsystem and a channel";
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
    const net::TransitionId id{index};
    if (net[id].subsystem.valid()) continue;
    if (is_of_medium(net[id].role)) {
      if (!joins_one_channel(net, id)) return "'" + net[id].name + "' joins more than one channel";
      continue;
    }
    if (net.preset(id).empty()) return "'" + net[id].name + "' needs no token";
    for (const auto& arcs : {net.preset(id), net.postset(id)})
      for (const net::Arc& arc : arcs)
        if (net[arc.place].fused()) return "'" + net[id].name + "' of the upper layers uses a channel";
    for (const net::Arc& arc : net.preset(id))
      if (net[arc.place].subsystem.valid() && !steps.from(arc.place).empty())
        return "'" + net[id].name + "' takes a token out of a subsystem";
  }
  return {};
}

}  // namespace

CommunicationResult communication_structure(const net::Net& net, Assume assume) {
  const Steps steps(net);
  CommunicationResult result;
  result.why_not = stray_transition(net, steps);
  if (!result.why_not.empty()) return result;
  const std::vector<PlaceId> entries = Start(net).entries(result.why_not);
  if (!result.why_not.empty()) return result;

  CommunicationStructure structure;
  Channels channels(steps);
  for (const PlaceId entry : entries) {
    SubsystemReader reader(steps, assume);
    std::optional<SubsystemFlow> flow = reader.read(entry);
    if (!flow) return {std::nullopt, reader.why_not()};
    const SubsystemFlowId id{static_cast<std::uint32_t>(structure.subsystems.size())};
    for (BehaviourFlow& behaviour : flow->behaviours)
      for (Stage& stage : behaviour.stages)
        for (Communication& communication : stage)
          if (!channels.enlist(id, communication))
            return {std::nullopt, "two subsystems or two modes at one end of a channel of " + flow->name};
    structure.subsystems.push_back(std::move(*flow));
  }
  structure.channels = std::move(channels.all);
  name_absences(structure, net);
  result.structure = std::move(structure);
  return result;
}

}  // namespace tessera::verify
