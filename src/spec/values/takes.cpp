#include "spec/values/takes.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "diagnostics/utf8.hpp"
#include "spec/document/section.hpp"
#include "spec/values/quantities.hpp"
#include "tessera/nearest.hpp"
#include "tessera/units.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

constexpr const char* normal_hint = "for example takes: { normal: [2 ms, 0.3 ms], within: 1..3 ms }";
constexpr const char* uses_hint = "for example 12 W, 3 MB/s or 5 /min";
constexpr const char* most_hint = "for example at_most: { energy: 200 J }";
constexpr double largest_use = 1e15;

std::optional<Takes> read_normal(const Entry& normal, const Takes& within, Diagnostics& out) {
  const std::vector<const Node*>& numbers = items_of(*normal.value, normal.span, "'normal'", out);
  if (!normal.value->is_sequence()) return std::nullopt;
  if (numbers.size() != 2) {
    out.error("E384", normal.span, "a normal distribution has a mean and a standard deviation", normal_hint);
    return std::nullopt;
  }
  const auto mean = read_duration(*numbers[0], normal.span, "the mean", out);
  const auto deviation = read_duration(*numbers[1], normal.span, "the standard deviation", out);
  if (!mean || !deviation) return std::nullopt;
  if (*mean < within.shortest || *mean > within.longest) {
    out.error("E384", numbers[0]->span,
              "the mean " + in_quotes(numbers[0]->text) + " lies outside of 'within'",
              "the times are those of the normal distribution that lie within; widen 'within', or give the "
              "recording of a run: { measured: run.tsr, within: ... }");
    return std::nullopt;
  }
  Takes takes = within;
  if (within.shortest < within.longest)
    takes.points = normal_points(*mean, *deviation, within.shortest, within.longest);
  return takes;
}

std::optional<Takes> read_measured(const Entry& measured, const std::optional<Takes>& within,
                                   Diagnostics& out) {
  const Node* file = text_of(*measured.value, measured.span, "'measured'", out,
                             "name the recording of a run, relative to the specification");
  if (file == nullptr) return std::nullopt;
  Takes takes = within.value_or(Takes{Duration{1}, Duration{1}});
  takes.measured = Takes::Measured{file->text, file->span, within.has_value()};
  return takes;
}

/// Units of power, which is energy per time.
struct PowerUnit {
  std::string_view name;
  double watts;
};
/// Units of energy.
struct EnergyUnit {
  std::string_view name;
  double joules;
};
constexpr std::array energy_units = {EnergyUnit{"J", 1},      EnergyUnit{"mJ", 1e-3}, EnergyUnit{"kJ", 1e3},
                                     EnergyUnit{"MJ", 1e6},   EnergyUnit{"mWh", 3.6}, EnergyUnit{"Wh", 3600},
                                     EnergyUnit{"kWh", 3.6e6}};
constexpr std::array power_units = {PowerUnit{"W", 1}, PowerUnit{"mW", 1e-3}, PowerUnit{"kW", 1e3}};

/// "MB/s": in MB, per second. false: it is no amount per time.
bool take_unit(std::string_view unit, ResourceUse& use) {
  for (const PowerUnit& power : power_units)
    if (unit == power.name) {
      use.unit = "J";
      use.per_second *= power.watts;
      return true;
    }
  const std::size_t slash = unit.rfind('/');
  if (slash == std::string_view::npos) return false;
  const std::optional<double> seconds = converted(1, unit.substr(slash + 1), "s");
  if (!seconds) return false;
  std::string_view amount = unit.substr(0, slash);
  while (amount.ends_with(' ')) amount.remove_suffix(1);
  use.unit = std::string(amount);
  use.per_second /= *seconds;
  return true;
}

/// A number with a unit; nullopt after an error.
std::optional<Quantity> read_amount(const Entry& entry, const std::string& what, const char* hint,
                                    const Node*& text, Diagnostics& out) {
  text = text_of(*entry.value, entry.span, what, out, hint);
  if (text == nullptr) return std::nullopt;
  const auto quantity = split_quantity(text->text);
  if (!quantity)
    out.error("E205", text->span, what + " must be a number with a unit, not " + in_quotes(text->text), hint);
  return quantity;
}

std::string in_unit(const std::string& unit) {
  return unit.empty() ? "without a unit" : "in " + in_quotes(unit);
}

