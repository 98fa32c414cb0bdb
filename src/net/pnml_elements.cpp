#include "net/pnml_elements.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>

#include "net/pnml_vocabulary.hpp"

namespace tessera::net {

std::string_view name_of(const pugi::xml_node& node) { return local_name(node.name()); }

pugi::xml_node child(const pugi::xml_node& node, std::string_view name) {
  for (const pugi::xml_node candidate : node.children())
    if (name_of(candidate) == name) return candidate;
  return {};
}

PnmlPositions::PnmlPositions(std::string_view text) : size_(text.size()) {
  for (std::size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n', end + 1))
    starts_.push_back(end + 1);
}

diagnostics::Span PnmlPositions::at(std::ptrdiff_t offset, std::size_t length) const {
  if (offset < 0) return {};
  const std::size_t position = std::min(static_cast<std::size_t>(offset), size_);
  const auto line = std::prev(std::ranges::upper_bound(starts_, position));
  return {static_cast<std::uint32_t>(line - starts_.begin() + 1),
          static_cast<std::uint32_t>(position - *line + 1),
          static_cast<std::uint32_t>(std::max<std::size_t>(1, length))};
}

diagnostics::Span PnmlPositions::of(const pugi::xml_node& node) const {
  const bool element = node.type() == pugi::node_element;
  return at(node.offset_debug(),
            element ? std::string_view(node.name()).size() : std::string_view(node.value()).size());
}

}  // namespace tessera::net
