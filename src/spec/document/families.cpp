#include "spec/document/families.hpp"

#include <algorithm>
#include <charconv>

#include "diagnostics/utf8.hpp"
#include "spec/document/names.hpp"
#include "tessera/nearest.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

constexpr std::string_view each_word = "each";
constexpr std::uint32_t largest_fleet_size = 100'000;  // as fleets.cpp has it
constexpr std::int64_t largest_offset = 1'000'000;     // more than any fleet has

const Entry* key_of(const Node& agent, std::string_view key) {
  const auto found = std::ranges::find(agent.entries, key, &Entry::key);
  return found == agent.entries.end() ? nullptr : &*found;
}

/// A count with a mistake counts as 1, which read_agents takes, too.
std::uint32_t count_in(const Node& text) {
  std::uint32_t count = 0;
  const char* const end = text.text.data() + text.text.size();
  const auto [stop, error] = std::from_chars(text.text.data(), end, count);
  const bool good = stop == end && error == std::errc() && count >= 1 && count <= largest_fleet_size;
  return good ? count : 1;
}

bool is_ring(const Node& agent) {
  const Entry* ring = key_of(agent, "ring");
  return ring != nullptr && ring->value->text == "true" && !ring->value->quoted;
}

bool is_blank_letter(char letter) { return letter == ' ' || letter == '\t'; }

/// The part of a text without the blanks around it.
std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank_letter(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank_letter(text.back())) text.remove_suffix(1);
  return text;
}

}  // namespace

FleetSizes::FleetSizes(const Entry* agents) {
  if (agents == nullptr || !agents->value->is_map()) return;
  for (const Entry& agent : agents->value->entries) {
    const Entry* count = key_of(*agent.value, "count");
    sizes_.emplace(agent.key, count != nullptr
                                  ? std::optional(FleetSize{count_in(*count->value), is_ring(*agent.value)})
                                  : std::nullopt);
  }
}

std::optional<FleetSize> FleetSizes::find(const std::string& name) const {
  const auto found = sizes_.find(name);
  return found == sizes_.end() ? std::nullopt : found->second;
}

bool FleetSizes::is_one_agent(const std::string& name) const {
  const auto found = sizes_.find(name);
  return found != sizes_.end() && !found->second;
}

std::vector<std::string> FleetSizes::names() const {
  std::vector<std::string> all;
  for (const auto& [name, count] : sizes_)
    if (count) all.push_back(name);
  return all;
}

std::optional<std::uint32_t> EachMember::neighbour(std::uint32_t number, std::int64_t offset) const {
  const std::int64_t size = count;
  const std::int64_t at = number + offset % (ring ? size : largest_offset);
  if (ring) return static_cast<std::uint32_t>((at + size) % size);
  return at >= 0 && at < size ? std::optional(static_cast<std::uint32_t>(at)) : std::nullopt;
}

bool says_each(std::string_view text) {
  text = trimmed(text);
  return text == each_word || (text.starts_with(each_word) && is_blank_letter(text[each_word.size()]));
}

std::optional<EachMember> read_each(const Node& text, std::size_t offset, std::size_t length,
                                    const FleetSizes* fleets, Diagnostics& out) {
  const std::string_view whole = trimmed(std::string_view(text.text).substr(offset, length));
  const auto span = [&](std::string_view part) {
    return text.part(static_cast<std::size_t>(part.data() - text.text.data()),
                     std::max<std::size_t>(part.size(), 1));
  };
  const std::string_view name =
      says_each(whole) ? trimmed(whole.substr(each_word.size())) : std::string_view();
  const std::vector<std::string> known = fleets == nullptr ? std::vector<std::string>{} : fleets->names();
  const std::string example = "each " + (known.empty() ? "robot" : known.front());
  if (!is_identifier(name)) {
    out.error("E290", span(whole), in_quotes(whole) + " does not name the members of a fleet",
              "write " + example);
    return std::nullopt;
  }
  const std::string fleet(name);
  if (fleets != nullptr)
    if (const auto size = fleets->find(fleet)) return EachMember{fleet, size->count, size->ring};
  if (fleets != nullptr && fleets->is_one_agent(fleet)) {
    out.error("E285", span(name), in_quotes(fleet) + " is one agent, not a fleet",
              "give it a count: " + fleet + ": { count: 2, control: ... }");
    return std::nullopt;
  }
  Hint hint = did_you_mean(fleet, known);
  if (hint.empty())
    hint = known.empty() ? Hint("a fleet is an agent with a count: robot: { count: 2, control: ... }")
                         : Hint("write " + example);
  out.error("E285", span(name), "there is no fleet " + in_quotes(fleet), std::move(hint));
  return std::nullopt;
}

