#include "timing/declared.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "layers/wiring.hpp"
#include "spec/model/endings.hpp"

namespace tessera::timing {
namespace {

using layers::Direction;
using layers::Wiring;

class Reader {
 public:
  explicit Reader(const spec::Model& model) : model_(model), wiring_(model) {
    declared_.missing.resize(model.instances.size());
    declared_.all_missing.resize(model.instances.size());
    declared_.differ.resize(model.instances.size());
    declared_.takes_turns.resize(model.instances.size());
    declared_.stale.resize(model.instances.size());
    declared_.system.latency = model.timing.latency.count();
    for (const spec::InstanceId instance : model.instances.ids()) read(instance);
    for (const spec::ChannelId channel : model.channels.ids()) read(channel);
    for (std::uint32_t c = 0; c < declared_.system.channels.size(); ++c) forbid_ends(c);
    // A subsystem of which something is missing may take any time, so that nothing that waits for it is bounded.
    for (std::size_t i = 0; i < declared_.missing.size(); ++i)
      if (!declared_.missing[i].empty()) declared_.system.subsystems[i].longest = unbounded;
    if (model.timing.chains)
      for (const spec::TimedChain& chain : *model.timing.chains) add_chain(chain);
    else
      for (const spec::Agent& agent : model.agents) find_chains(agent);
  }

  Declared take() { return std::move(declared_); }

 private:
  void miss(spec::InstanceId instance, std::string why) {
    std::string& missing = declared_.missing[instance.value];
    if (missing.empty()) missing = why;
    std::vector<std::string>& all = declared_.all_missing[instance.value];
    if (std::ranges::find(all, why) == all.end()) all.push_back(std::move(why));
  }

  void read(spec::InstanceId instance) {
    const spec::Subsystem& subsystem = model_.subsystem(instance);
    Subsystem& mine = declared_.system.subsystems.emplace_back();
    if (model_.deployment) mine.process = model_.agents[model_.instances[instance].agent].process.value;
    mine.period = subsystem.period ? subsystem.period->count() : 0;
    mine.catch_up = subsystem.overrun == spec::Overrun::catch_up;
    if (subsystem.stale) declared_.stale[instance.value] = subsystem.stale->count();
    if (subsystem.realtime && subsystem.realtime->cpu) {
      mine.processor = processor(static_cast<int>(*subsystem.realtime->cpu), mine.process);
      mine.priority = static_cast<int>(subsystem.realtime->priority);
      declared_.takes_turns[instance.value] =
          subsystem.realtime->policy == spec::RealTime::Policy::round_robin;
    }
    if (subsystem.receive_first)
      miss(instance,
           model_.instance_path(instance) + " receives before its transition function (`receive: first`)");
    const spec::Behaviour* first = nullptr;
    mine.shortest = unbounded;
    for (const spec::Behaviour& behaviour : subsystem.behaviours) {
      if (behaviour.is_group()) continue;
      const std::string name = model_.instance_path(instance) + "." + behaviour.name;
      if (!behaviour.takes.is_declared()) miss(instance, name + " does not say what it takes");
      if (!behaviour.skippable.empty()) miss(instance, name + " may skip a send");
      mine.shortest = std::min<Time>(mine.shortest, behaviour.takes.shortest.count());
      mine.longest = std::max<Time>(mine.longest, behaviour.takes.longest.count());
      if (first != nullptr && (behaviour.takes.shortest != first->takes.shortest ||
                               behaviour.takes.longest != first->takes.longest))
        declared_.differ[instance.value] = true;
      if (first == nullptr) {
        first = &behaviour;
        mine.parallel = behaviour.transfer == spec::Transfer::parallel;
        mine.sends = numbers(wiring_.used(instance, behaviour, Direction::send));
        mine.receives = numbers(wiring_.used(instance, behaviour, Direction::receive));
      } else if (mine.parallel != (behaviour.transfer == spec::Transfer::parallel) ||
                 mine.sends != numbers(wiring_.used(instance, behaviour, Direction::send)) ||
                 mine.receives != numbers(wiring_.used(instance, behaviour, Direction::receive))) {
        miss(instance, name + " does not use the channels that " + std::string(first->name) + " uses");
      }
    }
    if (mine.shortest >= unbounded) mine.shortest = 0;
    mine.longest = std::max<Time>(mine.longest, 1);
  }

