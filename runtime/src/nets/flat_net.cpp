#include "nets/flat_net.hpp"

#include <fmt/core.h>

#include <array>
#include <optional>
#include <unordered_map>

#include "tessera/net_hash.hpp"
#include "tessera/net_words.hpp"
#include "tessera/recording.hpp"

namespace tessera {
namespace {

[[nodiscard]] std::string guard_text(Guard guard) {
  switch (guard.kind) {
    case Guard::Kind::none:
      return "";
    case Guard::Kind::go_on:
      return "go_on";
    case Guard::Kind::terminal:
      return "terminal";
    case Guard::Kind::error:
      return "error";
    case Guard::Kind::next:
      return fmt::format("next:{}", guard.entry);
    case Guard::Kind::elapsed:
      return "elapsed";
  }
  return "";
}

class Rebuilding {
 public:
  explicit Rebuilding(const System& system) : system_(system), agents_(agents_of(system)) {}

  FlatNet result() {
    add_upper_places();
    add_fused_places();
    ports_.resize(system_.instances.size());
    for (std::uint32_t channel = 0; channel < system_.channels.size(); ++channel)
      for (const End& end : {system_.channels[channel].from, system_.channels[channel].to})
        if (!end.port.empty()) ports_[end.instance].emplace(end.port, channel);
    for (std::uint32_t instance = 0; instance < system_.instances.size(); ++instance) add_instance(instance);
    close_upper_layers();
    add_media();
    return std::move(net_);
  }

 private:
  /// Adds the places and transitions that carry the values of a channel between processes
  /// (src/layers/networked.cpp).
  void add_media() {
    struct Delivery {
      std::string_view name;
      Step step;
      std::array<FusedPlace::Role, 2> takes, gives;
    };
    using enum FusedPlace::Role;
    const Delivery deliver{words::deliver, Step::deliver, {sent, empty}, {idle, full}};
    const std::array beyond_one{
        Delivery{words::replace, Step::replace, {sent, full}, {idle, full}},
        Delivery{words::deliver_older, Step::deliver_older, {more, empty}, {more, full}},
        Delivery{words::lose_older, Step::lose_older, {more, none}, {sent, none}}};
    for (std::uint32_t channel = 0; channel < system_.channels.size(); ++channel) {
      const Channel& its = system_.channels[channel];
      if (!system_.is_networked(its) || (its.from.port.empty() && its.to.port.empty())) continue;
      if (!fused(channel, idle)) continue;  // both sides are non-blocking: nothing joins them
      const auto add = [&](const Delivery& step) {
        FlatNet::FlatTransition flat{fmt::format("{}.{}", its.name, step.name), system_instance, {}, {}, "",
                                     {.step = step.step, .channel = channel}};
        for (const FusedPlace::Role place : step.takes)
          if (const auto found = fused(channel, place)) flat.inputs.push_back(*found);
        for (const FusedPlace::Role place : step.gives)
          if (const auto found = fused(channel, place)) flat.outputs.push_back(*found);
        net_.transitions.push_back(std::move(flat));
      };
      add(deliver);
      if (fused(channel, more))
        for (const Delivery& step : beyond_one) add(step);
    }
  }

  [[nodiscard]] std::optional<std::uint32_t> fused(std::uint32_t channel, FusedPlace::Role role) const {
    if (role == FusedPlace::Role::none) return std::nullopt;
    const std::span<const FusedPlace> places = system_.channels[channel].places;
    for (std::uint32_t place = 0; place < places.size(); ++place)
      if (places[place].role == role) return fused_[channel] + place;
    return std::nullopt;
  }

  std::uint32_t add_place(std::string name, std::uint32_t tokens = 0) {
    net_.places.push_back({std::move(name), tokens});
    return static_cast<std::uint32_t>(net_.places.size() - 1);
  }

  [[nodiscard]] static FlatNet::FlatTransition above(std::string name, Step step,
                                                     std::vector<std::uint32_t> inputs,
                                                     std::vector<std::uint32_t> outputs) {
    return {std::move(name), system_instance, std::move(inputs), std::move(outputs), "", {.step = step}};
  }

  /// Layers 1 and 2: an input (one token in that of the system) and an output, a start and an end.
  void add_upper_places() {
    net_.transitions.push_back(
        above(std::string(words::start), Step::start_system, {add_place(std::string(words::input), 1)}, {}));
    net_.transitions.push_back(
        above(std::string(words::end), Step::end_system, {}, {add_place(std::string(words::output))}));
    for (const AgentSpan& agent : agents_) {
      const std::string prefix = std::string(agent.name) + '.';
      const std::uint32_t in = add_place(prefix + std::string(words::input));
      const std::uint32_t out = add_place(prefix + std::string(words::output));
      net_.transitions[0].outputs.push_back(in);
      net_.transitions[1].inputs.push_back(out);
      net_.transitions.push_back(above(prefix + std::string(words::start), Step::start_agent, {in}, {}));
      net_.transitions.push_back(above(prefix + std::string(words::end), Step::end_agent, {}, {out}));
    }
  }

