#include "explore/firing_table.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace tessera::explore {
namespace {

/// The effect of a transition on one field of a unit or a bit, and the contents that it requires.
struct Move {
  bool takes = false, gives = false;
  Word before = 0, after = 0;  // contents; 0 where no place of the field is marked
};

class MaskBuilder {
 public:
  MaskBuilder(const Encoding& encoding, Direction direction) : encoding_(encoding), direction_(direction) {
    for (auto* words : {&masks_.care, &masks_.value, &masks_.flip, &masks_.clear, &masks_.need, &masks_.add})
      words->assign(encoding.words(), 0);
  }

  void touch(const Touch& touch) {
    const Encoding::Slot& slot = encoding_.of(touch.node);
    if (slot.kind == Encoding::Kind::counter) return count(encoding_.fields()[slot.field], touch);
    Move& move = moves_[slot.field];
    if (touch.consumes > 0) {
      // It would need more than one token, or a token of a second place of the unit; no marking has that.
      masks_.dead |= move.takes || touch.consumes > 1;
      move.takes = true;
      move.before = slot.code;
    }
    if (touch.produces > 0) {
      masks_.dead |= move.gives || touch.produces > 1;
      move.gives = true;
      move.after = slot.code;
    }
    if (slot.kind == Encoding::Kind::bit && touch.consumes == 0) only_given_.push_back(slot.field);
  }

  FiringMasks result(std::uint32_t transition) {
    masks_.transition = transition;
    for (const auto& [index, move] : moves_) {
      const Field& field = encoding_.fields()[index];
      masks_.flip[field.word] ^= (move.before ^ move.after) << field.shift;
      const bool may_outgrow = direction_ == Direction::forward && std::ranges::count(only_given_, index) > 0;
      if (may_outgrow) {
        masks_.clear[field.word] |= field.mask();
      } else {
        const Word content = direction_ == Direction::forward ? move.before : move.after;
        masks_.care[field.word] |= field.mask();
        masks_.value[field.word] |= content << field.shift;
        masks_.fields.push_back(index);
      }
    }
    return std::move(masks_);
  }

 private:
  void count(const Field& field, const Touch& touch) {
    const bool forward = direction_ == Direction::forward;
    const Word taken = forward ? touch.consumes : touch.produces;
    const Word given = forward ? touch.produces : touch.consumes;
    masks_.need[field.word] |= taken << field.shift;
    masks_.add[field.word] += (given - taken) << field.shift;
  }

  const Encoding& encoding_;
  Direction direction_;
  FiringMasks masks_;
  std::map<std::uint32_t, Move> moves_;  // by field
  std::vector<std::uint32_t> only_given_;
};

using Pivot = std::pair<std::uint32_t, Word>;  // field, content

Word content_of(const FiringMasks& masks, const Field& field) { return field.of(masks.value); }

}  // namespace

FiringMasks firing_masks(const PtNet& net, const Encoding& encoding, std::uint32_t transition,
                         Direction direction) {
  MaskBuilder builder(encoding, direction);
  for (const Touch& touch : net.of_transition(transition)) builder.touch(touch);
  return builder.result(transition);
}

Selection select_by_pivot(std::vector<FiringMasks> masks, const Encoding& encoding) {
  std::map<Pivot, std::vector<FiringMasks>> lists;
  Selection selection;
  std::erase_if(masks, &FiringMasks::dead);
  // Masks with few choices come first; each takes the shortest list.
  std::ranges::stable_sort(masks, {}, [](const FiringMasks& one) { return one.fields.size(); });
  for (FiringMasks& one : masks) {
    if (one.fields.empty()) {
      selection.order.push_back(std::move(one));
      continue;
    }
    const auto pivot = [&](std::uint32_t field) -> Pivot {
      return {field, content_of(one, encoding.fields()[field])};
    };
    const std::uint32_t best = *std::ranges::min_element(
        one.fields, {}, [&](std::uint32_t field) { return lists[pivot(field)].size(); });
    lists[pivot(best)].push_back(std::move(one));
  }
  std::erase_if(lists, [](const auto& list) { return list.second.empty(); });
  selection.without_pivot = static_cast<std::uint32_t>(selection.order.size());
  for (auto list = lists.begin(); list != lists.end();) {
    const std::uint32_t index = list->first.first;
    const Field& field = encoding.fields()[index];
    selection.selectors.push_back({field, static_cast<std::uint32_t>(selection.starts.size())});
    for (Word content = 0; content < (Word{1} << field.width); ++content) {
      selection.starts.push_back(static_cast<std::uint32_t>(selection.order.size()));
      if (list == lists.end() || list->first != Pivot{index, content}) continue;
      for (FiringMasks& one : list->second) selection.order.push_back(std::move(one));
      ++list;
    }
    selection.starts.push_back(static_cast<std::uint32_t>(selection.order.size()));
  }
  return selection;
}

}  // namespace tessera::explore
