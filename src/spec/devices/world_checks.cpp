#include "spec/devices/world_checks.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "checks/parser.hpp"
#include "diagnostics/utf8.hpp"
#include "spec/document/section.hpp"
#include "spec/values/quantities.hpp"
#include "spec/values/takes.hpp"

namespace tessera::spec {
namespace {

using checks::Check;
using diagnostics::in_quotes;

constexpr std::array all_times{Check::When::never, Check::When::always, Check::When::at_end,
                               Check::When::eventually};
constexpr const char* check_hint =
    "for example { name: nobody touches, never: \"contact(robot[*], robot[*])\" }";

std::optional<checks::Unit> known_unit(std::string_view unit) {
  const auto one = in_si({.number = 1, .digits = "1", .unit = unit});
  return one ? std::optional(checks::Unit{one->number, one->unit}) : std::nullopt;
}

/// The formula or number of a text; nullopt after an error.
template <class T>
std::optional<T> parsed(const Node& text, checks::Parsed<T> (*parse)(std::string_view, const checks::Units&),
                        Diagnostics& out) {
  checks::Parsed<T> read = parse(text.text, known_unit);
  if (!read.value)
    out.error("E115", text.part(read.mistake.place.offset, read.mistake.place.length), read.mistake.text,
              read.mistake.hint);
  return std::move(read.value);
}

/// The one entry that says when the formula is to hold; nullptr after an error.
const Entry* claim_of(const Section& section, Span at, Check::When& when, Diagnostics& out) {
  const Entry* found = nullptr;
  for (const Check::When one : all_times) {
    const Entry* entry = section.find(checks::name_of(one));
    if (entry == nullptr) continue;
    if (found != nullptr) {
      out.error("E107", entry->span, in_quotes(entry->key) + " beside " + in_quotes(found->key),
                "write two checks");
      return nullptr;
    }
    found = entry;
    when = one;
  }
  if (found == nullptr && !section.has_unknown_keys())
    out.error("E103", at, "a check must say never, always, at_end, eventually or at_most", check_hint);
  return found;
}

std::optional<double> read_within(const Section& section, Check::When when, Diagnostics& out) {
  const Entry* entry = section.find("within");
  if (entry == nullptr) return std::nullopt;
  if (when != Check::When::eventually) {
    out.error("E102", entry->span, "only 'eventually' has a 'within'", "remove it");
    return std::nullopt;
  }
  const auto duration = read_duration(*entry->value, entry->span, "within", out);
  if (!duration) return std::nullopt;
  return std::chrono::duration<double>(*duration).count();
}

/// The name of a check, if it says one.
void read_name(const Section& section, std::string& name, Diagnostics& out) {
  const Entry* entry = section.find("name");
  if (entry == nullptr) return;
  if (const Node* words = text_of(*entry->value, entry->span, "the name", out)) name = words->text;
}

/// `{ name: battery, at_most: { energy: 200 J } }`.
std::optional<UseCheck> read_use_check(const Section& section, const Entry& at_most, Diagnostics& out) {
  for (const char* other : {"never", "always", "at_end", "eventually", "within"})
    if (const Entry* entry = section.find(other)) {
      out.error("E107", entry->span, in_quotes(other) + " beside 'at_most'", "write two checks");
      return std::nullopt;
    }
  const std::vector<Entry>& most = entries_of(*at_most.value, at_most.span, "at_most", out);
  if (!at_most.value->is_map()) return std::nullopt;
  if (most.size() != 1) {
    out.error("E107", at_most.span, "a check has one resource",
              "write a check for each, at_most: { energy: 200 J }");
    return std::nullopt;
  }
  std::optional<UseCheck> check = read_most_use(most.front(), out);
  if (!check) return std::nullopt;
  check->name = "at_most " + check->resource;
  read_name(section, check->name, out);
  return check;
}

std::optional<WorldCheck> read_world_check(const Section& section, Span at, Diagnostics& out) {
  WorldCheck check;
  const Entry* claim = claim_of(section, at, check.check.when, out);
  check.check.within_s = read_within(section, check.check.when, out);
  if (claim == nullptr) return std::nullopt;
  const Node* text = text_of(*claim->value, claim->span, in_quotes(claim->key), out, check_hint);
  if (text == nullptr) return std::nullopt;
  check.span = text->span;
  check.check.name = claim->key + " " + text->text;
  read_name(section, check.check.name, out);
  auto formula = parsed(*text, checks::parse_formula, out);
  if (!formula) return std::nullopt;
  check.check.formula = *std::move(formula);
  check.check.text = text->text;
  return check;
}

}  // namespace

void read_checks(const Entry* entry, Simulation& simulation, Diagnostics& out) {
  if (entry == nullptr) return;
  std::set<std::string> names;
  const auto is_new = [&](const std::string& name, Span span) {
    if (names.insert(name).second) return true;
    out.error("E308", span, "there is a check " + in_quotes(name) + " already", "give it another name");
    return false;
  };
  for (const Node* node : items_of(*entry->value, entry->span, "checks", out)) {
    const Section section(*node, node->span, "a check",
                          {"name", "never", "always", "at_end", "eventually", "within", "at_most"}, out);
    if (!section.readable()) continue;
    if (const Entry* at_most = section.find("at_most")) {
      auto one = read_use_check(section, *at_most, out);
      if (one && is_new(one->name, one->span)) simulation.use_checks.push_back(*std::move(one));
    } else {
      auto one = read_world_check(section, node->span, out);
      if (one && is_new(one->check.name, one->span)) simulation.checks.push_back(*std::move(one));
    }
  }
}

std::vector<WorldMeasure> read_world_measures(const Entry* entry, Diagnostics& out) {
  std::vector<WorldMeasure> all;
  if (entry == nullptr) return all;
  for (const Entry& one : entries_of(*entry->value, entry->span, "measures", out)) {
    const Node* text = text_of(*one.value, one.span, in_quotes(one.key), out,
                               "for example nearest: \"distance(robot[*], robot[*])\"");
    if (text == nullptr) continue;
    if (auto number = parsed(*text, checks::parse_number, out)) {
      const std::string unit = checks::unit_of(number->dimension);
      all.push_back({{one.key, *std::move(number), unit}, text->span});
    }
  }
  return all;
}

}  // namespace tessera::spec
