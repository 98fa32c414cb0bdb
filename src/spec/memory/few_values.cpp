#include "spec/memory/few_values.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "diagnostics/utf8.hpp"
#include "spec/document/names.hpp"
#include "tessera/nearest.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

constexpr const char* values_hint = "for example { values: [nobody, a, b] }";
constexpr const char* counts_hint = "for example { counts: 0..4 }";
constexpr std::uint32_t largest_count = 9999;
constexpr std::size_t most_together = 4096;

/// Names that mean something else in a condition.
constexpr std::array condition_words =
    std::to_array<std::string_view>({"in", "out", "memory", "parameters", "elapsed", "index"});

void check_value(const Node& value, Diagnostics& out) {
  check_name(value.text, value.span, "value", out);
  if (std::ranges::find(condition_words, value.text) != condition_words.end())
    out.error("E106", value.span, "value " + in_quotes(value.text) + " is taken: conditions use this name");
}

/// "each robot" among the values: one for each member.
void add_members(const Node& text, const FleetSizes* fleets, FewValues& values, Diagnostics& out) {
  const auto members = read_each(text, 0, text.text.size(), fleets, out);
  if (!members) return;
  if (!values.fleet.empty()) {
    out.error("E290", text.span, "a memory cell has the members of one fleet as values",
              "use a second cell for the members of " + members->fleet);
    return;
  }
  values.fleet = members->fleet;
  values.first_member = static_cast<std::uint32_t>(values.names.size());
  values.member_count = members->count;
  for (std::uint32_t number = 0; number < members->count; ++number) {
    values.names.push_back(name_of_member(members->fleet, number));
    values.spans.push_back(text.span);
  }
}

FewValues read_values(const Entry& entry, const FleetSizes* fleets, Diagnostics& out) {
  FewValues values;
  std::unordered_map<std::string, std::uint32_t> lines;
  const std::size_t errors = out.error_count();
  for (const Node* item : items_of(*entry.value, entry.span, "values", out)) {
    const Node* text = text_of(*item, entry.span, "a value", out, values_hint);
    if (text == nullptr) continue;
    if (says_each(text->text)) {
      add_members(*text, fleets, values, out);
      continue;
    }
    check_value(*text, out);
    const auto [first, added] = lines.emplace(text->text, text->span.line);
    if (!added) {
      out.error("E107", text->span, "value " + in_quotes(text->text) + " is listed twice");
      continue;
    }
    values.names.push_back(text->text);
    values.spans.push_back(text->span);
  }
  if (out.error_count() == errors && values.names.size() < 2)
    out.error("E262", entry.span, "a memory cell needs at least two values", values_hint);
  if (values.names.empty()) values.names.emplace_back("nobody");
  if (!values.fleet.empty() && lines.contains(values.fleet))
    out.error("E107", entry.span, "value " + in_quotes(values.fleet) + " has the name of the fleet",
              "the values of 'each " + values.fleet + "' are " + values.fleet + "[0] and so on; rename it");
  if (values.names.size() - values.member_count > FewValues::most)
    out.error("E262", entry.span,
              "a memory cell of the net has at most " + std::to_string(FewValues::most) + " values, not " +
                  std::to_string(values.names.size()),
              "give it a type: { type: uint32 }; conditions over it are then free choices for the proof");
  return values;
}

std::optional<std::uint32_t> number_in(std::string_view text) {
  std::uint32_t number = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (text.empty() || error != std::errc() || stop != end || number > largest_count) return std::nullopt;
  return number;
}

