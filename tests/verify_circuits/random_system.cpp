#include "verify_circuits/random_system.hpp"

#include <algorithm>
#include <random>

namespace tessera::test {

spec::Subsystem& SystemBuilder::at(spec::Index instance) {
  const spec::Instance& entry = model_.instances[instance];
  return model_.definitions[model_.agents[entry.agent].definition].subsystems[entry.subsystem];
}

spec::Index SystemBuilder::subsystem(bool own_agent) {
  if (own_agent || model_.agents.empty()) {
    spec::Agent agent;
    agent.path = "a" + std::to_string(model_.agents.size());
    agent.definition = static_cast<spec::Index>(model_.definitions.size());
    agent.first_instance = static_cast<spec::Index>(model_.instances.size());
    model_.agents.push_back(agent);
    model_.definitions.emplace_back();
    model_.definitions.back().name = agent.path;
  }
  auto& subsystems = model_.definitions.back().subsystems;
  subsystems.emplace_back();
  subsystems.back().name = "s" + std::to_string(model_.instances.size());
  model_.instances.push_back(
      {static_cast<spec::Index>(model_.agents.size() - 1), static_cast<spec::Index>(subsystems.size() - 1)});
  return static_cast<spec::Index>(model_.instances.size() - 1);
}

spec::Index SystemBuilder::channel(spec::Index from, spec::Index to, Ends ends) {
  using namespace std::chrono_literals;
  const auto number = static_cast<spec::Index>(model_.channels.size());
  spec::Channel channel;
  channel.from = {from, static_cast<spec::Index>(at(from).outputs.size())};
  channel.to = {to, static_cast<spec::Index>(at(to).inputs.size())};
  channel.send = ends.send_blocks ? spec::Mode::blocking : spec::Mode::non_blocking;
  channel.receive = ends.receive_blocks ? spec::Mode::blocking : spec::Mode::non_blocking;
  if (ends.send_blocks && ends.send_timeout) channel.send_timeout = 1s;
  if (ends.receive_blocks && ends.receive_timeout) channel.receive_timeout = 1s;
  spec::Field field;
  field.name = "y" + std::to_string(number);
  at(from).outputs.push_back(field);
  field.name = "x" + std::to_string(number);
  at(to).inputs.push_back(field);
  model_.channels.push_back(channel);
  return number;
}

spec::Index SystemBuilder::behaviour(spec::Index instance, const std::vector<spec::Index>& sends,
                                     const std::vector<spec::Index>& receives, spec::Transfer transfer) {
  auto& behaviours = at(instance).behaviours;
  spec::Behaviour made;
  made.name = "b" + std::to_string(behaviours.size());
  made.send.emplace();
  made.receive.emplace();
  for (const spec::Index channel : sends) made.send->push_back(model_.channels[channel].from.buffer);
  for (const spec::Index channel : receives) made.receive->push_back(model_.channels[channel].to.buffer);
  made.transfer = transfer;
  made.next.emplace_back();
  behaviours.push_back(std::move(made));
  return static_cast<spec::Index>(behaviours.size() - 1);
}

void SystemBuilder::leave(spec::Index instance, spec::Index behaviour, bool always,
                          const std::vector<spec::Index>& next) {
  spec::Behaviour& left = at(instance).behaviours[behaviour];
  left.terminal.kind = always ? spec::Condition::Kind::always : spec::Condition::Kind::expressions;
  if (!always) left.terminal.expressions.push_back({"done", "in.done", {}});
  left.next.clear();
  for (const spec::Index follower : next) {
    spec::Next entry;
    entry.behaviour = follower;
    // All but the last are taken if some expression holds.
    if (left.next.size() + 1 < next.size()) {
      entry.when.kind = spec::When::Kind::expression;
      entry.when.text.text = "in.choice";
    }
    left.next.push_back(entry);
  }
}

void SystemBuilder::may_fail(spec::Index instance, spec::Index behaviour) {
  spec::Condition& error = at(instance).behaviours[behaviour].error;
  error.kind = spec::Condition::Kind::expressions;
  error.expressions.push_back({"broken", "in.broken", {}});
}

namespace {

class RandomSystem {
 public:
  RandomSystem(std::uint64_t seed, bool differing) : random_(seed), differing_(differing) {}

