#include "language/questions/place.hpp"

namespace tessera::language {
namespace {

bool find_place(const Node& node, std::size_t offset, const Node* parent, PlaceInText& place) {
  if (node.is_scalar()) {
    if (!node.extent.touches(offset)) return false;
    place.scalar = &node;
    place.parent = parent;
    return true;
  }
  for (const Entry& entry : node.parts()) {
    if (node.is_map() && entry.extent.touches(offset)) {
      place.key = &entry;
      place.parent = &node;
      return true;
    }
    if (!entry.value->extent.touches(offset)) continue;
    place.way.push_back(entry.key);
    if (find_place(*entry.value, offset, &node, place)) return true;
    place.way.pop_back();
  }
  return false;
}

}  // namespace

std::optional<PlaceInText> place_at(const Outline& outline, std::size_t offset) {
  PlaceInText place;
  if (!find_place(outline.root(), offset, nullptr, place)) return std::nullopt;
  return place;
}

const Node& node_at(const Outline& outline, const Way& way) {
  static const Node nothing{};
  const Node* node = &outline.root();
  for (const std::string& step : way) {
    if (step.empty()) return nothing;
    node = &(*node)[step];
  }
  return *node;
}

}  // namespace tessera::language
