#include "net/net.hpp"

#include <algorithm>

namespace tessera::net {

std::string HierarchicalNet::path(PageId page) const {
  std::vector<const std::string*> names;
  for (PageId at = page; at.valid() && pages[at.value].parent.valid(); at = pages[at.value].parent)
    names.push_back(&pages[at.value].name);
  std::string text;
  for (auto name = names.rbegin(); name != names.rend(); ++name) {
    if (!text.empty()) text += '.';
    text += **name;
  }
  return text;
}

PageId HierarchicalNet::find(std::string_view path) const {
  if (pages.empty()) return {};
  PageId at{0};
  while (!path.empty()) {
    const std::string_view name = path.substr(0, path.find('.'));
    const auto& nodes = pages[at.value].nodes;
    const auto node = std::ranges::find_if(
        nodes, [&](const Node& candidate) { return candidate.page.valid() && candidate.name == name; });
    if (node == nodes.end()) return {};
    at = node->page;
    path.remove_prefix(std::min(path.size(), name.size() + 1));
  }
  return at;
}

PlaceId Net::add(Place place) {
  places_.push_back(std::move(place));
  return {static_cast<std::uint32_t>(places_.size() - 1)};
}

TransitionId Net::add(Transition transition, std::span<const Arc> inputs, std::span<const Arc> outputs) {
  for (const auto& arcs : {inputs, outputs}) {
    starts_.push_back(static_cast<std::uint32_t>(arcs_.size()));
    arcs_.insert(arcs_.end(), arcs.begin(), arcs.end());
  }
  transitions_.push_back(std::move(transition));
  return {static_cast<std::uint32_t>(transitions_.size() - 1)};
}

std::span<const Arc> Net::preset(TransitionId id) const {
  const std::size_t at = 2 * std::size_t{id.value};
  return {arcs_.data() + starts_[at], arcs_.data() + starts_[at + 1]};
}

std::span<const Arc> Net::postset(TransitionId id) const {
  const std::size_t at = 2 * std::size_t{id.value} + 1;
  const std::size_t end = at + 1 < starts_.size() ? starts_[at + 1] : arcs_.size();
  return {arcs_.data() + starts_[at], arcs_.data() + end};
}

ChannelId Net::channel_of(TransitionId id) const {
  for (const auto& arcs : {preset(id), postset(id)})
    for (const Arc& arc : arcs)
      if ((*this)[arc.place].fused()) return (*this)[arc.place].channel;
  return {};
}

}  // namespace tessera::net
