#include "spec/behaviours/neighbours.hpp"

#include <cstdlib>
#include <string>
#include <utility>

#include "diagnostics/utf8.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

bool is_unconditional(const Next& entry) {
  return entry.when.kind == When::Kind::always && !entry.may_be_blocked;
}

/// "robot[2] has no poll[i+1]"
struct Missing {
  explicit Missing(const NeighbourEntry& entry)
      : name(entry.name),
        each(entry.each),
        outermost(name.offset > 0 ? each.count - 1 : 0),
        written(name.name + (name.offset > 0 ? "[i+" : "[i-") + std::to_string(std::abs(name.offset)) + "]") {
  }

  [[nodiscard]] std::string text() const {
    return name_of_member(each.fleet, outermost) + " has no " + in_quotes(written);
  }
  [[nodiscard]] std::string ring() const { return "write ring: true at fleet " + each.fleet; }
  /// The behaviour to which the outermost member may lead instead.
  [[nodiscard]] std::string other_end() const {
    return name_of_member(name.name, name.offset > 0 ? 0 : each.count - 1);
  }

  const IndexedName& name;
  const EachMember& each;
  std::uint32_t outermost;
  std::string written;
};

/// Whether an entry without condition stands behind it, and none is its own.
bool check(const NeighbourEntry& entry, const Behaviour& behaviour, Diagnostics& out) {
  const Missing missing(entry);
  if (!is_unconditional(behaviour.next[NextId{entry.entry}])) {
    out.error("E289", entry.name.index_span,
              missing.text() + ", and an entry that not every member has stands without a condition",
              missing.ring() + ", or ask the condition in an entry before");
    return false;
  }
  const std::uint32_t behind = entry.entry + 1;
  if (behind < behaviour.next.size() && is_unconditional(behaviour.next[NextId{behind}])) return true;
  out.error("E289", entry.name.index_span,
            missing.text() + ", and no entry without a condition follows for it",
            "say where it leads: [\"" + missing.written + "\", \"" + missing.other_end() + "\"]; or " +
                missing.ring());
  return false;
}

}  // namespace

void choose_neighbours(const std::vector<NeighbourEntry>& neighbours, Behaviour& behaviour,
                       Diagnostics& out) {
  for (const NeighbourEntry& entry : neighbours)
    if (!check(entry, behaviour, out)) return;
  Numbered<NextId, Next> chosen;
  auto neighbour = neighbours.begin();
  bool taken = false;  // one before it, instead of it
  for (const NextId at : behaviour.next.ids()) {
    const bool is_neighbour = neighbour != neighbours.end() && neighbour->entry == at.value;
    const bool exists = !is_neighbour || neighbour->exists;
    if (exists && !taken) chosen.push_back(std::move(behaviour.next[at]));
    taken = is_neighbour && (taken || exists);
    if (is_neighbour) ++neighbour;
  }
  behaviour.next = std::move(chosen);
}

}  // namespace tessera::spec
