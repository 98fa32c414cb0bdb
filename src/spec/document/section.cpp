#include "spec/document/section.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "diagnostics/utf8.hpp"
#include "tessera/nearest.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

/// The position for a complaint about a value: the value itself if it is text, else its key.
Span span_of(const Node& node, Span at) { return node.is_scalar() ? node.span : at; }

std::string found(const Node& node) {
  switch (node.kind) {
    case Node::Kind::null:
      return "nothing";
    case Node::Kind::scalar:
      return in_quotes(node.text);
    case Node::Kind::sequence:
      return "a list";
    case Node::Kind::map:
      break;
  }
  return "a map";
}

void complain(const Node& node, Span at, std::string_view what, std::string_view wanted, std::string hint,
              Diagnostics& out) {
  out.error("E104", span_of(node, at),
            std::string(what) + " must be " + std::string(wanted) + ", not " + found(node), std::move(hint));
}

template <std::size_t N>
bool one_of(const Node& node, const std::array<std::string_view, N>& words) {
  return node.is_scalar() && !node.quoted && std::find(words.begin(), words.end(), node.text) != words.end();
}

std::string list_of(const std::vector<std::string>& words) {
  std::string result;
  for (const std::string& word : words) result += (result.empty() ? "" : ", ") + word;
  return result;
}

/// Keys that are looked for in a place above their own, and what has them.
constexpr std::array keys_below = std::to_array<std::pair<std::string_view, const char*>>({
    {"takes", "a behaviour has it: behaviours: { follow: { takes: 1..3 ms } }"},
    {"age",
     "a chain has it: chains: [{ name: stop, path: [robot.eye, robot.control, robot.motor], age: 100 ms }]"},
    {"reaction",
     "a chain has it: chains: [{ name: stop, path: [robot.eye, robot.control, robot.motor], reaction: 100 ms "
     "}]"},
});

}  // namespace

Section::Section(const Node& node, Span at, std::string what, std::initializer_list<std::string_view> keys,
                 Diagnostics& out)
    : at_(at), what_(std::move(what)), out_(out) {
  if (!node.is_map() && !node.is_null()) {
    complain(node, at, what_, "a map of keys", {}, out);
    return;
  }
  node_ = &node;
  for (const Entry& entry : node.entries) {
    if (std::find(keys.begin(), keys.end(), entry.key) != keys.end()) continue;
    const std::vector<std::string> known(keys.begin(), keys.end());
    unknown_keys_ = true;
    guesses_.push_back(nearest(entry.key, known));
    Hint hint = did_you_mean(entry.key, known);
    if (entry.key == "<<") hint = "merge keys are not read; use a template of agents or an alias";
    if (hint.empty())
      if (const auto* const below =
              std::ranges::find(keys_below, entry.key, &std::pair<std::string_view, const char*>::first);
          below != keys_below.end())
        hint = below->second;
    if (hint.empty()) hint = what_ + " has " + list_of(known);
    out.error("E102", entry.span, "unknown key " + in_quotes(entry.key), hint);
  }
}

const Entry* Section::find(std::string_view key) const {
  if (node_ == nullptr) return nullptr;
  const auto entry = std::find_if(node_->entries.begin(), node_->entries.end(),
                                  [key](const Entry& one) { return one.key == key; });
  return entry == node_->entries.end() ? nullptr : &*entry;
}

const Entry* Section::require(std::string_view key, std::string hint) const {
  const Entry* entry = find(key);
  const bool guessed = std::find(guesses_.begin(), guesses_.end(), key) != guesses_.end();
  if (entry == nullptr && node_ != nullptr && !guessed) {
    out_.error("E103", at_, what_ + " needs '" + std::string(key) + "'", std::move(hint));
  }
  return entry;
}

const Entry* entry_in(const Entry& section, std::string_view key) {
  const std::vector<Entry>& entries = section.value->entries;
  const auto found = std::ranges::find(entries, key, &Entry::key);
  return found == entries.end() ? nullptr : &*found;
}

const std::vector<Entry>& entries_of(const Node& node, Span at, std::string_view what, Diagnostics& out) {
  if (!node.is_map() && !node.is_null()) complain(node, at, what, "a map", "write NAME: VALUE", out);
  return node.entries;
}

const std::vector<const Node*>& items_of(const Node& node, Span at, std::string_view what, Diagnostics& out,
                                         std::string hint) {
  if (!node.is_sequence() && !node.is_null()) complain(node, at, what, "a list", std::move(hint), out);
  return node.items;
}

const Node* text_of(const Node& node, Span at, std::string_view what, Diagnostics& out, std::string hint) {
  if (node.is_scalar() && node.text.find_first_not_of(" \t\r\n") != std::string::npos) return &node;
  complain(node, at, what, "text", std::move(hint), out);
  return nullptr;
}

bool bool_of(const Entry& entry, std::string_view what, Diagnostics& out) {
  if (!is_true(*entry.value) && !is_false(*entry.value))
    complain(*entry.value, entry.span, what, "true or false", {}, out);
  return is_true(*entry.value);
}

bool is_true(const Node& node) {
  return one_of(node, std::to_array<std::string_view>({"true", "True", "TRUE"}));
}

bool is_false(const Node& node) {
  return one_of(node, std::to_array<std::string_view>({"false", "False", "FALSE"}));
}

bool is_old_boolean(const Node& node) {
  return one_of(node, std::to_array<std::string_view>({"yes", "Yes", "no", "No", "on", "On", "off", "Off"}));
}

}  // namespace tessera::spec
