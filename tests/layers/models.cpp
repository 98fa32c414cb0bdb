#include "layers/models.hpp"

#include <algorithm>
#include <random>
#include <stdexcept>
#include <utility>

#include "layers/layers.hpp"
#include "net/flatten.hpp"

namespace tessera::test {

using namespace std::chrono_literals;
using spec::Mode;

spec::Behaviour behaviour(std::string name) {
  spec::Behaviour made;
  made.name = std::move(name);
  made.next.emplace_back();
  return made;
}

spec::Behaviour behaviour(std::string name, spec::BehaviourId next) {
  spec::Behaviour made = behaviour(std::move(name));
  made.next.front().behaviour = next;
  made.next_given = true;
  return made;
}

spec::Subsystem subsystem(spec::SubsystemKind kind, std::string name, const std::vector<std::string>& inputs,
                          const std::vector<std::string>& outputs, std::vector<spec::Behaviour> behaviours) {
  spec::Subsystem made;
  made.kind = kind;
  made.name = std::move(name);
  made.period = 50ms;
  for (const std::string& input : inputs) made.inputs.push_back({input, {}, {}, {}});
  for (const std::string& output : outputs) made.outputs.push_back({output, {}, {}, {}});
  made.behaviours = std::move(behaviours);
  return made;
}

spec::InstanceId ModelBuilder::agent(std::string path, std::vector<spec::Subsystem> subsystems) {
  spec::Definition definition;
  definition.name = path;
  definition.subsystems = std::move(subsystems);
  model_.definitions.push_back(std::move(definition));
  return enlist(std::move(path));
}

spec::InstanceId ModelBuilder::again(std::string path) { return enlist(std::move(path)); }

spec::InstanceId ModelBuilder::enlist(std::string path) {
  spec::Agent agent;
  agent.path = std::move(path);
  agent.definition = {static_cast<std::uint32_t>(model_.definitions.size() - 1)};
  agent.first_instance = model_.instances.next_id();
  for (const spec::DefinedSubsystemId part : model_.definitions.back().subsystems.ids())
    model_.instances.push_back({model_.agents.next_id(), part});
  model_.agents.push_back(agent);
  return agent.first_instance;
}

spec::Channel& ModelBuilder::channel(spec::ChannelEnd from, spec::ChannelEnd to) {
  spec::Channel channel;
  channel.from = from;
  channel.to = to;
  model_.channels.push_back(channel);
  return model_.channels.back();
}

namespace {

std::vector<spec::Subsystem> follower() {
  spec::Behaviour init = behaviour("init", {1});
  init.terminal.kind = spec::Condition::Kind::always;
  return {
      subsystem(spec::SubsystemKind::control, "control", {"line"}, {"motion"}, {init, behaviour("follow")}),
      subsystem(spec::SubsystemKind::receptor, "sensor", {}, {"line"}, {behaviour("watch")}),
      subsystem(spec::SubsystemKind::effector, "motor", {"velocity"}, {}, {behaviour("drive")}),
  };
}

void join_follower(ModelBuilder& builder, spec::InstanceId control) {
  const spec::InstanceId sensor{control.value + 1}, motor{control.value + 2};
  builder.channel({sensor, {0}}, {control, {0}});
  spec::Channel& motion = builder.channel({control, {0}}, {motor, {0}});
  motion.receive = Mode::blocking;
  motion.receive_timeout = 200ms;
}

}  // namespace

spec::Model line_follower() {
  ModelBuilder builder;
  join_follower(builder, builder.agent("robot", follower()));
  return builder.result();
}

spec::Model fleet(std::uint32_t count) {
  ModelBuilder builder;
  for (std::uint32_t number = 0; number < count; ++number) {
    const std::string path = "robot[" + std::to_string(number) + "]";
    join_follower(builder, number == 0 ? builder.agent(path, follower()) : builder.again(path));
  }
  return builder.result();
}

spec::Model pair(const std::vector<Modes>& channels, spec::Transfer transfer) {
  std::vector<std::string> outputs, inputs;
  for (std::size_t number = 1; number <= channels.size(); ++number) {
    outputs.push_back("y" + std::to_string(number));
    inputs.push_back("x" + std::to_string(number));
  }
  spec::Behaviour give = behaviour("give"), take = behaviour("take");
  give.transfer = take.transfer = transfer;
  ModelBuilder builder;
  builder.agent("a", {subsystem(spec::SubsystemKind::control, "control", {}, outputs, {give}),
                      subsystem(spec::SubsystemKind::effector, "motor", inputs, {}, {take})});
  for (std::uint32_t index = 0; index < channels.size(); ++index) {
    spec::Channel& channel = builder.channel({{0}, {index}}, {{1}, {index}});
    channel.send = channels[index].send;
    channel.receive = channels[index].receive;
    if (channels[index].send_timeout) channel.send_timeout = 1500ms;
    if (channels[index].receive_timeout) channel.receive_timeout = 2s;
  }
  return builder.result();
}

namespace {

class RandomModel {
 public:
  explicit RandomModel(std::uint32_t seed) : random_(seed), skips_(seed + 1) {}

