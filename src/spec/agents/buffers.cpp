#include "spec/agents/buffers.hpp"

#include <unordered_map>

#include "diagnostics/utf8.hpp"
#include "spec/agents/few_values.hpp"
#include "spec/document/names.hpp"
#include "spec/document/section.hpp"
#include "spec/values/literals.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

Field read_cell(const Entry& entry, const Types& types, Diagnostics& out) {
  Field cell{entry.key, Types::unknown(), {}, entry.span};
  if (!entry.value->is_map()) {
    cell.type = types.parse(*entry.value, entry.span, out);
    return cell;
  }
  const Section section(*entry.value, entry.span, "a memory cell", {"type", "initial", "values", "counts"},
                        out);
  if (section.find("values") != nullptr || section.find("counts") != nullptr) {
    cell.few = read_few_values(section, out);
    return cell;
  }
  if (const Entry* type = section.require("type", "for example { type: float64, initial: 1.5 }")) {
    cell.type = types.parse(*type->value, type->span, out);
  }
  if (const Entry* initial = section.find("initial")) {
    cell.initial =
        initialiser(*initial->value, initial->span, cell.type, types, "the initial value", out).value_or("");
  }
  return cell;
}

}  // namespace

std::vector<Field> read_buffers(const Entry* entry, std::string_view what, const Types& types,
                                Diagnostics& out) {
  std::vector<Field> buffers;
  if (entry == nullptr) return buffers;
  for (const Entry& buffer : entries_of(*entry->value, entry->span, entry->key, out)) {
    check_name(buffer.key, buffer.span, what, out);
    buffers.push_back({buffer.key, types.parse(*buffer.value, buffer.span, out), {}, buffer.span});
  }
  return buffers;
}

std::vector<Field> read_memory(const Entry* entry, const Types& types, Diagnostics& out) {
  std::vector<Field> cells;
  if (entry == nullptr) return cells;
  for (const Entry& cell : entries_of(*entry->value, entry->span, "memory", out)) {
    check_name(cell.key, cell.span, "memory", out);
    cells.push_back(read_cell(cell, types, out));
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
                "a transition function sees both; the first is on line " + std::to_string(first->second));
    }
  }
}

}  // namespace tessera::spec