  spec::Model result() {
    subsystems_ = between(2, 4);
    for (spec::Index index = 0; index < subsystems_; ++index) builder_.subsystem(chance(2));
    sends_.resize(subsystems_);
    receives_.resize(subsystems_);
    // More waiting makes more interesting systems, and smaller state spaces.
    strict_ = between(2, 5);
    for (spec::Index left = between(1, subsystems_ == 2 ? 4 : 6); left > 0; --left) add_channel();
    for (spec::Index index = 0; index < subsystems_; ++index) add_behaviours(index);
    return builder_.result();
  }

 private:
  spec::Index between(spec::Index low, spec::Index high) {
    return std::uniform_int_distribution<spec::Index>(low, high)(random_);
  }
  bool chance(spec::Index one_in) { return between(1, one_in) == 1; }

  void add_channel() {
    const spec::Index from = between(0, subsystems_ - 1);
    spec::Index to = between(0, subsystems_ - 1);
    if (to == from && !chance(8)) to = (from + 1) % subsystems_;
    const SystemBuilder::Ends ends{!chance(strict_), !chance(strict_), chance(4), chance(4)};
    const spec::Index channel = builder_.channel(from, to, ends);
    sends_[from].push_back(channel);
    receives_[to].push_back(channel);
    waits_to_be_sent_.push_back(ends.send_blocks);
  }

  std::vector<spec::Index> some(std::vector<spec::Index> channels, spec::Index drop_one_in) {
    std::erase_if(channels, [&](spec::Index) { return chance(drop_one_in); });
    return channels;
  }

  void add_behaviours(spec::Index instance) {
    std::ranges::shuffle(sends_[instance], random_);
    std::ranges::shuffle(receives_[instance], random_);
    const auto transfer = chance(3) ? spec::Transfer::parallel : spec::Transfer::sequential;
    const bool start_up = chance(4), second = differing_ ? !chance(4) : chance(5);
    const spec::Index drop = differing_ ? 4 : 40;
    if (start_up) {
      std::vector<spec::Index> sent = some(sends_[instance], 2);
      if (!chance(6)) std::erase_if(sent, [&](spec::Index channel) { return waits_to_be_sent_[channel]; });
      const auto received = chance(8) ? some(receives_[instance], 2) : std::vector<spec::Index>{};
      builder_.behaviour(instance, sent, received, transfer);
    }
    const spec::Index main =
        builder_.behaviour(instance, some(sends_[instance], drop), some(receives_[instance], drop), transfer);
    if (start_up) builder_.leave(instance, 0, !chance(3), {main});
    if (second) add_second(instance, main, transfer);
    if (chance(12)) {
      if (second || chance(2))
        builder_.may_fail(instance, main);
      else
        builder_.leave(instance, main, chance(4), {spec::none});
    }
  }

  void add_second(spec::Index instance, spec::Index main, spec::Transfer transfer) {
    const spec::Index drop = differing_ || chance(4) ? 3 : 1000;
    const spec::Index other =
        builder_.behaviour(instance, some(sends_[instance], drop), some(receives_[instance], drop), transfer);
    const bool always = chance(2);
    if (chance(8))
      builder_.leave(instance, main, false, {other, spec::none});
    else
      builder_.leave(instance, main, always, {other});
    builder_.leave(instance, other, chance(2), {main});
  }

  std::mt19937_64 random_;
  bool differing_;
  SystemBuilder builder_;
  spec::Index subsystems_ = 0, strict_ = 3;
  std::vector<std::vector<spec::Index>> sends_, receives_;  // per subsystem
  std::vector<bool> waits_to_be_sent_;                      // per channel
};

}  // namespace

spec::Model random_system(std::uint64_t seed) { return RandomSystem(seed, false).result(); }
spec::Model random_differing_system(std::uint64_t seed) { return RandomSystem(seed, true).result(); }

}  // namespace tessera::test