  spec::Model result() {
    const std::uint32_t agents = between(1, 3);
    for (std::uint32_t agent = 0; agent < agents; ++agent) {
      std::vector<spec::Subsystem> subsystems;
      const std::uint32_t count = between(1, 3);
      for (std::uint32_t index = 0; index < count; ++index) subsystems.push_back(any_subsystem(index));
      spec::InstanceId instance = builder_.agent("a" + std::to_string(agent), subsystems);
      for (const spec::Subsystem& made : subsystems) {
        for (const spec::BufferId output : made.outputs.ids()) outputs_.push_back({instance, output});
        for (const spec::BufferId input : made.inputs.ids()) inputs_.push_back({instance, input});
        ++instance.value;
      }
    }
    for (const spec::ChannelEnd& input : inputs_) join(input);
    return builder_.result();
  }

 private:
  std::uint32_t between(std::uint32_t low, std::uint32_t high) {
    return std::uniform_int_distribution<std::uint32_t>(low, high)(random_);
  }
  bool coin() { return between(0, 1) == 1; }

  spec::Subsystem any_subsystem(std::uint32_t index) {
    const std::vector<std::string> names{"p", "q", "r"};
    std::vector<std::string> inputs(names.begin(), names.begin() + between(0, 3));
    std::vector<std::string> outputs(names.begin(), names.begin() + between(0, 3));
    const std::uint32_t count = between(1, 3);
    std::vector<spec::Behaviour> behaviours;
    for (std::uint32_t number = 0; number < count; ++number) {
      spec::Behaviour made = behaviour("b" + std::to_string(number));
      made.next.clear();
      for (std::uint32_t entry = between(1, 3); entry > 0; --entry) made.next.push_back(any_next(count));
      if (coin()) made.send = some(outputs.size());
      if (coin()) made.receive = some(inputs.size());
      if (coin()) made.transfer = spec::Transfer::parallel;
      for (std::uint32_t output = 0; output < outputs.size(); ++output)
        if (skips_() % 4 == 0) made.skippable.push_back({.output = {output}, .by_function = true});
      behaviours.push_back(std::move(made));
    }
    spec::Subsystem made =
        subsystem(spec::SubsystemKind::receptor, "s" + std::to_string(index), inputs, outputs, behaviours);
    made.receive_first = between(0, 3) == 0;
    return made;
  }

  spec::Next any_next(std::uint32_t behaviours) {
    spec::Next next;
    if (coin()) next.behaviour = {between(0, behaviours - 1)};
    if (coin()) next.when.kind = spec::When::Kind::error;
    return next;
  }

  std::vector<spec::BufferId> some(std::size_t buffers) {
    std::vector<spec::BufferId> list;
    for (const spec::BufferId buffer : Ids<spec::BufferId>(buffers))
      if (coin()) list.push_back(buffer);
    std::shuffle(list.begin(), list.end(), random_);
    return list;
  }

  void join(const spec::ChannelEnd& input) {
    if (outputs_.empty() || between(0, 9) == 0) return;
    spec::Channel& channel =
        builder_.channel(outputs_[between(0, static_cast<std::uint32_t>(outputs_.size() - 1))], input);
    if (coin()) channel.send = Mode::blocking;
    if (coin()) channel.receive = Mode::blocking;
    if (channel.send == Mode::blocking && coin()) channel.send_timeout = 10ms;
    if (channel.receive == Mode::blocking && coin()) channel.receive_timeout = 10ms;
  }

  std::mt19937 random_, skips_;
  ModelBuilder builder_;
  std::vector<spec::ChannelEnd> outputs_, inputs_;
};

}  // namespace

spec::Model random_model(std::uint32_t seed) { return RandomModel(seed).result(); }

Built build(const spec::Model& model) {
  diagnostics::Diagnostics complaints("model", "");
  auto pages = layers::build(model, complaints);
  auto flat = pages ? net::flatten(*pages, complaints) : std::nullopt;
  if (!flat) throw std::runtime_error(diagnostics::render(complaints));
  return {std::move(*pages), std::move(*flat)};
}

std::vector<std::string> transitions_of(const net::HierarchicalNet& net, const std::string& path) {
  const net::PageId id = net.find(path);
  if (!id.valid()) throw std::runtime_error("no page " + path);
  const net::Page& page = net.pages[id.value];
  const auto sum = [&](const std::vector<std::uint32_t>& ends) {
    std::string text;
    for (const std::uint32_t end : ends) text += (text.empty() ? "" : " + ") + page.nodes[end].name;
    return text;
  };
  std::vector<std::string> lines;
  for (const net::PageTransition& transition : page.transitions) {
    std::string line = transition.name + ": " + sum(transition.inputs) + " -> " + sum(transition.outputs);
    if (!transition.condition.text.empty()) line += " [" + transition.condition.text + "]";
    lines.push_back(std::move(line));
  }
  return lines;
}

std::vector<std::string> places_of(const net::HierarchicalNet& net, const std::string& path) {
  const net::PageId id = net.find(path);
  if (!id.valid()) throw std::runtime_error("no page " + path);
  std::vector<std::string> names;
  for (const net::Node& node : net.pages[id.value].nodes)
    if (!node.page.valid() && !node.fusion.valid()) names.push_back(node.name);
  return names;
}

}  // namespace tessera::test
