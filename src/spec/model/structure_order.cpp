#include "spec/model/structure_order.hpp"

#include <algorithm>
#include <cassert>

namespace tessera::spec {
namespace {

bool uses_structure(const Field& field, std::size_t count) {
  return field.type.kind == Type::Kind::structure && field.type.structure.value < count;
}

/// Every structure that the sort has left over uses another one that is left over. Follows
/// these until one occurs twice.
std::vector<std::vector<StructureId>> find_cycles(const Structures& structures,
                                                  const Numbered<StructureId, bool>& done) {
  std::vector<std::vector<StructureId>> cycles;
  Numbered<StructureId, StructureId> walk_of(structures.size());
  for (const StructureId start : structures.ids()) {
    if (done[start]) continue;
    std::vector<StructureId> walk;
    StructureId at = start;
    while (!walk_of[at].valid()) {
      walk_of[at] = start;
      walk.push_back(at);
      const auto& fields = structures[at].fields;
      const auto next = std::find_if(fields.begin(), fields.end(), [&](const Field& field) {
        return uses_structure(field, structures.size()) && !done[field.type.structure];
      });
      assert(next != fields.end());
      at = next->type.structure;
    }
    if (walk_of[at] == start) cycles.emplace_back(std::find(walk.begin(), walk.end(), at), walk.end());
  }
  return cycles;
}

}  // namespace

StructureOrder order_structures(const Structures& structures) {
  Numbered<StructureId, std::vector<StructureId>> users(structures.size());
  Numbered<StructureId, std::size_t> missing(structures.size(), 0);
  for (const StructureId i : structures.ids()) {
    for (const Field& field : structures[i].fields) {
      if (!uses_structure(field, structures.size())) continue;
      users[field.type.structure].push_back(i);
      ++missing[i];
    }
  }
  StructureOrder order;
  Numbered<StructureId, bool> done(structures.size(), false);
  for (const StructureId i : structures.ids()) {
    if (missing[i] == 0) order.sorted.push_back(i);
  }
  for (std::size_t i = 0; i < order.sorted.size(); ++i) {
    done[order.sorted[i]] = true;
    for (const StructureId user : users[order.sorted[i]]) {
      if (--missing[user] == 0) order.sorted.push_back(user);
    }
  }
  order.cycles = find_cycles(structures, done);
  return order;
}

Structures reordered(Structures structures, const std::vector<StructureId>& sorted) {
  Numbered<StructureId, StructureId> new_id(structures.size());
  Structures result;
  result.reserve(structures.size());
  for (const StructureId old : sorted) {
    new_id[old] = result.next_id();
    result.push_back(std::move(structures[old]));
  }
  for (Structure& structure : result) {
    for (Field& field : structure.fields) {
      if (uses_structure(field, new_id.size())) field.type.structure = new_id[field.type.structure];
    }
  }
  return result;
}

}  // namespace tessera::spec
