#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "explore/encoding.hpp"
#include "explore/marking_set.hpp"

namespace tessera::explore {

enum class Direction : std::uint8_t { forward, backward };

/// A transition as masks over packed markings, in one direction. Backward, "consumes" and "produces" are
/// exchanged, so that firing leads to the marking before.
struct FiringMasks {
  std::uint32_t transition = 0;
  std::vector<Word> care, value;  ///< fields of units and bits that it reads, and their required contents
  std::vector<Word> flip;         ///< changes of these fields
  std::vector<Word> clear;        ///< bits that would get a second token if they were set
  std::vector<Word> need, add;    ///< of counters: least content; change (wraps around, borrows cancel out)
  std::vector<std::uint32_t> fields;  ///< those in care
  bool dead = false;                  ///< needs two places of one unit
};
[[nodiscard]] FiringMasks firing_masks(const PtNet& net, const Encoding& encoding, std::uint32_t transition,
                                       Direction direction);

/// Transitions sorted by a *pivot*: a field and the content that it must have for the transition to be
/// enabled. So for each field, only the transitions selected by its content need to be tried.
struct Selection {
  struct Selector {
    Field field;
    std::uint32_t first = 0;  ///< into starts: of content 0; content c selects [starts[first + c], next)
  };
  std::vector<FiringMasks> order;  ///< first those without a pivot, then by selector and content
  std::uint32_t without_pivot = 0;
  std::vector<Selector> selectors;
  std::vector<std::uint32_t> starts;
};
/// Distributes the transitions over pivots as evenly as it can. Dead transitions are left out.
[[nodiscard]] Selection select_by_pivot(std::vector<FiringMasks> masks, const Encoding& encoding);

/// All firings of a net on packed markings of W words.
///
/// Counters: whether the encoding has bits or counters that can overflow. If not, a transition is enabled
///           if the fields in `care` contain `value`, and its firing is one exclusive or.
///
/// Threads: const members from any thread.
template <std::size_t W, bool Counters>
class FiringTable {
 public:
  FiringTable(const PtNet& net, const Encoding& encoding, Direction direction) : direction_(direction) {
    std::vector<FiringMasks> masks;
    for (std::uint32_t transition = 0; transition < net.transitions(); ++transition)
      masks.push_back(firing_masks(net, encoding, transition, direction));
    Selection selection = select_by_pivot(std::move(masks), encoding);
    for (const FiringMasks& firing : selection.order) {
      firings_.push_back(
          {widened(firing.care), widened(firing.value), widened(firing.flip), firing.transition});
      if (Counters) counters_.push_back({widened(firing.clear), widened(firing.need), widened(firing.add)});
    }
    without_pivot_ = selection.without_pivot;
    selectors_ = std::move(selection.selectors);
    starts_ = std::move(selection.starts);
    for (std::uint32_t place = 0; place < net.places(); ++place) {
      const Encoding::Slot& slot = encoding.of(place);
      const Field& field = encoding.fields()[slot.field];
      if (slot.kind == Encoding::Kind::counter)
        guards_[field.word] |= Word{1} << (field.shift + field.width - 1);
    }
  }

  /// Calls visit(firing, successor) for every enabled transition. Forward, it stops at a firing that
  /// overflows the encoding and returns it. Backward, such a firing has no earlier marking in the encoding.
  template <class Visit>
  std::optional<std::uint32_t> for_each_enabled(const Packed<W>& marking, Visit visit) const {
    const auto try_range = [&](std::uint32_t begin, std::uint32_t end) -> std::optional<std::uint32_t> {
      for (std::uint32_t at = begin; at < end; ++at) {
        if (!enabled(at, marking)) continue;
        Packed<W> next;
        if (fire(at, marking, next))
          visit(at, next);
        else if (direction_ == Direction::forward)
          return at;
      }
      return std::nullopt;
    };
    if (const auto outgrown = try_range(0, without_pivot_)) return outgrown;
    for (const Selection::Selector& selector : selectors_) {
      const std::uint32_t* range = starts_.data() + selector.first + selector.field.of(marking);
      if (const auto outgrown = try_range(range[0], range[1])) return outgrown;
    }
    return std::nullopt;
  }

  [[nodiscard]] bool any_enabled(const Packed<W>& marking) const {
    for (std::uint32_t at = 0; at < firings_.size(); ++at)
      if (enabled(at, marking)) return true;
    return false;
  }

  [[nodiscard]] TransitionId transition(std::uint32_t firing) const { return {firings_[firing].transition}; }
  /// The firing of a transition; nullopt: it can never be enabled.
  [[nodiscard]] std::optional<std::uint32_t> firing_of(std::uint32_t transition) const {
    for (std::uint32_t at = 0; at < firings_.size(); ++at)
      if (firings_[at].transition == transition) return at;
    return std::nullopt;
  }

  [[nodiscard]] bool enabled(std::uint32_t at, const Packed<W>& marking) const {
    const Firing& firing = firings_[at];
    Word wrong = 0;
    for (std::size_t word = 0; word < W; ++word)
      wrong |= (marking[word] & firing.care[word]) ^ firing.value[word];
    if constexpr (Counters) {
      const Counter& counter = counters_[at];
      // Each counter borrows its guard bit. The bit comes back unless the counter is too small.
      for (std::size_t word = 0; word < W; ++word)
        wrong |= (((marking[word] | guards_[word]) - counter.need[word]) & guards_[word]) ^ guards_[word];
    }
    return wrong == 0;
  }

  [[nodiscard]] bool fire(std::uint32_t at, const Packed<W>& marking, Packed<W>& next) const {
    Word outgrown = 0;
    for (std::size_t word = 0; word < W; ++word) {
      next[word] = marking[word] ^ firings_[at].flip[word];
      if constexpr (Counters) {
        next[word] += counters_[at].add[word];
        outgrown |= (next[word] & guards_[word]) | (marking[word] & counters_[at].clear[word]);
      }
    }
    return outgrown == 0;
  }

 private:
  struct Firing {
    Packed<W> care, value, flip;
    std::uint32_t transition;
  };
  struct Counter {
    Packed<W> clear, need, add;
  };

  static Packed<W> widened(const std::vector<Word>& words) {
    Packed<W> packed{};
    std::ranges::copy(words, packed.begin());
    return packed;
  }

  Direction direction_;
  std::vector<Firing> firings_;
  std::vector<Counter> counters_;
  Packed<W> guards_{};
  std::uint32_t without_pivot_ = 0;
  std::vector<Selection::Selector> selectors_;
  std::vector<std::uint32_t> starts_;
};

}  // namespace tessera::explore
