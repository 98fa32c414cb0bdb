#include "timing/declared.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "layers/wiring.hpp"

namespace tessera::timing {
namespace {

using layers::Direction;
using layers::Wiring;

class Reader {
 public:
  explicit Reader(const spec::Model& model) : model_(model), wiring_(model) {
    declared_.missing.resize(model.instances.size());
    for (const spec::InstanceId instance : model.instances.ids()) read(instance);
    for (const spec::ChannelId channel : model.channels.ids()) read(channel);
    // A subsystem of which something is missing may take any time, so that nothing that waits for it is bounded.
    for (std::size_t i = 0; i < declared_.missing.size(); ++i)
      if (!declared_.missing[i].empty()) declared_.system.subsystems[i].longest = unbounded;
    for (const spec::Agent& agent : model.agents) find_chains(agent);
  }

  Declared take() { return std::move(declared_); }

 private:
  void miss(spec::InstanceId instance, std::string why) {
    std::string& missing = declared_.missing[instance.value];
    if (missing.empty()) missing = std::move(why);
  }

  void read(spec::InstanceId instance) {
    const spec::Subsystem& subsystem = model_.subsystem(instance);
    Subsystem& mine = declared_.system.subsystems.emplace_back();
    mine.period = subsystem.period ? subsystem.period->count() : 0;
    mine.catch_up = subsystem.overrun == spec::Overrun::catch_up;
    if (subsystem.realtime && subsystem.realtime->cpu) {
      mine.processor = static_cast<int>(*subsystem.realtime->cpu);
      mine.priority = static_cast<int>(subsystem.realtime->priority);
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
    if (model_.crosses_processes(channel)) why = name + " crosses a network";
    if (channel.receive == spec::Mode::blocking_once) why = name + " waits for the first value only";
    if (why.empty()) return;
    miss(channel.from.instance, why);
    miss(channel.to.instance, why);
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
    for (const spec::InstanceId instance : chain.path)
      chain.name += (chain.name.empty() ? "" : " -> ") + model_.instance_path(instance);
    declared_.chains.push_back(std::move(chain));
  }

  const spec::Model& model_;
  Wiring wiring_;
  Declared declared_;
};

/// The nearest reason why something that the chain depends on is not bounded.
std::string reason(const Declared& declared, const spec::Model& model, const Bounds& bounds,
                   const Chain& chain) {
  const System& system = declared.system;
  std::vector<std::uint32_t> level;
  std::set<std::uint32_t> seen;
  const auto reach = [&](std::uint32_t i) {
    if (seen.insert(i).second) level.push_back(i);
  };
  reach(system.channels[chain.front()].from);
  for (const std::uint32_t c : chain) reach(system.channels[c].to);
  for (std::size_t at = 0; at < level.size(); ++at) {
    const std::uint32_t i = level[at];
    if (!declared.missing[i].empty()) return declared.missing[i];
    if (bounds.occurrences().response(i) >= unbounded)
      return model.instance_path({i}) + " shares its processor with others that may never leave it";
    for (const std::uint32_t c : system.subsystems[i].receives)
      if (system.channels[c].receive_blocks) reach(system.channels[c].from);
    for (const std::uint32_t c : system.subsystems[i].sends)
      if (system.channels[c].send_blocks) reach(system.channels[c].to);
  }
  for (const std::uint32_t c : chain)
    if (!bounds.occurrences().keeps_values(c))
      return model.channel_name(model.channels[spec::ChannelId{c}]) +
             " may take a value back before it is read, since its send may time out";
  return "its subsystems wait for each other without a bound";
}

/// Each iteration begins at its instant, nobody waits, each subsystem has a processor of its own and comes once: then
/// calls can be chosen that reach the bounds.
bool is_exact(const Declared& declared, const Bounds& bounds, const Chain& chain) {
  const System& system = declared.system;
  if (system.latency > 0) return false;
  std::set<std::uint32_t> path{system.channels[chain.front()].from};
  for (const std::uint32_t c : chain) {
    const Channel& channel = system.channels[c];
    if (channel.send_blocks || channel.receive_blocks || !path.insert(channel.to).second) return false;
  }
  return std::ranges::all_of(path, [&](std::uint32_t i) {
    return bounds.occurrences().periodic(i) && system.subsystems[i].processor < 0 &&
           system.subsystems[i].longest <= system.subsystems[i].period;
  });
}

}  // namespace

Declared declared(const spec::Model& model) { return Reader(model).take(); }

ChainVerdict judge(const Declared& declared, const spec::Model& model, const Bounds& bounds,
                   const DeclaredChain& chain) {
  ChainVerdict verdict{{0, 0, 0, true}, true, {}};
  for (const Chain& way : chain.ways) {
    const ChainBound bound = bounds.chain(way);
    verdict.exact = verdict.exact && bound.enumerated && is_exact(declared, bounds, way);
    verdict.bound.age = std::max(verdict.bound.age, bound.age);
    verdict.bound.reaction = std::max(verdict.bound.reaction, bound.reaction);
    verdict.bound.start = std::max(verdict.bound.start, bound.start);
    verdict.bound.enumerated = verdict.bound.enumerated && bound.enumerated;
    if (bound.reaction >= unbounded && verdict.why.empty())
      verdict.why = reason(declared, model, bounds, way);
  }
  if (!verdict.why.empty()) verdict.exact = false;
  return verdict;
}

}  // namespace tessera::timing
