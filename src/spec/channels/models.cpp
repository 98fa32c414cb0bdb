#include "spec/channels/models.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <set>
#include <unordered_map>

#include "diagnostics/utf8.hpp"
#include "spec/document/names.hpp"
#include "spec/document/section.hpp"
#include "tessera/channel_limits.hpp"
#include "tessera/nearest.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

constexpr const char* model_hint =
    "a model has slots, shared, send and receive; see docs/reference/specification.md";

/// A whole number of at most `most`. Errors: E203, E204.
std::uint32_t read_number(const Entry& entry, std::uint32_t least, std::uint32_t most, Diagnostics& out) {
  const Node* text = text_of(*entry.value, entry.span, in_quotes(entry.key), out);
  if (text == nullptr) return least;
  std::uint32_t value = 0;
  const char* end = text->text.data() + text->text.size();
  const auto [at, error] = std::from_chars(text->text.data(), end, value);
  if (at != end || error != std::errc()) {
    out.error("E203", text->span,
              in_quotes(entry.key) + " must be a whole number, not " + in_quotes(text->text));
    return least;
  }
  if (value >= least && value <= most) return value;
  out.error("E204", text->span,
            in_quotes(entry.key) + " must be " + std::to_string(least) +
                (most == least + 1 ? " or " : " to ") + std::to_string(most));
  return least;
}

/// Errors: those of names; E107 `in` and `out`, which every side has; E124 too many.
void read_shared(const Entry& section, CommunicationModel& model, Diagnostics& out) {
  for (const Entry& entry : entries_of(*section.value, section.span, "shared", out)) {
    check_name(entry.key, entry.span, "place", out);
    if (entry.key == "in" || entry.key == "out")
      out.error("E107", entry.span, in_quotes(entry.key) + " belongs to each side and cannot be shared");
    model.shared.push_back({entry.key, read_number(entry, 0, 1, out), entry.span});
  }
  if (model.shared.size() > most_shared_places)
    out.error("E124", section.span,
              "model " + in_quotes(model.name) + " has " + std::to_string(model.shared.size()) +
                  " shared places; a channel has room for " + std::to_string(most_shared_places));
}

void check_needs(const ModelSide& side, const Entry& entry, const CommunicationModel& model,
                 Diagnostics& out) {
  std::set<std::vector<std::uint32_t>> needs;
  for (const ModelSide::Transition& transition : side.transitions) {
    std::vector<std::uint32_t> takes = transition.takes;
    std::ranges::sort(takes);
    if (!takes.empty()) needs.insert(std::move(takes));
  }
  if (needs.size() > most_needs)
    out.error("E124", entry.span,
              in_quotes(entry.key) + " of model " + in_quotes(model.name) + " takes " +
                  std::to_string(needs.size()) + " different sets of shared places; a channel has room for " +
                  std::to_string(most_needs));
}

void warn_of_unused_places(const CommunicationModel& model, Diagnostics& out) {
  std::set<std::uint32_t> used;
  for (const ModelSide* side : {&model.send, &model.receive})
    for (const ModelSide::Transition& transition : side->transitions)
      for (const auto& ends : {transition.takes, transition.gives}) used.insert(ends.begin(), ends.end());
  for (std::uint32_t place = 0; place < model.shared.size(); ++place)
    if (!used.contains(place))
      out.warning("W320", model.shared[place].span,
                  "no transition uses shared place " + in_quotes(model.shared[place].name));
}

CommunicationModel read_model(const Entry& entry, Diagnostics& out) {
  CommunicationModel model;
  model.name = entry.key;
  model.span = entry.span;
  check_name(entry.key, entry.span, "model", out);
  const std::size_t before = out.error_count();
  const Section section(*entry.value, entry.span, "a model", {"slots", "shared", "send", "receive"}, out);
  if (!section.readable()) return model;
  if (const Entry* slots = section.find("slots")) model.slots = read_number(*slots, 1, most_slots, out);
  if (const Entry* shared = section.require("shared", "the places that both sides see, with their tokens"))
    read_shared(*shared, model, out);
  const std::array<std::pair<const Entry*, ModelSide*>, 2> sides{
      {{section.require("send", model_hint), &model.send},
       {section.require("receive", model_hint), &model.receive}}};
  for (const auto& [side, read] : sides) {
    if (side == nullptr) continue;
    *read = read_side(*side, model, out);
    check_needs(*read, *side, model, out);
  }
  if (out.error_count() != before) return model;
  warn_of_unused_places(model, out);
  for (ModelSide* side : {&model.send, &model.receive}) side->waits = waits_without_peer(model, *side);
  return model;
}

}  // namespace

void CommunicationModels::read(const Entry* section, Model& model, Diagnostics& out) {
  if (section == nullptr) return;
  for (const Entry& entry : entries_of(*section->value, section->span, "models", out)) {
    const std::size_t before = out.error_count();
    CommunicationModel read = read_model(entry, out);
    known_.push_back({entry.key});
    if (out.error_count() != before) continue;
    known_.back().id = model.models.next_id();
    model.models.push_back(std::move(read));
  }
}

CommunicationModelId CommunicationModels::find(const Node& name, Diagnostics& out) {
  const auto found = std::ranges::find(known_, name.text, &Known::name);
  if (found != known_.end()) {
    found->used = true;
    return found->id;
  }
  one_is_unknown_ = true;
  std::vector<std::string> names;
  for (const Known& one : known_) names.push_back(one.name);
  const Hint hint = did_you_mean(name.text, names);
  out.error("E101", name.span, "unknown model " + in_quotes(name.text),
            hint.empty()
                ? "models of your own stand under 'models'; the others are chosen by send and receive"
                : hint);
  return {};
}

void CommunicationModels::complain_about_unused(const Model& model, Diagnostics& out) const {
  if (one_is_unknown_) return;
  for (const Known& one : known_)
    if (!one.used && one.id.valid())
      out.warning("W321", model.models[one.id].span, "no channel uses model " + in_quotes(one.name));
}

}  // namespace tessera::spec
