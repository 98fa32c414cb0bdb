#include "spec/model/structure_order.hpp"

#include <algorithm>
#include <cassert>

namespace tessera::spec {
namespace {

bool uses_structure(const Field& field, std::size_t count) {
  return field.type.kind == Type::Kind::structure && field.type.structure < count;
}

/// Every structure that the sort has left over uses another one that is left over. Follows
/// these until one occurs twice.
std::vector<std::vector<Index>> find_cycles(const std::vector<Structure>& structures,
                                            const std::vector<bool>& done) {
  std::vector<std::vector<Index>> cycles;
  std::vector<Index> walk_of(structures.size(), none);
  for (Index start = 0; start < structures.size(); ++start) {
    if (done[start]) continue;
    std::vector<Index> walk;
    Index at = start;
    while (walk_of[at] == none) {
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

StructureOrder order_structures(const std::vector<Structure>& structures) {
  std::vector<std::vector<Index>> users(structures.size());
  std::vector<std::size_t> missing(structures.size(), 0);
  for (Index i = 0; i < structures.size(); ++i) {
    for (const Field& field : structures[i].fields) {
      if (!uses_structure(field, structures.size())) continue;
      users[field.type.structure].push_back(i);
      ++missing[i];
    }
  }
  StructureOrder order;
  std::vector<bool> done(structures.size(), false);
  for (Index i = 0; i < structures.size(); ++i) {
    if (missing[i] == 0) order.sorted.push_back(i);
  }
  for (std::size_t i = 0; i < order.sorted.size(); ++i) {
    done[order.sorted[i]] = true;
    for (const Index user : users[order.sorted[i]]) {
      if (--missing[user] == 0) order.sorted.push_back(user);
    }
  }
  order.cycles = find_cycles(structures, done);
  return order;
}

std::vector<Structure> reordered(std::vector<Structure> structures, const std::vector<Index>& sorted) {
  std::vector<Index> new_index(structures.size(), none);
  std::vector<Structure> result;
  result.reserve(structures.size());
  for (const Index old : sorted) {
    new_index[old] = static_cast<Index>(result.size());
    result.push_back(std::move(structures[old]));
  }
  for (Structure& structure : result) {
    for (Field& field : structure.fields) {
      if (uses_structure(field, new_index.size())) field.type.structure = new_index[field.type.structure];
    }
  }
  return result;
}

}  // namespace tessera::spec