  /// Processors with one number are the same one only on one machine. A process without a host may be on any.
  [[nodiscard]] int processor(int number, std::uint32_t process) {
    if (!model_.deployment) return number;
    const std::string& host = model_.deployment->processes[spec::ProcessId{process}].host;
    const auto [known, is_new] =
        processors_.try_emplace({host, number}, static_cast<int>(processors_.size()));
    return known->second;
  }

  void read(spec::ChannelId id) {
    const spec::Channel& channel = model_.channels[id];
    Channel& mine = declared_.system.channels.emplace_back();
    mine.from = channel.from.instance.value;
    mine.to = channel.to.instance.value;
    mine.send_blocks = channel.send == spec::Mode::blocking;
    mine.receive_blocks = channel.receive == spec::Mode::blocking;
    if (channel.send_timeout) mine.send_timeout = channel.send_timeout->count();
    if (channel.receive_timeout) mine.receive_timeout = channel.receive_timeout->count();
    const std::string name = model_.channel_name(channel);
    std::string why;
    if (channel.model.valid()) why = name + " has a communication model of its own";
    if (model_.crosses_processes(channel)) {
      if (model_.timing.network)
        mine.network = model_.timing.network->count();
      else
        why = name + " crosses a network, and `timing` does not say the most time of a message (`network`)";
    }
    if (channel.receive == spec::Mode::blocking_once) why = name + " waits for the first value only";
    if (why.empty()) return;
    miss(channel.from.instance, why);
    miss(channel.to.instance, why);
  }

  /// Nothing bounds a wait for a subsystem that has ended.
  void forbid_ends(std::uint32_t c) {
    const Channel& channel = declared_.system.channels[c];
    const auto waits = [&](std::uint32_t who, std::uint32_t other) {
      if (may_end(model_.subsystem({other})))
        miss({who},
             model_.instance_path({who}) + " waits for " + model_.instance_path({other}) + ", which may end");
    };
    if (channel.receive_blocks && uses(declared_.system.subsystems[channel.to].receives, c))
      waits(channel.to, channel.from);
    if (channel.send_blocks && uses(declared_.system.subsystems[channel.from].sends, c))
      waits(channel.from, channel.to);
  }
  /// Not by a failure: the bounds assume that there is none.
  static bool may_end(const spec::Subsystem& subsystem) {
    return std::ranges::any_of(subsystem.behaviours, [](const spec::Behaviour& behaviour) {
      if (behaviour.parent.valid()) return false;
      const spec::Endings endings(behaviour);
      if (!endings.possible(spec::Ending::terminal)) return false;
      for (const spec::NextId id : behaviour.next.ids())
        if (!behaviour.next[id].behaviour.valid() &&
            endings.taken(id, spec::Ending::terminal) != spec::Truth::never)
          return true;
      return endings.none_possible(spec::Ending::terminal);
    });
  }

  static std::vector<std::uint32_t> numbers(const std::vector<spec::ChannelId>& channels) {
    std::vector<std::uint32_t> result;
    for (const spec::ChannelId channel : channels) result.push_back(channel.value);
    return result;
  }

  void find_chains(const spec::Agent& agent) {
    const auto& subsystems = model_.definition_of(agent).subsystems;
    const spec::InstanceId control = agent.first_instance;
    for (const spec::DefinedSubsystemId from : subsystems.ids()) {
      if (subsystems[from].kind != spec::SubsystemKind::receptor) continue;
      for (const spec::DefinedSubsystemId to : subsystems.ids())
        if (subsystems[to].kind == spec::SubsystemKind::effector)
          add_chain({agent.instance(from), control, agent.instance(to)});
    }
  }

  [[nodiscard]] std::string name_of(const std::vector<spec::InstanceId>& path) const {
    std::string name;
    for (const spec::InstanceId instance : path)
      name += (name.empty() ? "" : " -> ") + model_.instance_path(instance);
    return name;
  }

