#include "spec/agents/buffers.hpp"

#include <unordered_map>

#include "diagnostics/utf8.hpp"
#include "spec/document/names.hpp"
#include "spec/document/section.hpp"
#include "spec/memory/few_values.hpp"
#include "spec/memory/goals.hpp"
#include "spec/values/literals.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

/// The type of a memory cell: "bool[each robot]" is an array with an element for each member.
Type read_cell_type(const Node& written, Span at, const Types& types, const FleetSizes* fleets,
                    Diagnostics& out) {
  const auto each = written.is_scalar() ? each_in(written.text) : std::nullopt;
  if (!each) return types.parse(written, at, out);
  const auto members = read_each(written, each->begin + 1, each->end - each->begin - 2, fleets, out);
  if (!members) return Types::unknown();
  Node counted = written;
  counted.text.replace(each->begin + 1, each->end - each->begin - 2, std::to_string(members->count));
  counted.verbatim = false;
  return types.parse(counted, at, out);
}

Field read_cell(const Entry& entry, const GoalScope& buffers, const FleetSizes* fleets, Diagnostics& out) {
  const Types& types = buffers.types;
  Field cell{entry.key, Types::unknown(), {}, entry.span};
  if (!entry.value->is_map()) {
    cell.type = read_cell_type(*entry.value, entry.span, types, fleets, out);
    return cell;
  }
  const Section section(*entry.value, entry.span, "a memory cell",
                        {"type", "initial", "values", "counts", "goal", "progress"}, out);
  if (section.find("goal") != nullptr || section.find("progress") != nullptr) {
    cell.few = read_goal(section, buffers, out);
    return cell;
  }
  if (section.find("values") != nullptr || section.find("counts") != nullptr) {
    cell.few = read_few_values(section, fleets, out);
    return cell;
  }
  if (const Entry* type = section.require("type", "for example { type: float64, initial: 1.5 }")) {
    cell.type = read_cell_type(*type->value, type->span, types, fleets, out);
  }
  if (const Entry* initial = section.find("initial")) {
    cell.initial =
        initialiser(*initial->value, initial->span, cell.type, types, "the initial value", out).value_or("");
  }
  return cell;
}

}  // namespace

std::vector<Field> read_buffers(const Entry* entry, std::string_view what, const Types& types,
                                const FleetSizes* fleets, Diagnostics& out) {
  std::vector<Field> buffers;
  if (entry == nullptr) return buffers;
  for (const Entry& buffer : entries_of(*entry->value, entry->span, entry->key, out)) {
    check_name(buffer.key, buffer.span, what, out);
    const auto each = buffer.value->is_scalar() ? each_in(buffer.value->text) : std::nullopt;
    if (!each) {
      buffers.push_back({buffer.key, types.parse(*buffer.value, buffer.span, out), {}, buffer.span});
      continue;
    }
    if (what != "input" && what != "output") {
      out.error("E290", buffer.value->part(each->begin, each->end - each->begin),
                "a " + std::string(what) + " is that of one device",
                "only 'inputs' and 'outputs' have one buffer for each member of a fleet");
      continue;
    }
    const auto members = read_each(*buffer.value, each->begin + 1, each->end - each->begin - 2, fleets, out);
    Node alone = *buffer.value;  // the type of one of them
    alone.text.erase(each->begin, each->end - each->begin);
    alone.verbatim = alone.verbatim && alone.text.size() == each->begin;
    const Type type = types.parse(alone, buffer.span, out);
    // Without a fleet nothing more is said about indices.
    const EachMember each_member = members.value_or(EachMember{});
    for (std::uint32_t number = 0; number < each_member.count; ++number) {
      Field one{name_of_member(buffer.key, number), type, {}, buffer.span};
      one.member = each_member.member(buffer.key, number);
      buffers.push_back(std::move(one));
    }
  }
  return buffers;
}

std::vector<Field> read_memory(const Entry* entry, const GoalScope& buffers, const FleetSizes* fleets,
                               Diagnostics& out) {
  std::vector<Field> cells;
  if (entry == nullptr) return cells;
  for (const Entry& cell : entries_of(*entry->value, entry->span, "memory", out)) {
    check_name(cell.key, cell.span, "memory", out);
    cells.push_back(read_cell(cell, buffers, fleets, out));
  }
  return cells;
}

void check_distinct(const std::vector<const std::vector<Field>*>& scope, Diagnostics& out) {
  std::unordered_map<std::string, std::uint32_t> lines;
  for (const std::vector<Field>* fields : scope) {
    for (const Field& field : *fields) {
      const auto [first, added] = lines.emplace(field.name, field.span.line);
      if (added) continue;
      out.error("E107", field.span, "the name " + in_quotes(field.name) + " is taken",
                "a transition function sees both; the first is on " + out.words(first->second));
    }
  }
}

}  // namespace tessera::spec
