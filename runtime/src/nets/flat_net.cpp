#include "nets/flat_net.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <span>

#include "tessera/net_hash.hpp"
#include "tessera/recording.hpp"

namespace tessera {
namespace {

[[nodiscard]] std::string guard_text(Guard guard) {
  switch (guard.kind) {
    case Guard::Kind::none:
    case Guard::Kind::told:  // the net leaves open what comes
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
    case Guard::Kind::send:
      return "send";
    case Guard::Kind::skip:
      return "skip";
  }
  return "";
}

/// Puts the flat net together: the pages above the subsystems, the memory of channels, the nets of the
/// subsystems, and the media, each as its table has it.
class Rebuilding {
 public:
  explicit Rebuilding(const System& system) : system_(system), agents_(agents_of(system)) {}

  FlatNet result() {
    find_channels();
    const std::uint32_t of_system = add_places(*system_.system_page, "");
    std::vector<std::uint32_t> of_agents;
    for (const AgentSpan& agent : agents_)
      of_agents.push_back(add_places(*system_.agent_page, std::string(agent.name) + '.'));
    add_fused_places();
    for (const Instance& instance : system_.instances) add_places(instance);

    const UpperPage& page = *system_.agent_page;
    Below below;
    for (const std::uint32_t first : of_agents) below.add(first + page.in, first + page.out);
    add_transitions(*system_.system_page, "", of_system, below);
    for (std::size_t agent = 0; agent < agents_.size(); ++agent)
      add_transitions(page, std::string(agents_[agent].name) + '.', of_agents[agent],
                      instances_of(agents_[agent]));
    for (std::uint32_t index = 0; index < system_.instances.size(); ++index) add_transitions(index);
    for (std::uint32_t channel = 0; channel < system_.channels.size(); ++channel) add_medium(channel);
    return std::move(net_);
  }

 private:
  /// The places where the pages below are entered and left.
  struct Below {
    std::vector<std::uint32_t> entries, exits;
    void add(std::uint32_t in, std::uint32_t out) {
      entries.push_back(in);
      exits.push_back(out);
    }
  };

  [[nodiscard]] Below instances_of(const AgentSpan& agent) const {
    Below below;
    for (std::uint32_t instance = agent.first; instance < agent.end; ++instance)
      below.add(first_place_[instance] + system_.instances[instance].net->in,
                first_place_[instance] + system_.instances[instance].net->out);
    return below;
  }

  void find_channels() {
    for (const Instance& instance : system_.instances)
      channel_of_.emplace_back(instance.net->ports.size(), static_cast<std::uint32_t>(nobody));
    for (std::uint32_t channel = 0; channel < system_.channels.size(); ++channel)
      for (const End& end : {system_.channels[channel].from, system_.channels[channel].to})
        if (end.is_used() && end.port < channel_of_[end.instance].size())
          channel_of_[end.instance][end.port] = channel;
  }

  /// Returns the number of the first.
  std::uint32_t add_places(const UpperPage& page, const std::string& prefix) {
    const auto first = static_cast<std::uint32_t>(net_.places.size());
    for (const PagePlace& place : page.places)
      net_.places.push_back({prefix + std::string(place.name), place.tokens});
    return first;
  }

  void add_places(const Instance& instance) {
    first_place_.push_back(static_cast<std::uint32_t>(net_.places.size()));
    const std::string prefix = prefix_of(instance);
    for (const Place& place : instance.net->places)
      net_.places.push_back({prefix + std::string(place.name), place.tokens});
  }

  void add_fused_places() {
    for (const Channel& channel : system_.channels) {
      fused_.push_back(static_cast<std::uint32_t>(net_.places.size()));
      if (!channel.is_used()) continue;
      for (const FusedPlace& place : channel.places)
        net_.places.push_back({fmt::format("{}.{}", channel.name, place.name), place.tokens});
    }
  }

