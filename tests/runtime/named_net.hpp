#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <deque>
#include <initializer_list>
#include <span>
#include <string_view>
#include <vector>

#include "tessera/tables.hpp"

/// Tables for tests and benchmarks that are written by hand: rows name places and ports, and `numbered` makes
/// the tables of a controller of them.
namespace tessera::testing {

// The memory of channels, as src/layers draws it.
inline constexpr FusedPlace asynchronous[] = {{"channel", 1, PlaceRole::lock}};
inline constexpr FusedPlace acknowledged[] = {
    {"empty", 1, PlaceRole::empty}, {"full", 0, PlaceRole::full}, {"ack", 0, PlaceRole::acknowledged}};
inline constexpr FusedPlace buffered[] = {acknowledged[0], acknowledged[1]};
// The same between processes. `networked_single` is for a sender that waits without a timeout.
inline constexpr FusedPlace networked_exchange[] = {{"sent_memory", 1, PlaceRole::sent_memory},
                                                    {"received_memory", 1, PlaceRole::received_memory}};
inline constexpr FusedPlace networked_single[] = {{"idle", 1, PlaceRole::idle},
                                                  {"sent", 0, PlaceRole::sent},
                                                  {"empty", 1, PlaceRole::empty},
                                                  {"full", 0, PlaceRole::full}};
inline constexpr FusedPlace networked[] = {networked_single[0],
                                           networked_single[1],
                                           networked_single[2],
                                           networked_single[3],
                                           {"more", 0, PlaceRole::more}};
inline const MediumTransition networked_medium[] = {{"deliver", Step::deliver, {1, 2}, {0, 3}},
                                                    {"replace", Step::replace, {1, 3}, {0, 3}},
                                                    {"older", Step::deliver_older, {4, 2}, {4, 3}},
                                                    {"lost", Step::lose_older, {4}, {1}}};
[[nodiscard]] inline std::span<const MediumTransition> medium_of(std::span<const FusedPlace> places) {
  const std::span<const MediumTransition> all = networked_medium;
  if (places.data() == networked) return all;
  return places.data() == networked_single ? all.first(1) : all.first(0);
}

// The pages above the subsystems, as src/layers draws them.
inline constexpr PagePlace system_places[] = {{"in", 1}, {"out"}}, agent_places[] = {{"in"}, {"out"}};
inline const PageTransition system_transitions[] = {{"t_in", Step::start_system, {0}, {entries}},
                                                    {"t_out", Step::end_system, {exits}, {1}}};
inline const PageTransition agent_transitions[] = {{"t_in", Step::start_agent, {0}, {entries}},
                                                   {"t_out", Step::end_agent, {exits}, {1}}};
inline const UpperPage system_page{system_places, system_transitions},
    agent_page{agent_places, agent_transitions};

namespace named {

struct Does {
  tessera::Does does{};
  std::string_view subject{};
};
[[nodiscard]] constexpr Does calls(std::string_view behaviour) { return {tessera::calls(0), behaviour}; }
[[nodiscard]] constexpr Does counts() { return {tessera::counts()}; }
[[nodiscard]] constexpr Does begins(std::string_view behaviour) { return {tessera::begins(0), behaviour}; }
[[nodiscard]] constexpr Does writes(std::string_view port, std::uint16_t slot = 1) {
  return {tessera::writes(0, slot), port};
}
[[nodiscard]] constexpr Does reads(std::string_view port, std::uint16_t slot = 1) {
  return {tessera::reads(0, slot), port};
}
[[nodiscard]] constexpr Does decides(std::string_view behaviour) { return {tessera::decides(0), behaviour}; }
[[nodiscard]] constexpr Does routes(std::string_view behaviour) { return {tessera::routes(0), behaviour}; }

/// The question of a subsystem with one behaviour.
[[nodiscard]] constexpr Does asks(std::string_view port) { return {tessera::asks(0, 0), port}; }

struct Place {
  std::string_view name;
  Does does{};
};

struct Guard {
  tessera::Guard guard{};
  std::string_view port{};
  constexpr Guard() = default;
  constexpr Guard(tessera::Guard given) : guard(given) {}  // NOLINT(google-explicit-constructor)
  constexpr Guard(tessera::Guard given, std::string_view of) : guard(given), port(of) {}
};
[[nodiscard]] constexpr Guard if_elapsed_at(std::string_view port) { return {tessera::if_elapsed, port}; }

/// Ends are "place", or "port/place" of a channel.
struct Transition {
  std::string_view name;
  std::initializer_list<std::string_view> inputs, outputs;
  Guard guard{};
};

/// The number of a name; that of no row if there is none.
template <class Rows>
[[nodiscard]] std::uint16_t number_of(const Rows& rows, std::string_view name) {
  const auto found =
      std::ranges::find(rows, name, [](const auto& row) { return std::string_view(row.name); });
  return static_cast<std::uint16_t>(found - std::ranges::begin(rows));
}

/// A list of a number of elements that only the running program knows. A program cannot write one.
[[nodiscard]] inline std::initializer_list<ArcEnd> list_of(const std::vector<ArcEnd>& ends) {
  struct List {
    const ArcEnd* first;
    std::size_t count;
  };
  return std::bit_cast<std::initializer_list<ArcEnd>>(List{ends.data(), ends.size()});
}

}  // namespace named

/// The tables of a net, which live until the program ends. memory: the places of the channels behind its ports;
/// others are asynchronous.
[[nodiscard]] inline SubsystemNet numbered(std::span<const Behaviour> behaviours, std::span<const Port> ports,
                                           std::span<const named::Place> places,
                                           std::span<const named::Transition> transitions,
                                           std::span<const FusedPlace> memory = acknowledged) {
  static std::deque<std::vector<Place>> all_places;
  static std::deque<std::vector<Transition>> all_transitions;
  static std::deque<std::vector<ArcEnd>> all_ends;
  using named::number_of;
  std::vector<Place>& made_places = all_places.emplace_back();
  for (const named::Place& place : places) {
    Does does = place.does.does;
    const bool of_port =
        does.kind == Does::Kind::write || does.kind == Does::Kind::read || does.kind == Does::Kind::ask;
    does.subject = of_port ? number_of(ports, place.does.subject) : number_of(behaviours, place.does.subject);
    made_places.push_back({place.name, does});
  }
  const auto in_memory = [&](std::string_view name) {
    const std::uint16_t number = number_of(memory, name);
    return number < memory.size() ? number : number_of(asynchronous, name);
  };
  const auto ends = [&](std::initializer_list<std::string_view> names) {
    std::vector<ArcEnd>& made = all_ends.emplace_back();
    for (const std::string_view name : names) {
      const std::size_t slash = name.find('/');
      if (slash == std::string_view::npos)
        made.push_back(number_of(places, name));
      else
        made.push_back({number_of(ports, name.substr(0, slash)), in_memory(name.substr(slash + 1))});
    }
    return named::list_of(made);
  };
  std::vector<Transition>& made = all_transitions.emplace_back();
  for (const named::Transition& transition : transitions) {
    Guard guard = transition.guard.guard;
    if (!transition.guard.port.empty()) guard.port = number_of(ports, transition.guard.port);
    const std::uint16_t behaviour =
        number_of(behaviours, transition.name.substr(0, transition.name.find('.')));
    made.push_back({transition.name,
                    ends(transition.inputs),
                    ends(transition.outputs),
                    guard,
                    {.behaviour = behaviour < behaviours.size() ? behaviour : nobody}});
  }
  return {behaviours, ports, made_places, made, number_of(places, "in"), number_of(places, "out")};
}

}  // namespace tessera::testing
