#pragma once

#include <string>

#include "net/net.hpp"

namespace tessera::test {

inline const std::string strange = "Q_";  ///< stands before each word of the layers in a renamed net

/// The net with another word in place of each that the layers write into a name: of places, transitions,
/// communication pages and states of channels. Names of the author stay: agents, subsystems, behaviours,
/// blocks and channels.
inline net::HierarchicalNet renamed(net::HierarchicalNet net) {
  const auto block_of = [&](net::BlockId block) {
    return block.valid() ? net.parts[block].name + "." : std::string();
  };
  const auto rename = [&](std::string& name, const std::string& kept) {
    if (name.starts_with(kept)) name.insert(kept.size(), strange);
  };
  for (net::Page& page : net.pages) {
    if (page.layer == net::Layer::communication) page.name.insert(0, strange);
    for (net::Node& node : page.nodes) {
      if (!node.page.valid()) rename(node.name, block_of(node.block));
      if (node.page.valid() && net.pages[node.page.value].layer == net::Layer::communication)
        node.name.insert(0, strange);
    }
    for (net::PageTransition& transition : page.transitions)
      rename(transition.name, block_of(transition.block));
  }
  for (net::FusionSet& set : net.fusions) rename(set.name, net.parts[set.channel] + ".");
  return net;
}

/// A text without the strange words, and without what follows from longer names: spaces and new lines.
inline std::string without_strange_words(const std::string& text) {
  std::string bare;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text.compare(at, strange.size(), strange) == 0) at += strange.size();
    if (at < text.size() && text[at] != ' ' && text[at] != '\n') bare += text[at];
  }
  return bare;
}

}  // namespace tessera::test
