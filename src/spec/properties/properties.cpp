#include "spec/properties/properties.hpp"

#include <array>
#include <optional>
#include <unordered_map>

#include "diagnostics/utf8.hpp"
#include "spec/document/section.hpp"
#include "spec/properties/property_claims.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

constexpr std::array property_kinds{Property::Kind::never, Property::Kind::always, Property::Kind::reachable,
                                    Property::Kind::always_reachable, Property::Kind::leads_to};
constexpr const char* property_hint =
    "for example { name: motors can always run, always_reachable: robot.motor.drive }";

/// The text of a property: one formula, or two of leads_to.
struct Text {
  std::string text;
  std::optional<Formula> what, then;
};

std::optional<Formula> whole(const Node* text, Diagnostics& out) {
  return text == nullptr ? std::nullopt : read_formula(*text, 0, text->text.size(), out);
}

/// "a => b", written so or as a list of two.
Text read_leads_to(const Entry& entry, Diagnostics& out) {
  const Node& value = *entry.value;
  constexpr const char* hint = "write [A, B] or A => B";
  if (value.is_sequence()) {
    if (value.items.size() != 2) {
      out.error("E104", entry.span, "leads_to must be two texts", hint);
      return {};
    }
    const Node* from = text_of(*value.items[0], entry.span, "leads_to", out);
    const Node* to = text_of(*value.items[1], entry.span, "leads_to", out);
    if (from == nullptr || to == nullptr) return {};
    return {from->text + " => " + to->text, whole(from, out), whole(to, out)};
  }
  const Node* text = text_of(value, entry.span, in_quotes(entry.key), out, property_hint);
  if (text == nullptr) return {};
  const std::size_t arrow = text->text.find("=>");
  if (arrow == std::string::npos) {
    out.error("E104", text->span, "leads_to needs two sides", hint);
    return {text->text, {}, {}};
  }
  return {text->text, read_formula(*text, 0, arrow, out),
          read_formula(*text, arrow + 2, text->text.size() - arrow - 2, out)};
}

Text read_text(const Entry& entry, Diagnostics& out) {
  if (entry.key == "leads_to") return read_leads_to(entry, out);
  const Node* text = text_of(*entry.value, entry.span, in_quotes(entry.key), out, property_hint);
  return {text == nullptr ? std::string() : text->text, whole(text, out), {}};
}

std::optional<Property> read_property(const Node& node, Span at, const PathLookup& lookup, Diagnostics& out) {
  const Section section(node, at, "a property",
                        {"name", "never", "always", "reachable", "always_reachable", "leads_to"}, out);
  std::optional<Property> property;
  for (const Property::Kind kind : property_kinds) {
    const Entry* entry = section.find(name_of(kind));
    if (entry == nullptr) continue;
    if (property) {
      out.error("E107", entry->span, "a property has one kind",
                "keep one of " + std::string(name_of(property->kind)) + ", " + entry->key);
    }
    property.emplace();
    property->kind = kind;
    property->span = entry->span;
    Text text = read_text(*entry, out);
    property->text = text.text;
    property->name = entry->key + " " + text.text;
    if (text.what && (text.then || kind != Property::Kind::leads_to))
      property->claims = read_claims(*text.what, text.then, lookup, out);
  }
  if (!property && section.readable() && !section.has_unknown_keys())
    out.error("E103", at, "a property needs a kind", property_hint);
  const Entry* name = section.find("name");
  const Node* text = name == nullptr ? nullptr : text_of(*name->value, name->span, "a name", out);
  if (property && text != nullptr) property->name = text->text;
  return property;
}

}  // namespace

std::vector<Property> read_properties(const Entry* entry, const Model& model, const AgentGroups& groups,
                                      Diagnostics& out) {
  std::vector<Property> properties;
  if (entry == nullptr) return properties;
  const PathLookup lookup(model, groups);
  std::unordered_map<std::string, std::uint32_t> lines;
  for (const Node* item : items_of(*entry->value, entry->span, "properties", out)) {
    std::optional<Property> property =
        read_property(*item, item->is_null() ? entry->span : item->span, lookup, out);
    if (!property) continue;
    const auto [first, added] = lines.emplace(property->name, property->span.line);
    if (!added) {
      out.error("E107", property->span, "property " + in_quotes(property->name) + " exists already",
                "the first is on " + out.words(first->second));
    }
    properties.push_back(std::move(*property));
  }
  return properties;
}

}  // namespace tessera::spec
