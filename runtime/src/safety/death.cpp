#include "safety/death.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <csignal>

#include "subsystem/subsystem_executor.hpp"
#include "system/thread_role.hpp"

namespace tessera {
namespace {

struct Name {
  int signal;
  std::string_view text;
};
constexpr std::array names{Name{SIGSEGV, "SIGSEGV"}, Name{SIGBUS, "SIGBUS"},   Name{SIGFPE, "SIGFPE"},
                           Name{SIGILL, "SIGILL"},   Name{SIGABRT, "SIGABRT"}, Name{SIGSYS, "SIGSYS"},
                           Name{SIGTRAP, "SIGTRAP"}};

/// Formats into a buffer of fixed size, without allocation.
template <class... Values>
[[nodiscard]] std::string_view put(std::span<char> room, fmt::format_string<Values...> format,
                                   Values&&... values) {
  const auto end = fmt::format_to_n(room.data(), room.size(), format, std::forward<Values>(values)...);
  return {room.data(), std::min(end.size, room.size())};
}

[[nodiscard]] std::string_view name_of(int signal) {
  const auto* const found =
      std::find_if(names.begin(), names.end(), [&](const Name& one) { return one.signal == signal; });
  return found == names.end() ? "a signal" : found->text;
}

}  // namespace

std::string_view describe(const Death& death, std::span<char> room) {
  switch (death.kind) {
    case Death::Kind::exit:
      return put(room, "called exit({})", death.number);
    case Death::Kind::quick_exit:
      return put(room, "called quick_exit");
    case Death::Kind::signal:
      break;
  }
  const std::string_view name = name_of(death.number);
  if (death.has_address) return put(room, "killed by {} at address {}", name, fmt::ptr(death.address));
  if (!death.detail.empty()) return put(room, "killed by {} ({})", name, death.detail);
  return put(room, "killed by {}", name);
}

std::string_view where_a_subsystem_is(const SubsystemExecutor& executor, std::span<char> room) {
  const Gauges& gauges = executor.gauges();
  const std::span<const Behaviour> behaviours = executor.operations().parts().instance->net->behaviours;
  const std::uint16_t behaviour = gauges.behaviour.load(std::memory_order_relaxed);
  if (gauges.called_at_ns.load(std::memory_order_relaxed) < 0 || behaviour >= behaviours.size())
    return executor.path();
  return put(room, "{}.{}", executor.path(), behaviours[behaviour].name);
}

std::string_view where_this_thread_is(std::span<char> room) {
  const SubsystemExecutor* const executor = RunningSubsystem::current();
  return executor == nullptr ? "the controller" : where_a_subsystem_is(*executor, room);
}

void complain_of_ended_thread(SubsystemExecutor& executor, RunControl& control) {
  std::array<char, 256> place_room, reason_room;
  const std::string_view place = where_a_subsystem_is(executor, place_room);
  const auto end =
      fmt::format_to_n(reason_room.data(), reason_room.size(),
                       "{}: user code has ended the thread of the subsystem (pthread_exit)", place);
  const std::string_view reason(reason_room.data(), std::min(end.size, reason_room.size()));
  control.request_stop(reason, /*fault=*/true);
  executor.record_death(reason);
}

}  // namespace tessera
