#include "codegen/local_net.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "codegen/cpp_text.hpp"
#include "codegen/project.hpp"
#include "tessera/net_roles.hpp"

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
    number_in_memory.resize(net.places().size());
    std::vector<std::uint32_t> count(net.parts().channels.size());
    for (std::uint32_t id = 0; id < net.places().size(); ++id)
      if (net.places()[id].fused()) number_in_memory[id] = count[net.places()[id].channel.value]++;
    for (std::uint32_t id = 0; id < net.transitions().size(); ++id)
      if (const net::SubsystemId owner = net.transitions()[id].subsystem; owner.valid())
        transitions[owner].push_back({id});
  }
  Numbered<net::SubsystemId, std::vector<PlaceId>> places;
  Numbered<net::SubsystemId, std::vector<TransitionId>> transitions;
  std::vector<std::uint32_t> number_in_memory;  ///< per place: of a fused one in the memory of its channel
};

/// Extracts the net of one instance.
class Extraction {
 public:
  Extraction(const net::Net& net, const spec::Model& model, const Parts& parts, spec::InstanceId instance)
      : net_(net),
        model_(model),
        parts_(parts),
        places_(parts.places[instance]),
        transitions_(parts.transitions[instance]),
        prefix_(model.instance_path(instance).size() + 1),
        subsystem_(model.subsystem(instance)) {}

  LocalNet result() {
    find_ports();
    for (const PlaceId id : places_)
      rows_.push_back({id,
                       {std::string(local(net_[id].name)), net_[id].behaviour,
                        net_[id].fact.valid() ? knows(net_[id]) : operation(id), net_[id].tokens}});
    for (const TransitionId id : transitions_) latch(id, net_[id].condition);
    number_places();
    for (const TransitionId id : transitions_) add_transition(id);
    return std::move(local_);
  }

 private:
  struct PlaceRow {
    PlaceId id;
    LocalNet::Place place;
  };

  [[nodiscard]] std::string_view local(std::string_view name) const { return name.substr(prefix_); }

  void number_places() {
    std::vector<PlaceRow> ordered = rows_;
    std::ranges::stable_sort(ordered, {}, [](const PlaceRow& row) {
      const net::BehaviourId behaviour = row.place.behaviour;
      return std::pair(behaviour.valid() ? behaviour.value + 1 : 0, row.place.does.empty());
    });
    numbers_.resize(rows_.size());
    for (std::size_t number = 0; number < ordered.size(); ++number) {
      const PlaceId id = ordered[number].id;
      numbers_[index_of(id)] = number;
      if (net_[id].is(net::Layer::subsystem, PlaceRole::input)) local_.in = number;
      if (net_[id].is(net::Layer::subsystem, PlaceRole::output)) local_.out = number;
      local_.places.push_back(std::move(ordered[number].place));
    }
  }

  /// Places of one instance keep the order of the flat net, so their ids are sorted.
  [[nodiscard]] std::size_t index_of(PlaceId id) const {
    return static_cast<std::size_t>(std::ranges::lower_bound(places_, id) - places_.begin());
  }

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

  [[nodiscard]] std::string knows(const net::Place& place) {
    const auto found = std::ranges::find(local_.facts, place.fact, &LocalNet::Fact::id);
    const auto number = static_cast<std::size_t>(found - local_.facts.begin());
    if (found == local_.facts.end()) {
      const net::Parts::Fact& fact = net_.parts()[place.fact];
      local_.facts.push_back({place.fact, std::string(kind_of(fact.kind)), fact.name});
    }
    return fmt::format("tessera::knows({}, {})", number, place.value);
  }

  static std::string_view kind_of(net::Parts::Fact::Kind kind) {
    switch (kind) {
      case net::Parts::Fact::Kind::received:
        return "tessera::Fact::Kind::received";
      case net::Parts::Fact::Kind::sent:
        return "tessera::Fact::Kind::sent";
      case net::Parts::Fact::Kind::memory:
        return "tessera::Fact::Kind::memory";
    }
    return {};
  }

  [[nodiscard]] bool is_input(const std::string& name) const {
    return std::ranges::find(subsystem_.inputs, name, &spec::Field::name) != subsystem_.inputs.end();
  }
  [[nodiscard]] bool is_output(const std::string& name) const {
    return std::ranges::find(subsystem_.outputs, name, &spec::Field::name) != subsystem_.outputs.end();
  }

  [[nodiscard]] std::size_t port(net::ChannelId channel, bool sends) const {
    const auto found = std::ranges::find_if(local_.ports, [&](const LocalNet::Port& candidate) {
      return candidate.channel == channel && candidate.sends == sends;
    });
    return static_cast<std::size_t>(found - local_.ports.begin());
  }