std::optional<EachInType> each_in(std::string_view type) {
  for (std::size_t open = type.find('['); open != std::string_view::npos; open = type.find('[', open + 1)) {
    const std::size_t close = type.find(']', open);
    if (close == std::string_view::npos) return std::nullopt;
    if (says_each(type.substr(open + 1, close - open - 1))) return EachInType{open, close + 1};
  }
  return std::nullopt;
}

namespace {

/// "i", "i+1", "i - 2": what is added to i.
std::optional<std::int64_t> offset_in(std::string_view index) {
  if (!index.starts_with('i')) return std::nullopt;
  index = trimmed(index.substr(1));
  if (index.empty()) return 0;
  const char sign = index.front();
  const std::string_view digits = trimmed(index.substr(1));
  std::int64_t offset = 0;
  const char* const end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, offset);
  const bool good = (sign == '+' || sign == '-') && !digits.empty() && digits.front() != '-' && stop == end &&
                    error == std::errc() && offset < largest_offset;
  return good ? std::optional(sign == '-' ? -offset : offset) : std::nullopt;
}

}  // namespace

std::optional<IndexedName> read_indexed(const Node& text, std::size_t offset, Diagnostics& out) {
  const std::string_view all = std::string_view(text.text).substr(offset);
  IndexedName read;
  const std::size_t open = all.find('[');
  read.name = all.substr(0, open);
  read.span = text.part(offset, std::max<std::size_t>(read.name.size(), 1));
  if (open == std::string_view::npos || !all.ends_with(']')) return read;
  const std::string_view written = all.substr(open + 1, all.size() - open - 2);
  const std::string_view index = trimmed(written);
  read.index_span = text.part(offset + open + 1, std::max<std::size_t>(written.size(), 1));
  if (const auto offset = offset_in(index)) {
    read.index = IndexedName::Index::variable;
    read.offset = *offset;
    return read;
  }
  const char* const end = index.data() + index.size();
  const auto [stop, error] = std::from_chars(index.data(), end, read.number);
  if (index.empty() || stop != end || error != std::errc()) {
    out.error("E289", read.index_span, in_quotes(written) + " is no index of a member",
              "write a number, or i: " + read.name + "[0], " + read.name + "[i]");
    return std::nullopt;
  }
  read.index = IndexedName::Index::constant;
  return read;
}

std::optional<std::uint32_t> number_of(const IndexedName& name, const Member& family, const Member* member,
                                       std::string_view what, Diagnostics& out) {
  using Index = IndexedName::Index;
  // There is an error about the fleet already.
  if (family.fleet.empty() || (member != nullptr && member->fleet.empty())) return 0;
  const std::string owner = "one " + std::string(what) + " for each " + family.fleet;
  if (name.index == Index::none) {
    out.error("E287", name.span, in_quotes(name.name) + " is " + owner + ": which?",
              "write " + name.name + "[0]" +
                  (member != nullptr && member->fleet == family.fleet ? ", or " + name.name + "[i]" : ""));
    return std::nullopt;
  }
  if (name.index == Index::constant) {
    if (name.number < family.count) return name.number;
    out.error("E289", name.index_span,
              in_quotes(name.name) + " has no member " + std::to_string(name.number) + ": it is " + owner,
              "the members are numbered 0 to " + std::to_string(family.count - 1));
    return std::nullopt;
  }
  if (member == nullptr) {
    out.error("E288", name.index_span, "'i' stands for no member here",
              "it does within a behaviour with 'for: each " + family.fleet +
                  "', and in an entry of 'next' that leads to such a behaviour");
    return std::nullopt;
  }
  if (member->fleet == family.fleet && name.is_neighbour()) {
    out.error("E289", name.index_span, "only an entry of 'next' leads to another member than i",
              "write " + name.name + "[i], or " + name.name + "[0]");
    return std::nullopt;
  }
  if (member->fleet == family.fleet) return member->number;
  out.error("E292", name.index_span,
            "'i' counts over fleet " + in_quotes(member->fleet) + " here, and " + in_quotes(name.name) +
                " is " + owner,
            "only what is for each " + member->fleet + " has the index i here");
  return std::nullopt;
}

bool check_single(const IndexedName& name, std::string_view what, Diagnostics& out) {
  if (name.index == IndexedName::Index::none) return true;
  out.error("E286", name.index_span,
            in_quotes(name.name) + " is one " + std::string(what) + ", not one for each member of a fleet",
            "write " + name.name + " without an index");
  return false;
}

}  // namespace tessera::spec
