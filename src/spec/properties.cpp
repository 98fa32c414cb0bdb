#include <algorithm>
#include <array>
#include <unordered_map>

#include "diagnostics/utf8.hpp"
#include "spec/section.hpp"
#include "spec/simulation.hpp"

namespace tessera::spec {
namespace {

using diagnostics::quoted;

constexpr std::array kinds =
    std::to_array<std::string_view>({"never", "always", "reachable", "always_reachable", "leads_to"});
constexpr const char* property_hint =
    "for example { name: motors can always run, always_reachable: robot.motor.drive }";

/// "a => b", written so or as a list of two.
std::string read_text(const Entry& entry, Diagnostics& out) {
  const Node& value = *entry.value;
  const bool pair = entry.key == "leads_to" && value.is_sequence();
  if (pair && value.items.size() == 2) {
    const Node* from = text_of(*value.items[0], entry.span, "leads_to", out);
    const Node* to = text_of(*value.items[1], entry.span, "leads_to", out);
    return from == nullptr || to == nullptr ? std::string() : from->text + " => " + to->text;
  }
  if (pair) {
    out.error("E104", entry.span, "leads_to must be two texts", "write [A, B] or A => B");
    return {};
  }
  const Node* text = text_of(value, entry.span, quoted(entry.key), out, property_hint);
  if (text != nullptr && entry.key == "leads_to" && text->text.find("=>") == std::string::npos) {
    out.error("E104", text->span, "leads_to needs two sides", "write [A, B] or A => B");
  }
  return text == nullptr ? std::string() : text->text;
}

Property read_property(const Node& node, Span at, Diagnostics& out) {
  const Section section(node, at, "a property",
                        {"name", "never", "always", "reachable", "always_reachable", "leads_to"}, out);
  Property property;
  property.span = at;
  for (const std::string_view kind : kinds) {
    const Entry* entry = section.find(kind);
    if (entry == nullptr) continue;
    if (!property.kind.empty()) {
      out.error("E107", entry->span, "a property has one kind",
                "keep one of " + property.kind + ", " + entry->key);
    }
    property.kind = kind;
    property.text = read_text(*entry, out);
    property.span = entry->span;
  }
  if (property.kind.empty() && section.readable() && !section.has_unknown_keys())
    out.error("E103", at, "a property needs a kind", property_hint);
  property.name = property.kind + " " + property.text;
  if (const Entry* name = section.find("name")) {
    const Node* text = text_of(*name->value, name->span, "a name", out);
    if (text != nullptr) property.name = text->text;
  }
  return property;
}

}  // namespace

std::vector<Property> read_properties(const Entry* entry, Diagnostics& out) {
  std::vector<Property> properties;
  if (entry == nullptr) return properties;
  std::unordered_map<std::string, std::uint32_t> lines;
  for (const Node* item : items_of(*entry->value, entry->span, "properties", out)) {
    properties.push_back(read_property(*item, item->is_null() ? entry->span : item->span, out));
    const Property& last = properties.back();
    const auto [first, added] = lines.emplace(last.name, last.span.line);
    if (!added && !last.kind.empty()) {
      out.error("E107", last.span, "property " + quoted(last.name) + " exists already",
                "the first is on line " + std::to_string(first->second));
    }
  }
  return properties;
}

}  // namespace tessera::spec
