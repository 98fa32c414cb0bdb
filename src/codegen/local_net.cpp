#include "codegen/local_net.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <unordered_map>

#include "codegen/cpp_text.hpp"
#include "codegen/project.hpp"
#include "tessera/transition_role.hpp"

namespace tessera::codegen {
namespace {

using net::PlaceId;
using net::TransitionId;

/// The elements of the flat net that each instance executes.
struct Parts {
  explicit Parts(const net::Net& net, std::size_t instances) : places(instances), transitions(instances) {
    for (std::uint32_t id = 0; id < net.places().size(); ++id)
      if (const net::SubsystemId owner = net.places()[id].subsystem; owner.valid())
        places[owner].push_back({id});
    for (std::uint32_t id = 0; id < net.transitions().size(); ++id)
      if (const net::SubsystemId owner = net.transitions()[id].subsystem; owner.valid())
        transitions[owner].push_back({id});
  }
  Numbered<net::SubsystemId, std::vector<PlaceId>> places;
  Numbered<net::SubsystemId, std::vector<TransitionId>> transitions;
};

/// The local name of a transition that a subsystem executes.
Step step_of(const net::Transition& transition) {
  using Role = net::TransitionRole;
  switch (transition.condition.kind) {
    case net::Condition::Kind::go_on:
      return Step::go_on;
    case net::Condition::Kind::terminal:
      return Step::terminal;
    case net::Condition::Kind::error:
      return Step::error;
    case net::Condition::Kind::elapsed:
      return Step::timeout;
    case net::Condition::Kind::none:
    case net::Condition::Kind::next:
      break;
  }
  switch (transition.role) {
    case Role::start:
      return Step::start;
    case Role::leave:
      return Step::leave;
    case Role::begin_sending:
      return Step::begin_sending;
    case Role::end_sending:
      return Step::end_sending;
    case Role::begin_receiving:
      return Step::begin_receiving;
    case Role::end_receiving:
      return Step::end_receiving;
    case Role::overwrite:
      return Step::overwrite;
    case Role::skip:
      return Step::skip;
    default:
      return transition.block.valid() ? Step::transfer : Step::page;
  }
}

/// Extracts the net of one instance.
class Extraction {
 public:
  Extraction(const net::Net& net, const spec::Model& model, const Parts& parts, spec::InstanceId instance)
      : net_(net),
        model_(model),
        places_(parts.places[instance]),
        transitions_(parts.transitions[instance]),
        prefix_(model.instance_path(instance).size() + 1),
        subsystem_(model.subsystem(instance)) {}

  LocalNet result() {
    find_ports();
    for (const PlaceId id : places_) {
      const std::string name(local(net_[id].name));
      if (net_[id].is(net::Layer::subsystem, net::PlaceRole::input)) local_.in = name;
      if (net_[id].is(net::Layer::subsystem, net::PlaceRole::output)) local_.out = name;
      local_.places.push_back({name, net_[id].behaviour, operation(id)});
    }
    for (const TransitionId id : transitions_) add_transition(id);
    return std::move(local_);
  }

 private:
  [[nodiscard]] std::string_view local(std::string_view name) const { return name.substr(prefix_); }

  /// A block touches the fused places of its channel. An input and an output of one name get told apart.
  void find_ports() {
    for (const TransitionId id : transitions_) {
      if (!net_[id].block.valid()) continue;
      const net::Parts::Block& block = net_.parts()[net_[id].block];
      const spec::Channel& channel = model_.channels[block.channel];
      const std::string& buffer = block.sends ? subsystem_.outputs[channel.from.buffer].name
                                              : subsystem_.inputs[channel.to.buffer].name;
      const LocalNet::Port port{block.name, buffer, block.sends, block.channel};
      if (std::ranges::find(local_.ports, port) == local_.ports.end()) local_.ports.push_back(port);
    }
    for (LocalNet::Port& port : local_.ports)
      if (is_input(port.buffer) && is_output(port.buffer)) port.name.insert(0, port.sends ? "snd." : "rcv.");
  }

  [[nodiscard]] bool is_input(const std::string& name) const {
    return std::ranges::find(subsystem_.inputs, name, &spec::Field::name) != subsystem_.inputs.end();
  }
  [[nodiscard]] bool is_output(const std::string& name) const {
    return std::ranges::find(subsystem_.outputs, name, &spec::Field::name) != subsystem_.outputs.end();
  }

  [[nodiscard]] const std::string& port(net::ChannelId channel, bool sends) const {
    return std::ranges::find_if(local_.ports,
                                [&](const LocalNet::Port& candidate) {
                                  return candidate.channel == channel && candidate.sends == sends;
                                })
        ->name;
  }

  [[nodiscard]] std::string operation(PlaceId id) const {
    const net::Place& place = net_[id];
    switch (place.operation.kind) {
      case net::Operation::Kind::none:
        return {};
      case net::Operation::Kind::transition_function:
        return fmt::format("tessera::calls({})",
                           string_literal(subsystem_.behaviours[place.operation.behaviour].name));
      case net::Operation::Kind::next_iteration:
        if (!subsystem_.receive_first) return "tessera::counts()";
        return fmt::format("tessera::begins({})",
                           string_literal(subsystem_.behaviours[place.behaviour].name));
      case net::Operation::Kind::write:
        return transfer("writes", place.operation, true);
      case net::Operation::Kind::read:
        return transfer("reads", place.operation, false);
    }
    return {};
  }

