#include <algorithm>
#include <charconv>

#include "diagnostics/utf8.hpp"
#include "spec/channels/models.hpp"
#include "spec/document/names.hpp"
#include "spec/document/section.hpp"
#include "tessera/nearest.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;
using Transition = ModelSide::Transition;

constexpr const char* transition_hint = "write NAME: { from: [in, empty], to: [work] }";

class ModelSideReader {
 public:
  ModelSideReader(const Entry& entry, const CommunicationModel& around, Diagnostics& out)
      : entry_(entry), around_(around), out_(out), sends_(entry.key == "send") {}

  ModelSide result() {
    const std::size_t before = out_.error_count();
    const Section section(*entry_.value, entry_.span, "'" + entry_.key + "' of a model",
                          {"places", "transitions"}, out_);
    if (!section.readable()) return {};
    if (const Entry* places = section.require("places")) read_places(*places);
    if (const Entry* transitions = section.require("transitions"))
      for (const Entry& one : entries_of(*transitions->value, transitions->span, "transitions", out_))
        read_transition(one);
    if (out_.error_count() == before) check_ways();
    return std::move(side_);
  }

 private:
  // ------------------------------------------------------------------------------------------- places

  void read_places(const Entry& section) {
    side_.places = {{"in", {}, section.span}, {"out", {}, section.span}};
    std::vector<bool> seen(2, false);
    for (const Entry& entry : entries_of(*section.value, section.span, "places", out_)) {
      if (entry.key == "in" || entry.key == "out") {
        seen[entry.key == "in" ? ModelSide::in : ModelSide::out] = true;
        if (read_operation(entry))
          out_.error("E120", entry.span, in_quotes(entry.key) + " has no operation",
                     "write and read in a place between 'in' and 'out'");
        continue;
      }
      check_name(entry.key, entry.span, "place", out_);
      if (std::ranges::find(around_.shared, entry.key, &SharedPlace::name) != around_.shared.end())
        out_.error("E107", entry.span, "place " + in_quotes(entry.key) + " is shared already",
                   "a place belongs to one side, or to both under 'shared'");
      side_.places.push_back({entry.key, read_operation(entry), entry.span});
    }
    for (const std::uint32_t place : {ModelSide::in, ModelSide::out})
      if (!seen[place])
        out_.error("E103", section.span,
                   in_quotes(entry_.key) + " of model " + in_quotes(around_.name) + " has no place " +
                       in_quotes(side_.places[place].name),
                   "every side begins in 'in' and ends in 'out'");
    const bool works = std::ranges::any_of(
        side_.places, [](const ModelSide::Place& place) { return place.slot.has_value(); });
    if (!works && !misplaced_)
      out_.error("E103", section.span,
                 "no place of " + in_quotes(entry_.key) + " of model " + in_quotes(around_.name) + " has " +
                     (sends_ ? "'write'" : "'read'"),
                 sends_ ? "write work: { write: 1 }" : "write work: { read: 1 }");
  }

  /// The slot that the operation of a place uses, if it has one.
  std::optional<std::uint32_t> read_operation(const Entry& entry) {
    const Section place(*entry.value, entry.span, "a place", {"write", "read"}, out_);
    const std::string_view own = sends_ ? "write" : "read", other = sends_ ? "read" : "write";
    if (const Entry* wrong = place.find(other)) {
      misplaced_ = true;
      out_.error("E120", wrong->span, in_quotes(entry_.key) + " of a model cannot " + std::string(other),
                 "places of 'send' write, places of 'receive' read");
    }
    const Entry* operation = place.find(own);
    if (operation == nullptr) return std::nullopt;
    misplaced_ = true;
    const Node* text =
        text_of(*operation->value, operation->span, in_quotes(operation->key), out_, "the slot, from 1");
    if (text == nullptr) return std::nullopt;
    std::uint32_t slot = 0;
    const char* end = text->text.data() + text->text.size();
    const auto [at, error] = std::from_chars(text->text.data(), end, slot);
    if (at == end && error == std::errc() && slot >= 1 && slot <= around_.slots) return slot - 1;
    out_.error("E121", text->span,
               "model " + in_quotes(around_.name) + " has no slot " + in_quotes(text->text),
               around_.slots == 1 ? "it has slot 1; 'slots: 2' gives it another"
                                  : "its slots are 1 to " + std::to_string(around_.slots));
    return std::nullopt;
  }

  // ------------------------------------------------------------------------------------------- transitions

  void read_transition(const Entry& entry) {
    check_name(entry.key, entry.span, "transition", out_);
    const Section section(*entry.value, entry.span, "a transition", {"from", "to", "when"}, out_);
    if (!section.readable()) return;
    Transition transition;
    transition.name = entry.key;
    transition.span = entry.span;
    const Entry* from = section.require("from", transition_hint);
    const Entry* to = section.require("to", transition_hint);
    if (const Entry* when = section.find("when")) transition.elapsed = read_when(*when);
    if (from == nullptr || to == nullptr || side_.places.empty()) return;
    const bool begins = read_ends(*from, transition, transition.from, transition.takes);
    const bool ends = read_ends(*to, transition, transition.to, transition.gives);
    if (begins && transition.from == ModelSide::out)
      out_.error("E122", from->span, "nothing leads out of 'out'",
                 "the place behind it belongs to the behaviour");
    if (ends && transition.to == ModelSide::in)
      out_.error("E122", to->span, "nothing leads back to 'in'",
                 "lead to 'out', or to a place between the two");
    side_.transitions.push_back(std::move(transition));
  }

