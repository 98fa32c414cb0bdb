#include "layers/sheet.hpp"

#include <utility>

#include "layers/built_in.hpp"
#include "tessera/net_words.hpp"

namespace tessera::layers {

Draft::Draft(const spec::Model& specification)
    : model(specification), wiring(specification), memory(specification.channels.size()) {
  for (const spec::Agent& agent : model.agents) net.parts.agents.push_back(agent.path);
  for (const spec::InstanceId instance : model.instances.ids()) {
    net::Parts::Subsystem& part = net.parts.subsystems.emplace_back();
    part.path = model.instance_path(instance);
    part.agent = model.instances[instance].agent;
    for (const spec::Behaviour& behaviour : model.subsystem(instance).behaviours)
      part.behaviours.push_back(behaviour.name);
  }
  for (const spec::Channel& channel : model.channels)
    net.parts.channels.push_back(model.channel_name(channel));
  const Numbered<spec::ChannelId, bool> used = wiring.used_channels();
  for (const spec::ChannelId id : model.channels.ids()) {
    if (!used[id]) continue;
    const spec::Channel& channel = model.channels[id];
    const std::string& name = net.parts[id];
    for (const spec::SharedPlace& place : model_of(model, channel).shared) {
      memory[id].push_back({static_cast<std::uint32_t>(net.fusions.size())});
      net.fusions.push_back({name + "." + place.name, place.tokens, id, channel.span, role_of(place)});
    }
  }
  facts.reserve(model.instances.size());
  for (const spec::InstanceId instance : model.instances.ids())
    facts.push_back(KnownFacts(model, wiring, instance, net));
}

Sheet::Sheet(Draft& draft, net::PageId parent, net::Layer layer, std::string name, net::SubsystemId subsystem,
             net::Span span)
    : draft_(draft), id_{static_cast<std::uint32_t>(draft.net.pages.size())} {
  draft_.net.pages.emplace_back();
  page_.name = std::move(name);
  page_.layer = layer;
  page_.parent = parent;
  page_.subsystem = subsystem;
  if (subsystem.valid()) page_.agent = draft.net.parts[subsystem].agent;
  page_.span = span;
}

std::uint32_t Sheet::place(std::string_view name, net::Operation operation, PlaceRole role) {
  page_.nodes.push_back({.name = std::string(name), .operation = operation, .role = role, .block = block_});
  return static_cast<std::uint32_t>(page_.nodes.size() - 1);
}

std::uint32_t Sheet::input(net::Operation operation, std::uint32_t tokens) {
  const std::uint32_t node = place(words::input, operation, PlaceRole::input);
  page_.nodes[node].tokens = tokens;
  return node;
}

std::uint32_t Sheet::output() { return place(words::output, {}, PlaceRole::output); }

std::uint32_t Sheet::page(net::PageId page) {
  const std::uint32_t node = place(draft_.net.pages[page.value].name);
  page_.nodes[node].page = page;
  return node;
}

std::uint32_t Sheet::fused(std::string_view name, net::FusionId set) {
  const std::uint32_t node = place(name, {}, draft_.net.fusions[set.value].role);
  page_.nodes[node].tokens = draft_.net.fusions[set.value].tokens;
  page_.nodes[node].fusion = set;
  fused_.try_emplace(set.value, node);
  return node;
}

std::uint32_t Sheet::member(std::string_view name, net::FusionId set) {
  if (const auto known = fused_.find(set.value); known != fused_.end()) return known->second;
  const net::BlockId block = std::exchange(block_, net::BlockId{});
  const std::uint32_t node = fused(name, set);
  block_ = block;
  return node;
}

net::PageTransition& Sheet::transition(std::string_view name, std::vector<std::uint32_t> inputs,
                                       std::vector<std::uint32_t> outputs, net::Condition condition) {
  return page_.transitions.emplace_back(net::PageTransition{.name = std::string(name),
                                                            .inputs = std::move(inputs),
                                                            .outputs = std::move(outputs),
                                                            .condition = std::move(condition),
                                                            .span = page_.span,
                                                            .block = block_});
}

net::PageId Sheet::finish(std::uint32_t input, std::uint32_t output) {
  page_.input = input;
  page_.output = output;
  draft_.net.pages[id_.value] = std::move(page_);
  return id_;
}

}  // namespace tessera::layers