FewValues read_counts(const Entry& entry, Diagnostics& out) {
  FewValues values;
  values.counts = true;
  std::uint32_t last = 1;
  if (const Node* text = text_of(*entry.value, entry.span, "counts", out, counts_hint)) {
    const std::string_view range = text->text;
    const std::size_t dots = range.find("..");
    const auto from = number_in(range.substr(0, dots));
    const auto to = dots == std::string_view::npos ? std::nullopt : number_in(range.substr(dots + 2));
    if (!from || !to) {
      out.error("E262", text->span, in_quotes(range) + " is not a range of counts",
                std::string(counts_hint) + "; the numbers are 0 to " + std::to_string(largest_count));
    } else if (*to <= *from) {
      out.error("E262", text->span, "a counter needs at least two counts",
                *to < *from ? "write " + std::to_string(*to) + ".." + std::to_string(*from) : counts_hint);
    } else if (*to - *from >= FewValues::most) {
      out.error("E262", text->span,
                "a counter of the net has at most " + std::to_string(FewValues::most) + " counts, not " +
                    std::to_string(*to - *from + 1),
                "give it a type: { type: uint32 }; conditions over it are then free choices for the proof");
    } else {
      values.least = *from;
      last = *to;
    }
  }
  for (std::uint32_t count = values.least; count <= std::max(last, values.least + 1); ++count)
    values.names.push_back(std::to_string(count));
  return values;
}

void read_initial(const Entry& entry, FewValues& values, Diagnostics& out) {
  const Node* text = text_of(*entry.value, entry.span, "initial", out, "write one of the values");
  if (text == nullptr) return;
  if (const auto found = values.find(text->text)) {
    values.initial = *found;
    return;
  }
  Hint hint = did_you_mean(text->text, values.names);
  if (hint.empty()) hint = "it is " + values.in_words();
  out.error("E261", text->span, "unknown value " + in_quotes(text->text) + " at the start", std::move(hint));
}

std::vector<std::string> names_of_cells(const std::vector<Field>& memory) {
  std::vector<std::string> names;
  for (const Field& cell : memory)
    if (cell.few && !cell.few->goal) names.push_back(cell.name);
  return names;
}

std::optional<Change> read_count(const Node& text, const FewValues& values, Change change, Diagnostics& out) {
  if (text.text == "+1" || text.text == "-1") {
    change.step = text.text == "+1" ? 1 : -1;
    return change;
  }
  const auto found = values.find(text.text);
  if (found) {
    change.value = *found;
    return change;
  }
  out.error("E266", text.span, in_quotes(text.text) + " is no change of a counter",
            "write +1, -1, or a count from " + values.names.front() + " to " + values.names.back());
  return std::nullopt;
}

std::optional<Change> read_value(const Node& text, const Field& cell, Change change, const Member* member,
                                 Diagnostics& out) {
  const FewValues& few = *cell.few;
  const std::size_t bracket = text.text.find('[');
  if (!few.fleet.empty() && text.text.compare(0, bracket, few.fleet) == 0) {
    const auto name = read_indexed(text, 0, out);
    if (!name) return std::nullopt;
    const Member family{few.fleet, few.fleet, 0, few.member_count};
    const auto number = number_of(*name, family, member, "value", out);
    if (!number) return std::nullopt;
    change.value = few.first_member + *number;
    return change;
  }
  if (const auto found = cell.few->find(text.text)) {
    change.value = *found;
    return change;
  }
  const bool steps = text.text.starts_with('+') || text.text.starts_with('-');
  Hint hint = did_you_mean(text.text, cell.few->names);
  if (hint.empty()) hint = steps ? "only a counter takes +1 and -1" : "it is " + cell.few->in_words();
  out.error("E261", text.span,
            "unknown value " + in_quotes(text.text) + " of " + in_quotes("memory." + cell.name),
            std::move(hint));
  return std::nullopt;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::optional<std::uint32_t> cell_named(const Entry& entry, const std::vector<Field>& memory,
                                        Diagnostics& out) {
  const auto found = std::ranges::find(memory, entry.key, &Field::name);
  if (found == memory.end()) {
    const std::vector<std::string> names = names_of_cells(memory);
    const bool is_path = entry.key.starts_with("memory.");
    Hint hint = did_you_mean(is_path ? entry.key.substr(entry.key.find('.') + 1) : entry.key, names);
    if (hint.empty()) hint = "memory with values here: " + joined(names);
    if (is_path && std::ranges::count(names, entry.key.substr(entry.key.find('.') + 1)) > 0)
      hint = "write " + entry.key.substr(entry.key.find('.') + 1);
    const std::string& change = entry.value->text;
    const bool steps = change.starts_with('+') || change.starts_with('-');
    if (names.empty())
      hint = "declare it: memory: { " + entry.key +
             (steps ? ": { counts: 0..4 } }" : ": { values: [nobody, a] } }");
    out.error("E101", entry.span, "unknown memory " + in_quotes(entry.key), std::move(hint));
    return std::nullopt;
  }
  if (found->few && found->few->goal) {
    out.error("E367", entry.span,
              in_quotes("memory." + entry.key) + " holds a goal, which 'sets' does not change",
              "write orders: " + entry.key + " in a behaviour, which begins with a new goal");
    return std::nullopt;
  }
  if (found->few) return static_cast<std::uint32_t>(found - memory.begin());
  out.error("E265", entry.span, in_quotes("memory." + entry.key) + " has a type, so only functions change it",
            "declare its values instead: " + entry.key + ": { values: [nobody, a, b] }, or { counts: 0..4 }");
  return std::nullopt;
}

}  // namespace

