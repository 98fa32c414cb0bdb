// Whether the entries of `next` cover every count.

#include <algorithm>
#include <string>
#include <vector>

#include "diagnostics/utf8.hpp"
#include "spec/conditions/known_truth.hpp"
#include "spec/conditions/memory_part.hpp"
#include "spec/memory/few_values.hpp"
#include "spec/model/endings.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

constexpr std::size_t most_counted = 4096;  // combinations that are looked at

/// Values of the memory cells that a list of `next` asks and changes.
class Counting {
 public:
  Counting(const Subsystem& subsystem, const Behaviour& behaviour)
      : subsystem_(subsystem), behaviour_(behaviour), values_(subsystem.memory.size(), 0) {
    std::vector<bool> asked(values_.size(), false);
    for (const Next& next : behaviour.next) {
      for (const Change& change : next.sets) asked[change.cell] = asked[change.cell] || change.step != 0;
      if (next.when.kind != When::Kind::expression) continue;
      for (const Reference& one : next.when.text.references)
        if (one.kind == Reference::Kind::memory && one.target && subsystem.memory[*one.target].few)
          asked[*one.target] = true;
    }
    for (std::uint32_t cell = 0; cell < asked.size(); ++cell) {
      if (!asked[cell] || count_ * size(cell) > most_counted) continue;
      cells_.push_back(cell);
      count_ *= size(cell);
    }
  }

  /// "memory.n is 4": values with which possibly no entry holds; empty: there are none.
  std::string uncovered() {
    for (std::size_t number = 0; number < count_; ++number) {
      set(number);
      if (none_possible()) return in_words();
    }
    return {};
  }

 private:
  [[nodiscard]] std::size_t size(std::uint32_t cell) const {
    return subsystem_.memory[cell].few->names.size();
  }

  void set(std::size_t number) {
    for (const std::uint32_t cell : cells_) {
      values_[cell] = static_cast<std::uint32_t>(number % size(cell));
      number /= size(cell);
    }
  }

  [[nodiscard]] bool knows(std::uint32_t cell) const { return std::ranges::count(cells_, cell) > 0; }

  [[nodiscard]] Truth allows(const Next& next) const {
    std::vector<std::uint32_t> now = values_;
    for (const Change& change : next.sets) {
      if (!knows(change.cell) && change.step != 0) return Truth::free;
      const auto after = change.after(now[change.cell], *subsystem_.memory[change.cell].few);
      if (!after) return Truth::never;
      now[change.cell] = *after;
    }
    return Truth::always;
  }

  [[nodiscard]] Truth truth(const Expression& expression) const {
    if (const Truth constant = truth_of(expression); constant != Truth::free) return constant;
    return truth_of(expression.text, [this, &expression](std::span<const Token> tokens) {
      const auto part = memory_part(tokens, subsystem_.memory, expression.member);
      if (!part || !knows(part->cell)) return Truth::free;
      return part->holds[values_[part->cell]] ? Truth::always : Truth::never;
    });
  }

  [[nodiscard]] bool none_possible() const {
    return Endings(
               behaviour_, [this](const Expression& one) { return truth(one); },
               [this](const Next& next) { return allows(next); })
        .none_possible(Ending::terminal);
  }

  [[nodiscard]] std::string in_words() const {
    std::string text;
    for (const std::uint32_t cell : cells_)
      text += (text.empty() ? "memory." : " and memory.") + subsystem_.memory[cell].name + " is " +
              subsystem_.memory[cell].few->names[values_[cell]];
    return text;
  }

  const Subsystem& subsystem_;
  const Behaviour& behaviour_;
  std::vector<std::uint32_t> cells_;
  std::vector<std::uint32_t> values_;  // per cell
  std::size_t count_ = 1;
};

}  // namespace

void check_counters(const Subsystem& subsystem, Diagnostics& out) {
  for (const Behaviour& behaviour : subsystem.behaviours) {
    const auto blocked = std::ranges::find_if(behaviour.next, &Next::may_be_blocked);
    if (blocked == behaviour.next.end()) continue;
    // W312 tells of a list that is incomplete whatever the counts are.
    const auto always = [](const Next&) { return Truth::always; };
    const auto constants = [](const Expression& one) { return truth_of(one); };
    if (Endings(behaviour, constants, always).none_possible(Ending::terminal)) continue;
    const std::string when = Counting(subsystem, behaviour).uncovered();
    if (when.empty()) continue;
    out.warning(
        "W312", blocked->span,
        "behaviour " + in_quotes(behaviour.name) +
            " may end as terminal with no entry of 'next' to take: " + when,
        "an entry that takes a counter out of its range is not taken; add one for that case behind it");
  }
}

}  // namespace tessera::spec