  /// robot.camera -> robot.goals -> (planner) -> robot.path -> robot.motor
  [[nodiscard]] std::string name_of(const spec::TimedChain& chain) const {
    std::string name;
    auto node = chain.foreign.begin();
    for (std::size_t at = 0; at < chain.path.size(); ++at) {
      if (node != chain.foreign.end() && node->after == at) name += " -> (" + (node++)->name + ")";
      name += (name.empty() ? "" : " -> ") + model_.instance_path(chain.path[at]);
    }
    return name;
  }

  /// A chain that the specification names. It stays without a way if a behaviour does not use a channel of it.
  void add_chain(const spec::TimedChain& asked) {
    DeclaredChain chain{asked.name, asked.path, {{}}};
    chain.leads = name_of(asked);
    chain.is_named = true;
    if (asked.age) chain.age = asked.age->count();
    if (asked.reaction) chain.reaction = asked.reaction->count();
    std::size_t channels = 0;
    auto node = asked.foreign.begin();
    for (std::size_t at = 0; at < asked.hops.size(); ++at) {
      if (node != asked.foreign.end() && node->after == at + 1) {
        chain.foreign.push_back({node->name, node->shortest.count(), node->longest.count(), channels});
        ++node;
        continue;
      }
      const std::vector<spec::ChannelId>& hop = asked.hops[at];
      ++channels;
      std::vector<Chain> longer;
      for (const spec::ChannelId channel : hop) {
        const std::uint32_t c = channel.value, from = declared_.system.channels[c].from,
                            to = declared_.system.channels[c].to;
        if (!uses(declared_.system.subsystems[from].sends, c)) {
          chain.unused = model_.instance_path({from}) + " does not send over " + name_of(channel);
        } else if (!uses(declared_.system.subsystems[to].receives, c)) {
          chain.unused = model_.instance_path({to}) + " does not receive over " + name_of(channel);
        } else {
          for (Chain way : chain.ways) {
            way.push_back(c);
            longer.push_back(std::move(way));
          }
        }
      }
      chain.ways = std::move(longer);
    }
    if (!chain.ways.empty()) chain.unused.clear();
    declared_.chains.push_back(std::move(chain));
  }
  [[nodiscard]] std::string name_of(spec::ChannelId channel) const {
    return model_.channel_name(model_.channels[channel]);
  }
  static bool uses(const std::vector<std::uint32_t>& channels, std::uint32_t channel) {
    return std::ranges::find(channels, channel) != channels.end();
  }

  void add_chain(std::vector<spec::InstanceId> path) {
    DeclaredChain chain{{}, std::move(path), {{}}};
    for (std::size_t at = 0; at + 1 < chain.path.size(); ++at) {
      std::vector<Chain> longer;
      for (const std::uint32_t c : declared_.system.subsystems[chain.path[at].value].sends) {
        if (declared_.system.channels[c].to != chain.path[at + 1].value) continue;
        for (Chain way : chain.ways) {
          way.push_back(c);
          longer.push_back(std::move(way));
        }
      }
      chain.ways = std::move(longer);
    }
    if (chain.ways.empty()) return;
    chain.name = chain.leads = name_of(chain.path);
    declared_.chains.push_back(std::move(chain));
  }

  const spec::Model& model_;
  Wiring wiring_;
  Declared declared_;
  std::map<std::pair<std::string, int>, int> processors_;  ///< of deployed systems, by host and number
};

}  // namespace

bool says_times(const spec::Model& model) {
  return model.timing.chains ||
         std::ranges::any_of(model.definitions, [](const spec::Definition& definition) {
           return std::ranges::any_of(definition.subsystems, [](const spec::Subsystem& subsystem) {
             return std::ranges::any_of(subsystem.behaviours, [](const spec::Behaviour& behaviour) {
               return behaviour.takes.is_declared();
             });
           });
         });
}

Declared declared(const spec::Model& model) { return Reader(model).take(); }

}  // namespace tessera::timing