  [[nodiscard]] std::string transfer(std::string_view what, const net::Operation& operation,
                                     bool sends) const {
    // Each side of a channel between processes has a memory of its own, which is all that it sees.
    const bool crosses = model_.crosses_processes(model_.channels[operation.channel]);
    const std::string slot = crosses || operation.slot == 0 ? "" : fmt::format(", {}", operation.slot + 1);
    return fmt::format("tessera::{}({}{})", what, string_literal(port(operation.channel, sends)), slot);
  }

  void add_transition(TransitionId id) {
    const net::Transition& transition = net_[id];
    LocalNet::Transition row{std::string(local(transition.name)), transition.behaviour};
    const bool sends = transition.block.valid() && net_.parts()[transition.block].sends;
    row.guard = guard(id, sends);
    row.role = role(id, sends);
    for (const net::Arc& arc : net_.preset(id)) row.inputs.push_back(arc_end(arc.place, sends));
    for (const net::Arc& arc : net_.postset(id)) row.outputs.push_back(arc_end(arc.place, sends));
    latch(id, transition.condition);
    local_.transitions.push_back(std::move(row));
  }

  [[nodiscard]] std::string arc_end(PlaceId id, bool sends) const {
    const net::Place& place = net_[id];
    if (!place.fused()) return std::string(local(place.name));
    const std::size_t state = net_.parts()[place.channel].size() + 1;
    return fmt::format("{}/{}", port(place.channel, sends), std::string_view(place.name).substr(state));
  }

  [[nodiscard]] std::string guard(TransitionId id, bool sends) const {
    const net::Condition& condition = net_[id].condition;
    switch (condition.kind) {
      case net::Condition::Kind::none:
        return {};
      case net::Condition::Kind::go_on:
        return "tessera::if_go_on";
      case net::Condition::Kind::terminal:
        return "tessera::if_terminal";
      case net::Condition::Kind::error:
        return "tessera::if_error";
      case net::Condition::Kind::next:
        return fmt::format("tessera::if_next({})", condition.entry.value());
      case net::Condition::Kind::elapsed:
        if (net_.channel_of(id).valid()) return "tessera::if_elapsed";
        return fmt::format("tessera::if_elapsed_at({})", string_literal(port(condition.channel, sends)));
    }
    return {};
  }

  [[nodiscard]] std::string role(TransitionId id, bool sends) const {
    const net::Transition& transition = net_[id];
    const Step step = step_of(transition);
    const net::BehaviourId behaviour =
        step == Step::leave ? net_[net_.preset(id).front().place].behaviour : transition.behaviour;
    std::string text = fmt::format("tessera::Step::{}", name_of(step));
    if (behaviour.valid()) text += ", " + string_literal(subsystem_.behaviours[behaviour].name);
    if (transition.block.valid())
      text += ", " + string_literal(port(net_.parts()[transition.block].channel, sends));
    return '{' + text + '}';
  }

  /// The place before a conditional transition latches which way its token may go.
  void latch(TransitionId id, const net::Condition& condition) {
    using Kind = net::Condition::Kind;
    const bool decides =
        condition.kind == Kind::go_on || condition.kind == Kind::terminal || condition.kind == Kind::error;
    if (!decides && condition.kind != Kind::next) return;
    for (const net::Arc& arc : net_.preset(id)) {
      if (net_[arc.place].fused()) continue;
      // Places of one instance keep the order of the flat net, so their ids are sorted.
      const auto found = std::ranges::lower_bound(places_, arc.place);
      LocalNet::Place& place = local_.places[static_cast<std::size_t>(found - places_.begin())];
      place.does = fmt::format("tessera::{}({})", decides ? "decides" : "routes",
                               string_literal(subsystem_.behaviours[place.behaviour].name));
    }
  }

  const net::Net& net_;
  const spec::Model& model_;
  const std::vector<PlaceId>& places_;
  const std::vector<TransitionId>& transitions_;
  std::size_t prefix_;
  const spec::Subsystem& subsystem_;
  LocalNet local_;
};

/// The same text for equal nets, whatever the numbers of their channels.
std::string identity(const LocalNet& net) {
  std::string text;
  for (const LocalNet::Port& port : net.ports) ((text += port.name) += port.sends ? '>' : '<') += '\n';
  for (const LocalNet::Place& place : net.places) (((text += place.name) += ' ') += place.does) += '\n';
  for (const LocalNet::Transition& transition : net.transitions) {
    (((text += transition.name) += ' ') += transition.guard) += transition.role;
    for (const std::string& place : transition.inputs) (text += ' ') += place;
    text += " ->";
    for (const std::string& place : transition.outputs) (text += ' ') += place;
    text += '\n';
  }
  return text;
}

}  // namespace

LocalNets take_apart(const verify::VerifiedNet& net, const spec::Model& model,
                     const std::vector<Unit>& units) {
  LocalNets all;
  all.of_channel.resize(model.channels.size());
  const Parts parts(net.net(), model.instances.size());
  for (const Unit& unit : units) {
    NetVariants& variants = all.of_unit.emplace_back();
    std::unordered_map<std::string, std::uint32_t> known;
    for (const spec::InstanceId instance : unit.instances) {
      LocalNet local = Extraction(net.net(), model, parts, instance).result();
      for (const LocalNet::Port& port : local.ports) {
        ChannelPorts& ends = all.of_channel[port.channel];
        (port.sends ? ends.from : ends.to) = port.name;
      }
      const auto [variant, is_new] =
          known.emplace(identity(local), static_cast<std::uint32_t>(variants.nets.size()));
      if (is_new) variants.nets.push_back(std::move(local));
      variants.of_instance.push_back(variant->second);
    }
  }
  return all;
}

}  // namespace tessera::codegen
