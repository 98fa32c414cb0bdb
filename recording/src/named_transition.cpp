#include "tessera/named_transition.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "tessera/net_words.hpp"

namespace tessera {
namespace {

using Kind = NamedTransition::Kind;

/// "t_follow_1" -> "follow"; empty: no such name.
std::string_view left_behaviour(std::string_view local) {
  if (!local.starts_with(words::leave)) return {};
  local.remove_prefix(words::leave.size());
  const std::size_t last = local.rfind('_');
  if (last == std::string_view::npos || last + 1 == local.size()) return {};
  const std::string_view entry = local.substr(last + 1);
  const bool number = std::ranges::all_of(entry, [](char c) { return c >= '0' && c <= '9'; });
  return number ? local.substr(0, last) : std::string_view{};
}

Kind of_behaviour(std::string_view step) {
  constexpr std::array<std::pair<std::string_view, Kind>, 4> steps{
      {{words::begin_sending, Kind::begin_iteration},
       {words::go_on, Kind::go_on},
       {words::terminal, Kind::terminal},
       {words::error, Kind::error}}};
  for (const auto& [name, kind] : steps)
    if (name == step) return kind;
  return Kind::other;
}

}  // namespace

std::string_view local_name(std::string_view name, std::string_view subsystem) {
  const bool own =
      name.size() > subsystem.size() && name.starts_with(subsystem) && name[subsystem.size()] == '.';
  return own ? name.substr(subsystem.size() + 1) : name;
}

NamedTransition named_transition(std::string_view name, std::string_view subsystem) {
  const std::string_view local = local_name(name, subsystem);
  if (local == words::start) return {.kind = Kind::start};
  const std::size_t dot = local.find('.');
  if (dot == std::string_view::npos) {
    const std::string_view left = left_behaviour(local);
    return left.empty() ? NamedTransition{} : NamedTransition{.kind = Kind::leave, .behaviour = left};
  }
  NamedTransition read{.behaviour = local.substr(0, dot)};
  const std::string_view rest = local.substr(dot + 1);
  const std::size_t page_end = rest.find('.');
  if (page_end == std::string_view::npos) {
    read.kind = of_behaviour(rest);
    return read;
  }
  const std::string_view page = rest.substr(0, page_end);
  if (page != words::send_page && page != words::receive_page) return read;
  read.kind = Kind::communication;
  const std::string_view step = rest.substr(rest.rfind('.') + 1);
  read.timeout = step == words::timeout;
  read.skip = step == words::skip;
  read.overwrite = step == words::overwrite;
  return read;
}

}  // namespace tessera