  void add_transitions(const UpperPage& page, const std::string& prefix, std::uint32_t first,
                       const Below& below) {
    const auto ends = [&](std::initializer_list<PageEnd> all) {
      std::vector<std::uint32_t> places;
      for (const PageEnd end : all) {
        const std::vector<std::uint32_t>& all_below =
            end.kind == PageEnd::Kind::entries ? below.entries : below.exits;
        if (end.kind == PageEnd::Kind::own)
          places.push_back(first + end.place);
        else
          places.insert(places.end(), all_below.begin(), all_below.end());
      }
      return places;
    };
    for (const PageTransition& transition : page.transitions)
      net_.transitions.push_back({prefix + std::string(transition.name),
                                  system_instance,
                                  ends(transition.inputs),
                                  ends(transition.outputs),
                                  "",
                                  {.step = transition.step}});
  }

  void add_transitions(std::uint32_t index) {
    const Instance& instance = system_.instances[index];
    const std::string prefix = prefix_of(instance);
    net_.first_of_instance.push_back(static_cast<std::uint32_t>(net_.transitions.size()));
    for (const Transition& transition : instance.net->transitions)
      net_.transitions.push_back({prefix + std::string(transition.name), index,
                                  ends_of(index, transition.inputs), ends_of(index, transition.outputs),
                                  guard_text(transition.guard), role_of(index, transition.role)});
  }

  void add_medium(std::uint32_t channel) {
    const Channel& its = system_.channels[channel];
    if (!its.is_used()) return;
    const auto ends = [&](std::initializer_list<std::uint16_t> all) {
      std::vector<std::uint32_t> places;
      for (const std::uint16_t place : all) places.push_back(fused_[channel] + place);
      return places;
    };
    for (const MediumTransition& transition : its.medium)
      net_.transitions.push_back({fmt::format("{}.{}", its.name, transition.name),
                                  system_instance,
                                  ends(transition.inputs),
                                  ends(transition.outputs),
                                  "",
                                  {.step = transition.step, .channel = channel}});
  }

  [[nodiscard]] static std::string prefix_of(const Instance& instance) {
    return fmt::format("{}.{}.", instance.agent, instance.name);
  }

  /// nullopt: no channel is behind that port.
  [[nodiscard]] std::optional<std::uint32_t> channel_behind(std::uint32_t instance,
                                                            std::uint16_t port) const {
    const std::vector<std::uint32_t>& channels = channel_of_[instance];
    if (port >= channels.size() || channels[port] == nobody) return std::nullopt;
    return channels[port];
  }

  [[nodiscard]] TransitionRole role_of(std::uint32_t instance, const TableRole& role) const {
    const std::span<const Behaviour> behaviours = system_.instances[instance].net->behaviours;
    TransitionRole made{.step = role.step, .channel = channel_behind(instance, role.port)};
    if (role.behaviour < behaviours.size()) made.behaviour = behaviours[role.behaviour].name;
    return made;
  }

  [[nodiscard]] std::vector<std::uint32_t> ends_of(std::uint32_t instance,
                                                   std::initializer_list<ArcEnd> all) const {
    std::vector<std::uint32_t> places;
    for (const ArcEnd end : all) {
      if (!end.is_shared()) {
        if (end.place() < system_.instances[instance].net->places.size())
          places.push_back(first_place_[instance] + end.place());
      } else if (const auto channel = channel_behind(instance, end.port())) {
        if (end.place() < system_.channels[*channel].places.size())
          places.push_back(fused_[*channel] + end.place());
      }
    }
    return places;
  }

  const System& system_;
  std::vector<AgentSpan> agents_;
  FlatNet net_;
  std::vector<std::uint32_t> first_place_;              // per instance
  std::vector<std::uint32_t> fused_;                    // per channel: its first fused place
  std::vector<std::vector<std::uint32_t>> channel_of_;  // per instance and port; nobody: none
};

[[nodiscard]] std::uint32_t position(const UpperPage& page, Step step) {
  const auto found = std::ranges::find(page.transitions, step, &PageTransition::step);
  return static_cast<std::uint32_t>(found - page.transitions.begin());
}

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

std::uint32_t system_transition(const System& system, Step step) {
  return position(*system.system_page, step);
}

std::uint32_t agent_transition(const System& system, std::uint32_t agent, Step step) {
  const auto above = static_cast<std::uint32_t>(system.system_page->transitions.size());
  const auto each = static_cast<std::uint32_t>(system.agent_page->transitions.size());
  return above + agent * each + position(*system.agent_page, step);
}

FlatNet net_of(const System& system) { return Rebuilding(system).result(); }

}  // namespace tessera
