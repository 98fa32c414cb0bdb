// Paths of memory cells with few values: "dock.control.memory.lent_to == nobody".

#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "diagnostics/utf8.hpp"
#include "layers/net_paths.hpp"
#include "tessera/nearest.hpp"

namespace tessera::layers {
namespace {

using diagnostics::Diagnostics;
using diagnostics::in_quotes;
using Compared = spec::Comparison::Kind;

bool is_order(Compared kind) { return kind != Compared::equal && kind != Compared::unequal; }

std::optional<std::int64_t> number_in(std::string_view text) {
  std::int64_t number = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && stop == end ? std::optional(number) : std::nullopt;
}

bool fits(std::int64_t value, Compared kind, std::int64_t other) {
  switch (kind) {
    case Compared::equal:
      return value == other;
    case Compared::unequal:
      return value != other;
    case Compared::less:
      return value < other;
    case Compared::less_equal:
      return value <= other;
    case Compared::greater:
      return value > other;
    case Compared::greater_equal:
      return value >= other;
  }
  return false;
}

/// The positions of the values that fit; nullopt: the comparison is a mistake.
std::optional<std::vector<std::uint32_t>> fitting(const spec::Field& cell, const spec::Comparison& compared,
                                                  Diagnostics& out) {
  const spec::FewValues& few = *cell.few;
  const std::string name = "memory." + cell.name;
  std::optional<std::int64_t> other = number_in(compared.value.name);
  if (!few.counts) {
    if (is_order(compared.kind)) {
      out.error("E263", compared.at, in_quotes(name) + " has values without an order",
                "compare it with == or !=");
      return std::nullopt;
    }
    const auto found = few.find(compared.value.name);
    other = found ? std::optional<std::int64_t>(*found) : std::nullopt;
  }
  if (!other) {
    Hint hint = did_you_mean(compared.value.name, few.names);
    if (hint.empty()) hint.text = "it is " + few.in_words();
    out.error("E261", compared.value.span,
              "unknown value " + in_quotes(compared.value.name) + " of " + in_quotes(name), std::move(hint));
    return std::nullopt;
  }
  std::vector<std::uint32_t> positions;
  for (std::uint32_t value = 0; value < few.names.size(); ++value)
    if (fits(few.counts ? std::int64_t{few.least} + value : value, compared.kind, *other))
      positions.push_back(value);
  if (!positions.empty() && positions.size() < few.names.size()) return positions;
  out.error("E264", compared.value.span,
            in_quotes(name) + (positions.empty() ? " never fits this" : " always fits this"),
            "it is " + few.in_words());
  return std::nullopt;
}

}  // namespace

net::PageId NetPaths::owner_of_memory(const spec::Statement& token) const {
  const std::vector<spec::PathPart>& parts = token.path.parts;
  const auto agent = agents_.find(token.path.agent);
  if (agent == agents_.end() || parts.size() < 2 || parts[1].name != "memory") return {};
  for (const net::PageId below : below_[agent->second.value]) {
    const net::Page& page = pages_.pages[below.value];
    if (page.name != parts[0].name) continue;
    const auto& behaviours = model_.subsystem(page.subsystem).behaviours;
    const bool is_behaviour = std::ranges::count(behaviours, parts[1].name, &spec::Behaviour::name) > 0;
    return is_behaviour && !token.compared ? net::PageId{} : below;
  }
  return {};
}

/// AGENT.SUBSYSTEM.memory.CELL == VALUE
std::optional<net::Statement> NetPaths::of_memory(net::PageId id, const spec::Statement& token,
                                                  Diagnostics& out) const {
  const net::Page& page = pages_.pages[id.value];
  const std::vector<spec::Field>& memory = model_.subsystem(page.subsystem).memory;
  const std::vector<spec::PathPart>& parts = token.path.parts;
  if (parts.size() != 3) {
    out.error("E112", parts.back().span, "a memory cell should follow, and nothing behind it",
              "for example dock.control.memory.lent_to == nobody");
    return std::nullopt;
  }
  const auto cell = std::ranges::find(memory, parts[2].name, &spec::Field::name);
  if (cell == memory.end()) {
    std::vector<std::string> names;
    for (const spec::Field& one : memory)
      if (one.few) names.push_back(one.name);
    out.error("E101", parts[2].span,
              "unknown memory " + in_quotes(parts[2].name) + " in " + in_quotes(pages_.path(id)),
              did_you_mean(parts[2].name, names));
    return std::nullopt;
  }
  if (!cell->few) {
    out.error(
        "E265", parts[2].span, in_quotes("memory." + cell->name) + " has a type, so it is no part of the net",
        "declare its values instead: " + cell->name + ": { values: [nobody, a, b] }, or { counts: 0..4 }");
    return std::nullopt;
  }
  if (!token.compared) {
    out.error("E112", parts[2].span,
              in_quotes("memory." + cell->name) + " is " + cell->few->in_words() + ": which?",
              "write " + pages_.path(id) + ".memory." + cell->name + " == " + cell->few->names.front());
    return std::nullopt;
  }
  const auto positions = fitting(*cell, *token.compared, out);
  if (!positions) return std::nullopt;
  const std::string path = pages_.path(id) + ".memory." + cell->name;
  net::Statement statement;
  for (const std::uint32_t value : *positions)
    statement.places.push_back(places_.at(path + "." + cell->few->names[value]));
  return statement;
}

}  // namespace tessera::layers