std::optional<ResourceUse> read_use(const Entry& entry, Diagnostics& out) {
  const std::string what = "the use of " + in_quotes(entry.key);
  const Node* text = nullptr;
  const auto quantity = read_amount(entry, what, uses_hint, text, out);
  if (!quantity) return std::nullopt;
  ResourceUse use{entry.key, {}, quantity->number, entry.span};
  if (!take_unit(quantity->unit, use)) {
    out.error("E386", text->span, what + " must be an amount per time, not " + in_quotes(text->text),
              uses_hint);
    return std::nullopt;
  }
  if (use.per_second < 0 || use.per_second > largest_use) {
    out.error("E206", text->span, what + " must lie between 0 and 1e15 per second");
    return std::nullopt;
  }
  return use;
}

}  // namespace

std::optional<Takes> read_takes(const Node& node, Span at, Diagnostics& out) {
  if (!node.is_map()) return read_time_range(node, at, out);
  const Section section(node, at, "'takes'", {"normal", "measured", "within"}, out);
  const Entry *normal = section.find("normal"), *measured = section.find("measured");
  const Entry* within = section.find("within");
  const std::optional<Takes> range =
      within == nullptr ? std::nullopt : read_time_range(*within->value, within->span, out);
  if (within != nullptr && !range) return std::nullopt;
  if (normal != nullptr && measured != nullptr) {
    out.error("E107", measured->span, "'measured' beside 'normal'", "keep one of them");
    return std::nullopt;
  }
  if (measured != nullptr) return read_measured(*measured, range, out);
  if (normal == nullptr) {
    if (!section.has_unknown_keys())
      out.error("E103", at, "'takes' must say normal or measured, or be a time such as 1..3 ms", normal_hint);
    return std::nullopt;
  }
  if (section.require("within", normal_hint) == nullptr) return std::nullopt;
  return read_normal(*normal, *range, out);
}

std::vector<ResourceUse> read_uses(const Entry* entry, Diagnostics& out) {
  std::vector<ResourceUse> uses;
  if (entry == nullptr) return uses;
  for (const Entry& one : entries_of(*entry->value, entry->span, "uses", out))
    if (std::optional<ResourceUse> use = read_use(one, out)) uses.push_back(*std::move(use));
  return uses;
}

std::optional<UseCheck> read_most_use(const Entry& entry, Diagnostics& out) {
  const std::string what = "the most " + in_quotes(entry.key);
  const Node* text = nullptr;
  const auto quantity = read_amount(entry, what, most_hint, text, out);
  if (!quantity) return std::nullopt;
  UseCheck check{{}, entry.key, std::string(quantity->unit), quantity->number, entry.span};
  for (const EnergyUnit& energy : energy_units)
    if (quantity->unit == energy.name) {
      check.unit = "J";
      check.most *= energy.joules;
    }
  if (check.most < 0 || check.most > largest_use) {
    out.error("E206", text->span, what + " must lie between 0 and 1e15");
    return std::nullopt;
  }
  return check;
}

void check_uses(const Model& model, Diagnostics& out) {
  std::map<std::string, const ResourceUse*> first;
  for (const Definition& definition : model.definitions)
    for (const Subsystem& subsystem : definition.subsystems)
      for (const Behaviour& behaviour : subsystem.behaviours)
        for (const ResourceUse& use : behaviour.uses) {
          const ResourceUse& other = *first.try_emplace(use.resource, &use).first->second;
          if (other.unit != use.unit)
            out.error("E386", use.span,
                      in_quotes(use.resource) + " is counted " + in_unit(use.unit) + " here, and " +
                          in_unit(other.unit) + " in line " + std::to_string(other.span.line),
                      "amounts of one unit can be added; write the same unit in both");
        }
  if (!model.simulation) return;
  std::vector<std::string> known;
  for (const auto& [name, use] : first) known.push_back(name);
  for (const UseCheck& check : model.simulation->use_checks) {
    const auto use = first.find(check.resource);
    if (use == first.end()) {
      Hint hint = did_you_mean(check.resource, known);
      if (hint.empty()) hint = "a behaviour says what it uses: uses: { " + check.resource + ": 12 W }";
      out.error("E386", check.span, "no behaviour uses " + in_quotes(check.resource), std::move(hint));
    } else if (use->second->unit != check.unit) {
      out.error("E386", check.span,
                in_quotes(check.resource) + " is counted " + in_unit(use->second->unit) + " in line " +
                    std::to_string(use->second->span.line) + ", not " + in_unit(check.unit),
                "write the most " + in_unit(use->second->unit));
    }
  }
}

std::vector<Resource> resources_of(const Model& model) {
  std::vector<Resource> all;
  for (const Definition& definition : model.definitions)
    for (const Subsystem& subsystem : definition.subsystems)
      for (const Behaviour& behaviour : subsystem.behaviours)
        for (const ResourceUse& use : behaviour.uses)
          if (std::ranges::find(all, use.resource, &Resource::name) == all.end())
            all.push_back({use.resource, use.unit});
  return all;
}

}  // namespace tessera::spec
