#include "tessera/old_names.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace tessera {
namespace {

using Word = std::pair<std::string_view, Step>;

// These are literals and not tessera/net_words.hpp, because the names are in existing files.
constexpr std::array<Word, 6> of_behaviour{{{"t1", Step::begin_sending},
                                            {"t2", Step::end_sending},
                                            {"t3", Step::begin_receiving},
                                            {"t4", Step::go_on},
                                            {"t5", Step::terminal},
                                            {"t6", Step::error}}};
constexpr std::array<Word, 6> of_block{{{"t1o", Step::overwrite},
                                        {"skip", Step::skip},
                                        {"timeout", Step::timeout},
                                        {"withdraw", Step::timeout},
                                        {"withdraw_m", Step::timeout},
                                        {"recall", Step::timeout}}};
constexpr std::array<Word, 4> of_medium{{{"deliver", Step::deliver},
                                         {"replace", Step::replace},
                                         {"older", Step::deliver_older},
                                         {"lost", Step::lose_older}}};

template <std::size_t N>
[[nodiscard]] Step find(const std::array<Word, N>& words, std::string_view name, Step otherwise) {
  const auto found = std::ranges::find(words, name, &Word::first);
  return found == words.end() ? otherwise : found->second;
}

[[nodiscard]] std::string_view last_part(std::string_view name) { return name.substr(name.rfind('.') + 1); }

/// "t_follow_1" -> "follow"; empty: no such name.
[[nodiscard]] std::string_view left_behaviour(std::string_view local) {
  constexpr std::string_view leave = "t_";
  if (!local.starts_with(leave)) return {};
  local.remove_prefix(leave.size());
  const std::size_t last = local.rfind('_');
  if (last == std::string_view::npos || last + 1 == local.size()) return {};
  const std::string_view entry = local.substr(last + 1);
  const bool number = std::ranges::all_of(entry, [](char c) { return c >= '0' && c <= '9'; });
  return number ? local.substr(0, last) : std::string_view{};
}

/// A step of the system, an agent, or the medium of a channel.
[[nodiscard]] Step step_above(std::string_view name) {
  if (name.find("->") != std::string_view::npos) return find(of_medium, last_part(name), Step::other);
  const bool of_system = name.find('.') == std::string_view::npos;
  if (last_part(name) == "t_in") return of_system ? Step::start_system : Step::start_agent;
  if (last_part(name) == "t_out") return of_system ? Step::end_system : Step::end_agent;
  return Step::other;
}

/// page: "snd.motion.t1", "snd.t1".
[[nodiscard]] Step step_of_communication(std::string_view page) {
  const bool in_block = page.find('.') != page.rfind('.');
  return in_block ? find(of_block, last_part(page), Step::transfer) : Step::page;
}

[[nodiscard]] std::string_view local_name(std::string_view name, std::string_view subsystem) {
  const bool own =
      name.size() > subsystem.size() && name.starts_with(subsystem) && name[subsystem.size()] == '.';
  return own ? name.substr(subsystem.size() + 1) : name;
}

}  // namespace

TransitionRole role_of_old_name(std::string_view name, std::string_view subsystem) {
  if (subsystem.empty()) return {.step = step_above(name)};
  const std::string_view local = local_name(name, subsystem);
  if (local == "t_in") return {.step = Step::start};
  const std::size_t dot = local.find('.');
  if (dot == std::string_view::npos) {
    const std::string_view left = left_behaviour(local);
    return left.empty() ? TransitionRole{}
                        : TransitionRole{.step = Step::leave, .behaviour = std::string(left)};
  }
  TransitionRole read{.behaviour = std::string(local.substr(0, dot))};
  const std::string_view rest = local.substr(dot + 1);
  if (rest.find('.') == std::string_view::npos)
    read.step = find(of_behaviour, rest, Step::other);
  else if (rest.starts_with("snd.") || rest.starts_with("rcv."))
    read.step = step_of_communication(rest);
  return read;
}

}  // namespace tessera
