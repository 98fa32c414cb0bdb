#include "spec/devices/world_checks.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "checks/parser.hpp"
#include "diagnostics/utf8.hpp"
#include "spec/document/section.hpp"
#include "spec/values/quantities.hpp"

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
    out.error("E103", at, "a check must say never, always, at_end or eventually", check_hint);
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

std::optional<WorldCheck> read_check(const Node& node, Span at, Diagnostics& out) {
  const Section section(node, at, "a check", {"name", "never", "always", "at_end", "eventually", "within"},
                        out);
  if (!section.readable()) return std::nullopt;
  WorldCheck check;
  const Entry* claim = claim_of(section, at, check.check.when, out);
  check.check.within_s = read_within(section, check.check.when, out);
  if (claim == nullptr) return std::nullopt;
  const Node* text = text_of(*claim->value, claim->span, in_quotes(claim->key), out, check_hint);
  if (text == nullptr) return std::nullopt;
  check.span = text->span;
  check.check.name = claim->key + " " + text->text;
  if (const Entry* name = section.find("name")) {
    const Node* words = text_of(*name->value, name->span, "the name", out);
    if (words != nullptr) check.check.name = words->text;
  }
  auto formula = parsed(*text, checks::parse_formula, out);
  if (!formula) return std::nullopt;
  check.check.formula = *std::move(formula);
  check.check.text = text->text;
  return check;
}

}  // namespace

std::vector<WorldCheck> read_world_checks(const Entry* entry, Diagnostics& out) {
  std::vector<WorldCheck> all;
  if (entry == nullptr) return all;
  for (const Node* node : items_of(*entry->value, entry->span, "checks", out)) {
    auto one = read_check(*node, node->span, out);
    if (!one) continue;
    const bool taken = std::ranges::any_of(
        all, [&](const WorldCheck& other) { return other.check.name == one->check.name; });
    if (taken)
      out.error("E308", one->span, "there is a check " + in_quotes(one->check.name) + " already",
                "give it another name");
    else
      all.push_back(*std::move(one));
  }
  return all;
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
