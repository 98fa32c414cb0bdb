#include "net/pnml_labels.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <system_error>
#include <utility>

#include "diagnostics/utf8.hpp"
#include "net/pnml_reader.hpp"

namespace tessera::net {
namespace {

using diagnostics::in_quotes;
using pugi::xml_node;

/// "[0,inf)", the interval of an arc of TAPAAL that any age satisfies.
bool is_any_time(std::string_view text) {
  std::string plain;
  for (const char c : text)
    if (c != ' ') plain += c;
  return plain == "[0,inf)";
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r\n") - begin + 1);
}

/// "Red,0,Blue,0": no token of these classes.
bool only_zeros(std::string_view text) {
  while (!text.empty()) {
    const std::size_t comma = text.find(',');
    if (comma == std::string_view::npos) return false;
    text.remove_prefix(comma + 1);
    const std::size_t end = std::min(text.find(','), text.size());
    if (trimmed(text.substr(0, end)) != "0") return false;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return true;
}

}  // namespace

bool PnmlLabels::is_read(PnmlOwner owner, const xml_node& node) {
  std::string value;
  if (PnmlVocabulary::has_value(owner, node)) {
    std::optional<Value> given = value_of(node);
    if (!given) return false;
    value = std::move(given->text);
  }
  return vocabulary_.is_read(owner, node, positions_.of(node), value);
}

std::string PnmlLabels::name(const xml_node& node) {
  const xml_node holder = child(node, "name");
  if (const xml_node text = child(holder, "text")) return text.text().get();
  if (const xml_node text = child(holder, "value")) return text.text().get();
  return holder ? "" : node.attribute("name").value();
}

std::optional<PnmlLabels::Value> PnmlLabels::value_of(const xml_node& holder) {
  vocabulary_.judge(PnmlOwner::label, holder, positions_.of(holder));
  std::optional<Value> value;
  std::size_t count = 0;
  if (const pugi::xml_attribute attribute = holder.attribute("value")) {
    value = {attribute.value(), positions_.of(holder)};
    ++count;
  }
  for (const xml_node part : holder.children()) {
    if (!is_read(PnmlOwner::label, part)) continue;
    const xml_node text = part.first_child();
    if (text && (text.next_sibling() || text.type() == pugi::node_element)) count = 2;
    value = {text.value(), positions_.of(text ? text : part)};
    ++count;
  }
  if (count == 1) return value;
  vocabulary_.refuse("E428", "no single value", positions_.of(holder),
                     in_quotes(holder.name()) + (count == 0 ? " has no value" : " has more than one value"),
                     "a value stands in a <text>");
  return std::nullopt;
}

std::uint32_t PnmlLabels::marking(const xml_node& place) {
  return number(place, "initialMarking", place.attribute("initialMarking"), "marking", 0, 0);
}

std::uint32_t PnmlLabels::weight(const xml_node& arc) {
  const pugi::xml_attribute given = arc.attribute("weight"), inscription = arc.attribute("inscription");
  const std::string_view text = inscription.value();
  const bool says_nothing =
      !inscription || is_any_time(text) || (given && (text == "1" || text == given.value()));
  if (says_nothing) return number(arc, "inscription", given, "weight", 1, 1);
  if (given) {
    vocabulary_.refuse("E428", "weight and inscription", positions_.of(arc),
                       "the weight " + in_quotes(given.value()) + " and the inscription " + in_quotes(text) +
                           " of an arc disagree",
                       "keep one");
    return 1;
  }
  return number(arc, "inscription", inscription, "weight", 1, 1);
}

bool PnmlLabels::is_plain(const xml_node& arc) {
  std::string kind = arc.attribute("type").value();
  for (const char* name : {"type", "arctype"})
    if (const xml_node type = child(arc, name)) {
      const std::optional<Value> value = value_of(type);
      if (!value) return false;
      if (trimmed(value->text) != "normal") kind = trimmed(value->text);
    }
  const std::string_view interval = arc.attribute("inscription").value();
  if (kind == "timed" && !is_any_time(interval)) {
    vocabulary_.refuse(
        "E429", "interval", positions_.of(arc),
        "the interval " + in_quotes(interval) + " of an arc: place/transition nets have no time",
        "without invariants and intervals it can be read");
    return false;
  }
  if (kind.empty() || kind == "normal" || kind == "timed") return true;
  vocabulary_.refuse_arc(kind, arc, positions_.of(arc));
  return false;
}

std::uint32_t PnmlLabels::number(const xml_node& owner, const char* label,
                                 const pugi::xml_attribute& attribute, const char* what,
                                 std::uint32_t missing, std::uint32_t least) {
  const xml_node holder = child(owner, label);
  if (holder && attribute)
    vocabulary_.refuse("E428", std::string("twice ") + label, positions_.of(holder),
                       in_quotes(label) + " is given twice to one " + std::string(name_of(owner)),
                       "keep one");
  std::optional<Value> value;
  if (holder)
    value = value_of(holder);
  else if (attribute)
    value = {attribute.value(), positions_.of(owner)};
  if (!value || (holder && is_any_time(value->text))) return missing;
  return whole_number(*value, what, missing, least);
}

std::uint32_t PnmlLabels::whole_number(const Value& given, const char* what, std::uint32_t missing,
                                       std::uint32_t least) {
  std::string_view digits = trimmed(given.text);
  for (std::size_t comma = digits.find(','); comma != std::string_view::npos; comma = digits.find(',')) {
    const std::string_view name = trimmed(digits.substr(0, comma)), rest = digits.substr(comma + 1);
    const std::size_t next = rest.find(',');
    const std::string_view count = trimmed(rest.substr(0, next));
    if (name.empty()) break;
    if (next == std::string_view::npos || count != "0") {
      if (count != "0") vocabulary_.judge_same("class of tokens", name, given.span);
      if (next != std::string_view::npos && !only_zeros(rest.substr(next + 1))) break;
      digits = count;
    } else {
      digits = rest.substr(next + 1);
    }
  }
  std::uint32_t value = 0;
  const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (problem == std::errc{} && end == digits.data() + digits.size() && value >= least &&
      value <= largest_pnml_number)
    return value;
  out_.error("E425", given.span,
             std::string(what) + " " + in_quotes(given.text) + " is not a whole number from " +
                 std::to_string(least) + " to " + std::to_string(largest_pnml_number));
  return missing;
}

}  // namespace tessera::net
