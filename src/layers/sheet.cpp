#include "layers/sheet.hpp"

#include <utility>

#include "layers/built_in.hpp"

namespace tessera::layers {

Draft::Draft(const spec::Model& specification)
    : model(specification), wiring(specification), memory(specification.channels.size()) {
  const std::vector<bool> used = wiring.used_channels();
  for (spec::Index index = 0; index < model.channels.size(); ++index) {
    if (!used[index]) continue;
    const spec::Channel& channel = model.channels[index];
    const std::string name = model.channel_name(channel);
    for (const spec::SharedPlace& place : model_of(model, channel).shared) {
      memory[index].push_back({static_cast<std::uint32_t>(net.fusions.size())});
      net.fusions.push_back({name + "." + place.name, place.tokens, index, channel.span});
    }
  }
}

Sheet::Sheet(Draft& draft, net::PageId parent, net::Layer layer, std::string name, std::uint32_t subsystem,
             net::Span span)
    : draft_(draft), id_{static_cast<std::uint32_t>(draft.net.pages.size())} {
  draft_.net.pages.emplace_back();
  page_.name = std::move(name);
  page_.layer = layer;
  page_.parent = parent;
  page_.subsystem = subsystem;
  page_.span = span;
}

std::uint32_t Sheet::place(std::string name, net::Operation operation, std::uint32_t tokens) {
  page_.nodes.push_back(
      {.name = std::move(name), .page = {}, .fusion = {}, .tokens = tokens, .operation = operation});
  return static_cast<std::uint32_t>(page_.nodes.size() - 1);
}

std::uint32_t Sheet::page(net::PageId page) {
  const std::uint32_t node = place(draft_.net.pages[page.value].name);
  page_.nodes[node].page = page;
  return node;
}

std::uint32_t Sheet::fused(std::string name, net::FusionId set) {
  const std::uint32_t node = place(std::move(name), {}, draft_.net.fusions[set.value].tokens);
  page_.nodes[node].fusion = set;
  return node;
}

void Sheet::transition(std::string name, std::vector<std::uint32_t> inputs,
                       std::vector<std::uint32_t> outputs, net::Condition condition) {
  transition(std::move(name), std::move(inputs), std::move(outputs), std::move(condition), page_.span);
}

void Sheet::transition(std::string name, std::vector<std::uint32_t> inputs,
                       std::vector<std::uint32_t> outputs, net::Condition condition, net::Span span) {
  page_.transitions.push_back(
      {std::move(name), std::move(inputs), std::move(outputs), std::move(condition), span});
}

net::PageId Sheet::finish(std::uint32_t input, std::uint32_t output) {
  page_.input = input;
  page_.output = output;
  draft_.net.pages[id_.value] = std::move(page_);
  return id_;
}

}  // namespace tessera::layers