FewValues read_few_values(const Section& cell, const FleetSizes* fleets, Diagnostics& out) {
  const Entry* values = cell.find("values");
  const Entry* counts = cell.find("counts");
  if (const Entry* type = cell.find("type"))
    out.error("E262", type->span, "a memory cell with values has no 'type'", "remove it, or the values");
  if (values != nullptr && counts != nullptr)
    out.error("E262", counts->span, "a memory cell has either values or counts", "remove one of them");
  FewValues few = values != nullptr ? read_values(*values, fleets, out) : read_counts(*counts, out);
  if (const Entry* initial = cell.find("initial")) read_initial(*initial, few, out);
  return few;
}

std::vector<Change> read_changes(const Entry* entry, const std::vector<Field>& memory, const Member* member,
                                 Diagnostics& out) {
  std::vector<Change> changes;
  if (entry == nullptr) return changes;
  for (const Entry& written : entries_of(*entry->value, entry->span, "sets", out)) {
    const std::optional<std::uint32_t> cell = cell_named(written, memory, out);
    const Node* text = text_of(*written.value, written.span, "a value", out, "for example { lent_to: a }");
    if (!cell || text == nullptr) continue;
    const Change begun{.cell = *cell, .span = text->span};
    const Field& field = memory[*cell];
    const auto change = field.few->counts ? read_count(*text, *field.few, begun, out)
                                          : read_value(*text, field, begun, member, out);
    if (change) changes.push_back(*change);
  }
  return changes;
}

bool check_entry(const Next& entry, const std::vector<Field>& memory, Diagnostics& out) {
  bool may_be_blocked = false;
  std::vector<std::uint32_t> cells;
  std::size_t together = 1;
  for (const Change& change : entry.sets) {
    if (std::ranges::find(cells, change.cell) != cells.end()) continue;
    cells.push_back(change.cell);
    const Field& cell = memory[change.cell];
    const std::size_t count = cell.few->names.size();
    // The net has a transition for each value that the cell can have there: often one of the members.
    together *= count - cell.few->member_count + (cell.few->member_count > 0 ? 1 : 0);
    const std::optional<Allowed> values = allowed(*cell.few, change.cell, entry.sets);
    if (!values)
      out.error("E267", change.span,
                "no count of " + in_quotes("memory." + cell.name) + " allows this change",
                "together with the other changes it leaves the range: it is " + cell.few->in_words());
    may_be_blocked = may_be_blocked || !values || values->first > 0 || values->last + 1 < count;
    if (together <= most_together) continue;
    out.error("E269", change.span,
              "this entry changes memory with more than " + std::to_string(most_together) +
                  " combinations of values",
              "the net has a transition for each; change fewer cells at once, or give them fewer values");
    break;
  }
  return may_be_blocked;
}

void check_start(const Subsystem& subsystem, Diagnostics& out) {
  if (subsystem.behaviours.empty()) return;
  for (const Change& change : subsystem.behaviours[subsystem.start].sets) {
    const Field& cell = subsystem.memory[change.cell];
    if (change.after(cell.few->initial, *cell.few)) continue;
    out.error("E268", change.span,
              in_quotes("memory." + cell.name) + " is " + cell.few->names[cell.few->initial] +
                  " at the start, and this change leaves its range",
              "this behaviour runs first; change the counter where it is left, or 'counts'");
  }
}

}  // namespace tessera::spec