  [[nodiscard]] std::string operation(PlaceId id) const {
    const net::Place& place = net_[id];
    switch (place.operation.kind) {
      case net::Operation::Kind::none:
        return {};
      case net::Operation::Kind::transition_function:
        return fmt::format("tessera::calls({})", place.operation.behaviour.value);
      case net::Operation::Kind::next_iteration:
        if (!subsystem_.receive_first) return "tessera::counts()";
        return fmt::format("tessera::begins({})", place.behaviour.value);
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
    return fmt::format("tessera::{}({}{})", what, port(operation.channel, sends), slot);
  }

  void add_transition(TransitionId id) {
    const net::Transition& transition = net_[id];
    LocalNet::Transition row{std::string(local(transition.name)), transition.behaviour};
    const bool sends = transition.block.valid() && net_.parts()[transition.block].sends;
    row.guard = guard(id, sends);
    row.role = role(id, sends);
    row.inputs = ends(net_.preset(id), sends, row.in_words);
    row.in_words += " -> ";
    row.outputs = ends(net_.postset(id), sends, row.in_words);
    local_.transitions.push_back(std::move(row));
  }

  /// The ends of arcs, which are also added to `in_words` by their names.
  [[nodiscard]] std::vector<std::string> ends(std::span<const net::Arc> arcs, bool sends,
                                              std::string& in_words) const {
    std::vector<std::string> all;
    for (const net::Arc& arc : arcs) {
      const net::Place& place = net_[arc.place];
      if (!all.empty()) in_words += ", ";
      if (!place.fused()) {
        all.push_back(std::to_string(numbers_[index_of(arc.place)]));
        in_words += local(place.name);
        continue;
      }
      const std::size_t at = port(place.channel, sends);
      all.push_back(fmt::format("tessera::memory({}, {})", at, parts_.number_in_memory[arc.place.value]));
      in_words += local_.ports[at].name + '/';
      in_words += std::string_view(place.name).substr(net_.parts()[place.channel].size() + 1);
    }
    return all;
  }

  [[nodiscard]] std::string guard(TransitionId id, bool sends) const {
    const net::Condition& condition = net_[id].condition;
    switch (condition.kind) {
      case net::Condition::Kind::none:
        return told(id, sends);
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
        return fmt::format("tessera::if_elapsed_at({})", port(condition.channel, sends));
      case net::Condition::Kind::send:
        return "tessera::if_sends";
      case net::Condition::Kind::skip:
        return "tessera::if_skips";
    }
    return {};
  }

  /// A receive that tells of a goal: the value that came decides which state the memory of the goal has after it.
  [[nodiscard]] std::string told(TransitionId id, bool sends) const {
    if (sends || !net_[id].block.valid()) return {};
    const spec::BufferId input = model_.channels[net_.parts()[net_[id].block].channel].to.buffer;
    for (const net::Arc& arc : net_.postset(id)) {
      const net::Place& place = net_[arc.place];
      if (!place.fact.valid()) continue;
      const net::Parts::Fact& fact = net_.parts()[place.fact];
      if (fact.kind != net::Parts::Fact::Kind::memory) continue;
      const std::optional<spec::GoalBuffers>& goal = subsystem_.memory[fact.subject].few->goal;
      if (goal && goal->progress == input) return fmt::format("tessera::if_told({})", place.value);
    }
    return {};
  }

  [[nodiscard]] std::string role(TransitionId id, bool sends) const {
    const net::Transition& transition = net_[id];
    const bool leaves = transition.role == Step::leave || transition.role == Step::leave_group;
    const net::BehaviourId behaviour =
        leaves ? net_[net_.preset(id).front().place].behaviour : transition.behaviour;
    std::string text = fmt::format("tessera::Step::{}", name_of(transition.role));
    if (behaviour.valid()) text += fmt::format(", {}", behaviour.value);
    if (transition.block.valid())
      text += fmt::format(", {}", port(net_.parts()[transition.block].channel, sends));
    return '{' + text + '}';
  }

  /// The place before a conditional transition latches which way its token may go.
  void latch(TransitionId id, const net::Condition& condition) {
    using Kind = net::Condition::Kind;
    const bool decides =
        condition.kind == Kind::go_on || condition.kind == Kind::terminal || condition.kind == Kind::error;
    const bool asks = condition.kind == Kind::send || condition.kind == Kind::skip;
    if (!decides && !asks && condition.kind != Kind::next) return;
    for (const net::Arc& arc : net_.preset(id)) {
      if (net_[arc.place].fused() || net_[arc.place].fact.valid()) continue;
      LocalNet::Place& place = rows_[index_of(arc.place)].place;
      if (asks)
        place.does =
            fmt::format("tessera::asks({}, {})", port(net_.parts()[net_[id].block].channel, /*sends=*/true),
                        place.behaviour.value);
      else
        place.does = fmt::format("tessera::{}({})", decides ? "decides" : "routes", place.behaviour.value);
    }
  }

  const net::Net& net_;
  const spec::Model& model_;
  const Parts& parts_;
  const std::vector<PlaceId>& places_;
  const std::vector<TransitionId>& transitions_;
  std::size_t prefix_;
  const spec::Subsystem& subsystem_;
  std::vector<PlaceRow> rows_;        // in the order of the flat net
  std::vector<std::size_t> numbers_;  // of these rows in the table
  LocalNet local_;
};

/// The same text for equal nets, whatever the numbers of their channels.
std::string identity(const LocalNet& net) {
  std::string text;
  for (const LocalNet::Port& port : net.ports) ((text += port.name) += port.sends ? '>' : '<') += '\n';
  for (const LocalNet::Fact& fact : net.facts) ((text += fact.kind) += fact.name) += '\n';
  for (const LocalNet::Place& place : net.places) {
    ((text += place.name) += ' ') += place.does;
    if (place.tokens > 0) text += " marked";
    text += '\n';
  }
  for (const LocalNet::Transition& transition : net.transitions) {
    ((((text += transition.name) += ' ') += transition.guard) += transition.role) += transition.in_words;
    for (const std::vector<std::string>* side : {&transition.inputs, &transition.outputs})
      for (const std::string& place : *side) (text += ' ') += place;
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
      for (std::size_t port = 0; port < local.ports.size(); ++port) {
        ChannelPorts& ends = all.of_channel[local.ports[port].channel];
        (local.ports[port].sends ? ends.from : ends.to) = port;
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