  bool read_when(const Entry& when) {
    const Node* text = text_of(*when.value, when.span, "'when'", out_, "write when: elapsed");
    if (text == nullptr || text->text == "elapsed") return true;
    Hint hint = did_you_mean(text->text, {"elapsed"});
    if (hint.empty()) hint = "elapsed: the timeout of the channel has passed";
    out_.error("E104", text->span, "'when' must be elapsed, not " + in_quotes(text->text), hint);
    return true;
  }

  /// The places that arcs join to one end of a transition. true: one of them belongs to this side.
  bool read_ends(const Entry& entry, const Transition& transition, std::uint32_t& own,
                 std::vector<std::uint32_t>& shared) {
    std::vector<const Node*> names{entry.value};
    if (!entry.value->is_scalar()) names = items_of(*entry.value, entry.span, in_quotes(entry.key), out_);
    std::uint32_t count = 0;
    bool good = true;
    for (const Node* name : names) {
      const Node* text = text_of(*name, entry.span, "a place", out_, transition_hint);
      if (text == nullptr) return false;
      if (const auto place = place_named(text->text)) {
        own = *place;
        ++count;
        continue;
      }
      const auto place = shared_named(text->text);
      if (!place) {
        complain_about(*text);
        good = false;
      } else if (std::ranges::find(shared, *place) != shared.end()) {
        out_.error("E107", text->span,
                   "two arcs join " + in_quotes(text->text) + " and " + in_quotes(transition.name));
      } else {
        shared.push_back(*place);
      }
    }
    if (good && count != 1)
      out_.error(
          "E122", entry.span,
          "transition " + in_quotes(transition.name) + (entry.key == "from" ? " takes " : " gives ") +
              std::to_string(count) + " places of " + in_quotes(entry_.key) + ", not one",
          "a side has one token: a transition takes one of its places and gives one, besides shared ones");
    return good && count == 1;
  }

  [[nodiscard]] std::optional<std::uint32_t> place_named(const std::string& name) const {
    const auto found = std::ranges::find(side_.places, name, &ModelSide::Place::name);
    if (found == side_.places.end()) return std::nullopt;
    return static_cast<std::uint32_t>(found - side_.places.begin());
  }
  [[nodiscard]] std::optional<std::uint32_t> shared_named(const std::string& name) const {
    const auto found = std::ranges::find(around_.shared, name, &SharedPlace::name);
    if (found == around_.shared.end()) return std::nullopt;
    return static_cast<std::uint32_t>(found - around_.shared.begin());
  }

  void complain_about(const Node& text) {
    std::vector<std::string> known;
    for (const ModelSide::Place& place : side_.places) known.push_back(place.name);
    for (const SharedPlace& place : around_.shared) known.push_back(place.name);
    out_.error("E101", text.span,
               "unknown place " + in_quotes(text.text) + " in " + in_quotes(entry_.key) + " of model " +
                   in_quotes(around_.name),
               did_you_mean(text.text, known));
  }

  // ------------------------------------------------------------------------------------------- ways

  /// Checks that every place lies on a way from `in` to `out`.
  void check_ways() {
    const std::vector<bool> reached = closure(ModelSide::in, &Transition::from, &Transition::to);
    const std::vector<bool> leaves = closure(ModelSide::out, &Transition::to, &Transition::from);
    if (!reached[ModelSide::out])
      out_.error("E123", entry_.span, "no way leads from 'in' to 'out'",
                 "transitions lead from place to place: { from: [in], to: [work] }");
    for (std::uint32_t place = ModelSide::out + 1; place < side_.places.size(); ++place) {
      const std::string name = "place " + in_quotes(side_.places[place].name);
      if (!reached[place]) out_.error("E123", side_.places[place].span, "no way leads from 'in' to " + name);
      if (!leaves[place])
        out_.error("E123", side_.places[place].span, "no way leads from " + name + " to 'out'");
    }
  }

  [[nodiscard]] std::vector<bool> closure(std::uint32_t start, std::uint32_t Transition::*near,
                                          std::uint32_t Transition::*far) const {
    std::vector<bool> reached(side_.places.size(), false);
    reached[start] = true;
    for (bool changed = true; changed;) {
      changed = false;
      for (const Transition& transition : side_.transitions)
        if (reached[transition.*near] && !reached[transition.*far]) reached[transition.*far] = changed = true;
    }
    return reached;
  }

  const Entry& entry_;
  const CommunicationModel& around_;
  Diagnostics& out_;
  bool sends_;
  bool misplaced_ = false;  // an operation was given, right or wrong
  ModelSide side_;
};

}  // namespace

ModelSide read_side(const Entry& entry, const CommunicationModel& around, Diagnostics& out) {
  return ModelSideReader(entry, around, out).result();
}

}  // namespace tessera::spec
