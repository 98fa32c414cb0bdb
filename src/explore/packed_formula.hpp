#pragma once

#include <vector>

#include "explore/firing_table.hpp"
#include "explore/formula.hpp"

namespace tessera::explore {

/// A formula compiled into tests of packed markings. The table must outlive it.
template <class Table>
class PackedFormula {
 public:
  PackedFormula(const Formula& formula, const Encoding& encoding, const Table& table) : table_(table) {
    add(formula, encoding);
  }

  template <class Marking>
  [[nodiscard]] bool operator()(const Marking& marking) const {
    std::size_t at = 0;
    return evaluate(marking, at);
  }

 private:
  enum class Test : std::uint8_t { equal, at_least, enabled, dead, negation, all, any, never, always };
  struct Node {
    Test test = Test::never;
    std::uint32_t word = 0;
    Word mask = 0, value = 0;  // of the word; enabled: value is the firing
    std::size_t end = 0;       // position after its parts, which follow it
  };

  void add(const Formula& formula, const Encoding& encoding) {
    const std::size_t at = nodes_.size();
    nodes_.push_back(compiled(formula, encoding));
    for (const Formula& part : formula.parts) add(part, encoding);
    nodes_[at].end = nodes_.size();
  }

  Node compiled(const Formula& formula, const Encoding& encoding) const {
    switch (formula.kind) {
      case Formula::Kind::at_least:
        return compiled_count(formula, encoding);
      case Formula::Kind::enabled: {
        const auto firing = table_.firing_of(formula.node);
        if (!firing) return {Test::never};
        return {Test::enabled, 0, 0, *firing};
      }
      case Formula::Kind::dead:
        return {Test::dead};
      case Formula::Kind::negation:
        return {Test::negation};
      case Formula::Kind::all:
        return {Test::all};
      case Formula::Kind::any:
        return {Test::any};
    }
    return {};
  }

  static Node compiled_count(const Formula& formula, const Encoding& encoding) {
    if (formula.tokens == 0) return {Test::always};
    const Encoding::Slot& slot = encoding.of(formula.node);
    const Field& field = encoding.fields()[slot.field];
    if (slot.kind == Encoding::Kind::counter) {
      if (Word{formula.tokens} >= Word{1} << field.width) return {Test::never};
      return {Test::at_least, field.word, field.mask(), Word{formula.tokens} << field.shift};
    }
    if (formula.tokens > 1) return {Test::never};
    return {Test::equal, field.word, field.mask(), slot.code << field.shift};
  }

  /// Moves `at` behind the node and its parts.
  template <class Marking>
  bool evaluate(const Marking& marking, std::size_t& at) const {
    const Node& node = nodes_[at++];
    bool result = true;
    switch (node.test) {
      case Test::equal:
        return (marking[node.word] & node.mask) == node.value;
      case Test::at_least:
        return (marking[node.word] & node.mask) >= node.value;
      case Test::enabled:
        return table_.enabled(static_cast<std::uint32_t>(node.value), marking);
      case Test::dead:
        return !table_.any_enabled(marking);
      case Test::negation:
        return !evaluate(marking, at);
      case Test::all:
      case Test::any:
        result = node.test == Test::all;
        while (at < node.end)
          if (evaluate(marking, at) != result) {
            at = node.end;
            return !result;
          }
        return result;
      case Test::never:
        return false;
      case Test::always:
        return true;
    }
    return false;
  }

  const Table& table_;
  std::vector<Node> nodes_;
};

}  // namespace tessera::explore
