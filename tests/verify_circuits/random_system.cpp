#include "verify_circuits/random_system.hpp"

#include <algorithm>
#include <random>

#include "spec/parser.hpp"

namespace tessera::test {

spec::Subsystem& SystemBuilder::at(spec::InstanceId instance) {
  const spec::Instance& entry = model_.instances[instance];
  return model_.definitions[model_.agents[entry.agent].definition].subsystems[entry.subsystem];
}

spec::InstanceId SystemBuilder::subsystem(bool own_agent) {
  if (own_agent || model_.agents.empty()) {
    spec::Agent agent;
    agent.path = "a" + std::to_string(model_.agents.size());
    agent.definition = model_.definitions.next_id();
    agent.first_instance = model_.instances.next_id();
    model_.agents.push_back(agent);
    model_.definitions.emplace_back();
    model_.definitions.back().name = agent.path;
  }
  auto& subsystems = model_.definitions.back().subsystems;
  subsystems.emplace_back();
  subsystems.back().name = "s" + std::to_string(model_.instances.size());
  const spec::InstanceId made = model_.instances.next_id();
  model_.instances.push_back({{static_cast<std::uint32_t>(model_.agents.size() - 1)},
                              {static_cast<std::uint32_t>(subsystems.size() - 1)}});
  return made;
}

spec::ChannelId SystemBuilder::channel(spec::InstanceId from, spec::InstanceId to, Ends ends) {
  using namespace std::chrono_literals;
  const spec::ChannelId made = model_.channels.next_id();
  spec::Channel channel;
  channel.from = {from, at(from).outputs.next_id()};
  channel.to = {to, at(to).inputs.next_id()};
  channel.send = ends.send_blocks ? spec::Mode::blocking : spec::Mode::non_blocking;
  channel.receive = ends.receive_blocks ? spec::Mode::blocking : spec::Mode::non_blocking;
  if (ends.send_blocks && ends.send_timeout) channel.send_timeout = 1s;
  if (ends.receive_blocks && ends.receive_timeout) channel.receive_timeout = 1s;
  spec::Field field;
  field.name = "y" + std::to_string(made.value);
  at(from).outputs.push_back(field);
  field.name = "x" + std::to_string(made.value);
  at(to).inputs.push_back(field);
  model_.channels.push_back(channel);
  return made;
}

void SystemBuilder::add_models(const std::vector<spec::CommunicationModel>& models) {
  model_.models.insert(model_.models.end(), models.begin(), models.end());
}

void SystemBuilder::be_of_model(spec::ChannelId channel, spec::CommunicationModelId model) {
  model_.channels[channel].model = model;
  model_.channels[channel].send_timeout.reset();
  model_.channels[channel].receive_timeout.reset();
}

spec::BehaviourId SystemBuilder::behaviour(spec::InstanceId instance,
                                           const std::vector<spec::ChannelId>& sends,
                                           const std::vector<spec::ChannelId>& receives,
                                           spec::Transfer transfer) {
  auto& behaviours = at(instance).behaviours;
  spec::Behaviour made;
  made.name = "b" + std::to_string(behaviours.size());
  made.send.emplace();
  made.receive.emplace();
  for (const spec::ChannelId channel : sends) made.send->push_back(model_.channels[channel].from.buffer);
  for (const spec::ChannelId channel : receives) made.receive->push_back(model_.channels[channel].to.buffer);
  made.transfer = transfer;
  made.next.emplace_back();
  behaviours.push_back(std::move(made));
  return {static_cast<std::uint32_t>(behaviours.size() - 1)};
}

void SystemBuilder::leave(spec::InstanceId instance, spec::BehaviourId behaviour, bool always,
                          const std::vector<spec::BehaviourId>& next) {
  spec::Behaviour& left = at(instance).behaviours[behaviour];
  left.terminal.kind = always ? spec::Condition::Kind::always : spec::Condition::Kind::expressions;
  if (!always) left.terminal.expressions.push_back({"done", "in.done", {}});
  left.next.clear();
  for (const spec::BehaviourId follower : next) {
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

void SystemBuilder::may_fail(spec::InstanceId instance, spec::BehaviourId behaviour) {
  spec::Condition& error = at(instance).behaviours[behaviour].error;
  error.kind = spec::Condition::Kind::expressions;
  error.expressions.push_back({"broken", "in.broken", {}});
}

void SystemBuilder::receive_first(spec::InstanceId instance) { at(instance).receive_first = true; }

namespace {

/// Both sides wait; only the sender does; a queue of two.
const std::vector<spec::CommunicationModel>& own_models() {
  static const std::vector<spec::CommunicationModel> models = [] {
    diagnostics::Diagnostics file("models.yaml", R"(
tessera: 1
system: s
models:
  hand_over:
    shared: { free: 1, there: 0 }
    send:
      places: { in, work: { write: 1 }, out }
      transitions: { t1: { from: [in, free], to: work }, t2: { from: work, to: [out, there] } }
    receive:
      places: { in, work: { read: 1 }, out }
      transitions: { t1: { from: [in, there], to: work }, t2: { from: work, to: [out, free] } }
  mailbox:
    shared: { free: 1, there: 0 }
    send:
      places: { in, work: { write: 1 }, out }
      transitions: { t1: { from: [in, free], to: work }, t2: { from: work, to: [out, there] } }
    receive:
      places: { in, work: { read: 1 }, out }
      transitions:
        t1: { from: [in, there], to: work }
        t2: { from: work, to: [out, free] }
        pass: { from: [in, free], to: [out, free] }
  queue:
    slots: 2
    shared: { empty_1: 1, full_1: 0, empty_2: 1, full_2: 0, put_1: 1, put_2: 0, get_1: 1, get_2: 0 }
    send:
      places: { in, first: { write: 1 }, second: { write: 2 }, out }
      transitions:
        b1: { from: [in, put_1, empty_1], to: first }
        e1: { from: first, to: [out, full_1, put_2] }
        b2: { from: [in, put_2, empty_2], to: second }
        e2: { from: second, to: [out, full_2, put_1] }
    receive:
      places: { in, first: { read: 1 }, second: { read: 2 }, out }
      transitions:
        b1: { from: [in, get_1, full_1], to: first }
        e1: { from: first, to: [out, empty_1, get_2] }
        b2: { from: [in, get_2, full_2], to: second }
        e2: { from: second, to: [out, empty_2, get_1] }
agents:
  a: { control: { rate: 1 Hz, behaviours: { b: {} } } }
)");
    return spec::parse(file).value().models;
  }();
  return models;
}

struct Traits {
  bool differing = false, own_models = false;
};

class RandomSystem {
 public:
  RandomSystem(std::uint64_t seed, Traits traits)
      : random_(seed), differing_(traits.differing), own_models_(traits.own_models) {
    if (own_models_) builder_.add_models(own_models());
  }

  spec::Model result() {
    subsystems_ = between(2, 4);
    for (std::uint32_t index = 0; index < subsystems_; ++index) builder_.subsystem(chance(2));
    sends_.resize(subsystems_);
    receives_.resize(subsystems_);
    // More waiting makes more interesting systems, and smaller state spaces.
    strict_ = between(2, 5);
    for (std::uint32_t left = between(1, subsystems_ == 2 ? 4 : 6); left > 0; --left) add_channel();
    for (const spec::InstanceId instance : sends_.ids()) add_behaviours(instance);
    for (const spec::InstanceId instance : sends_.ids())
      if (chance(4)) builder_.receive_first(instance);
    return builder_.result();
  }

 private:
  std::uint32_t between(std::uint32_t low, std::uint32_t high) {
    return std::uniform_int_distribution<std::uint32_t>(low, high)(random_);
  }
  bool chance(std::uint32_t one_in) { return between(1, one_in) == 1; }

  void add_channel() {
    const spec::InstanceId from{between(0, subsystems_ - 1)};
    spec::InstanceId to{between(0, subsystems_ - 1)};
    if (to == from && !chance(8)) to = {(from.value + 1) % subsystems_};
    const SystemBuilder::Ends ends{!chance(strict_), !chance(strict_), chance(4), chance(4)};
    const spec::ChannelId channel = builder_.channel(from, to, ends);
    if (own_models_ && chance(2))
      builder_.be_of_model(channel, {between(0, static_cast<std::uint32_t>(own_models().size() - 1))});
    sends_[from].push_back(channel);
    receives_[to].push_back(channel);
    waits_to_be_sent_.push_back(ends.send_blocks);
  }

  std::vector<spec::ChannelId> some(std::vector<spec::ChannelId> channels, std::uint32_t drop_one_in) {
    std::erase_if(channels, [&](spec::ChannelId) { return chance(drop_one_in); });
    return channels;
  }

  void add_behaviours(spec::InstanceId instance) {
    std::ranges::shuffle(sends_[instance], random_);
    std::ranges::shuffle(receives_[instance], random_);
    const auto transfer = chance(3) ? spec::Transfer::parallel : spec::Transfer::sequential;
    const bool start_up = chance(4), second = differing_ ? !chance(4) : chance(5);
    const std::uint32_t drop = differing_ ? 4 : 40;
    if (start_up) {
      std::vector<spec::ChannelId> sent = some(sends_[instance], 2);
      if (!chance(6))
        std::erase_if(sent, [&](spec::ChannelId channel) { return waits_to_be_sent_[channel]; });
      const auto received = chance(8) ? some(receives_[instance], 2) : std::vector<spec::ChannelId>{};
      builder_.behaviour(instance, sent, received, transfer);
    }
    const spec::BehaviourId main =
        builder_.behaviour(instance, some(sends_[instance], drop), some(receives_[instance], drop), transfer);
    if (start_up) builder_.leave(instance, {0}, !chance(3), {main});
    if (second) add_second(instance, main, transfer);
    if (chance(12)) {
      if (second || chance(2))
        builder_.may_fail(instance, main);
      else
        builder_.leave(instance, main, chance(4), {spec::BehaviourId{}});
    }
  }

  void add_second(spec::InstanceId instance, spec::BehaviourId main, spec::Transfer transfer) {
    const std::uint32_t drop = differing_ || chance(4) ? 3 : 1000;
    const spec::BehaviourId other =
        builder_.behaviour(instance, some(sends_[instance], drop), some(receives_[instance], drop), transfer);
    const bool always = chance(2);
    if (chance(8))
      builder_.leave(instance, main, false, {other, {}});
    else
      builder_.leave(instance, main, always, {other});
    builder_.leave(instance, other, chance(2), {main});
  }

  std::mt19937_64 random_;
  bool differing_, own_models_;
  SystemBuilder builder_;
  std::uint32_t subsystems_ = 0, strict_ = 3;
  Numbered<spec::InstanceId, std::vector<spec::ChannelId>> sends_, receives_;
  Numbered<spec::ChannelId, bool> waits_to_be_sent_;
};

}  // namespace

spec::Model random_system(std::uint64_t seed) { return RandomSystem(seed, {}).result(); }
spec::Model random_differing_system(std::uint64_t seed) {
  return RandomSystem(seed, {.differing = true}).result();
}
spec::Model random_system_of_own_models(std::uint64_t seed) {
  return RandomSystem(seed, {.own_models = true}).result();
}

}  // namespace tessera::test