  void add_fused_places() {
    for (const Channel& channel : system_.channels) {
      fused_.push_back(static_cast<std::uint32_t>(net_.places.size()));
      if (channel.from.port.empty() && channel.to.port.empty()) continue;  // no behaviour uses it
      for (const FusedPlace& place : channel.places)
        add_place(fmt::format("{}.{}", channel.name, place.name), place.tokens);
    }
  }

  void add_instance(std::uint32_t index) {
    const Instance& instance = system_.instances[index];
    const std::string prefix = fmt::format("{}.{}.", instance.agent, instance.name);
    std::unordered_map<std::string_view, std::uint32_t> places;
    for (const Place& place : instance.net->places)
      places.emplace(place.name, add_place(prefix + std::string(place.name)));
    in_.push_back(places.contains(instance.net->in) ? places.at(instance.net->in) : 0);
    out_.push_back(places.contains(instance.net->out) ? places.at(instance.net->out) : 0);

    net_.first_of_instance.push_back(static_cast<std::uint32_t>(net_.transitions.size()));
    for (const Transition& transition : instance.net->transitions) {
      FlatNet::FlatTransition flat{
          prefix + std::string(transition.name), index, {}, {}, guard_text(transition.guard),
          role_of(index, transition.role)};
      for (std::string_view name : transition.inputs) add_end(index, places, name, flat.inputs);
      for (std::string_view name : transition.outputs) add_end(index, places, name, flat.outputs);
      net_.transitions.push_back(std::move(flat));
    }
  }

  [[nodiscard]] TransitionRole role_of(std::uint32_t instance, const TableRole& role) const {
    TransitionRole made{.step = role.step, .behaviour = std::string(role.behaviour)};
    if (const auto port = ports_[instance].find(role.port); port != ports_[instance].end())
      made.channel = port->second;
    return made;
  }

  void add_end(std::uint32_t instance, const std::unordered_map<std::string_view, std::uint32_t>& places,
               std::string_view name, std::vector<std::uint32_t>& ends) const {
    const std::size_t slash = name.find('/');
    if (slash == std::string_view::npos) {
      if (const auto found = places.find(name); found != places.end()) ends.push_back(found->second);
      return;
    }
    const auto port = ports_[instance].find(name.substr(0, slash));
    if (port == ports_[instance].end()) return;
    const std::span<const FusedPlace> fused = system_.channels[port->second].places;
    for (std::uint32_t place = 0; place < fused.size(); ++place)
      if (fused[place].name == name.substr(slash + 1)) ends.push_back(fused_[port->second] + place);
  }

  void close_upper_layers() {
    for (std::size_t agent = 0; agent < agents_.size(); ++agent)
      for (std::uint32_t instance = agents_[agent].first; instance < agents_[agent].end; ++instance) {
        net_.transitions[2 + 2 * agent].outputs.push_back(in_[instance]);
        net_.transitions[3 + 2 * agent].inputs.push_back(out_[instance]);
      }
  }

  const System& system_;
  std::vector<AgentSpan> agents_;
  FlatNet net_;
  std::vector<std::uint32_t> fused_;  // per channel: its first fused place
  std::vector<std::unordered_map<std::string_view, std::uint32_t>> ports_;  // per instance: port -> channel
  std::vector<std::uint32_t> in_, out_;                                     // per instance
};

}  // namespace

std::string FlatNet::hash() const {
  NetHash hash;
  for (const FlatPlace& place : places) hash.place(place.name, place.tokens);
  const auto names = [&](const std::vector<std::uint32_t>& ends) {
    std::vector<std::string_view> result;
    result.reserve(ends.size());
    for (std::uint32_t place : ends) result.emplace_back(places[place].name);
    return result;
  };
  for (const FlatTransition& transition : transitions)
    hash.transition(transition.name, names(transition.inputs), names(transition.outputs), transition.guard);
  return hash.hex();
}

std::vector<AgentSpan> agents_of(const System& system) {
  std::vector<AgentSpan> agents;
  for (std::uint32_t instance = 0; instance < system.instances.size(); ++instance) {
    if (agents.empty() || agents.back().name != system.instances[instance].agent)
      agents.push_back({system.instances[instance].agent, instance, instance});
    agents.back().end = instance + 1;
  }
  return agents;
}

FlatNet net_of(const System& system) { return Rebuilding(system).result(); }

}  // namespace tessera
