#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace tessera::spec {

/// One of several equal parts of a subsystem, one for each member of a fleet ("Request[each robot]",
/// `for: each robot`). The parts of a family follow one another in the order of the fleet. Everything but code,
/// drawings and messages treats each as an ordinary part.
struct Member {
  std::string family;        ///< their name in the file: "request"; that of the part is "request[3]"
  std::string fleet;         ///< "robot"
  std::uint32_t number = 0;  ///< of the member of the fleet
  std::uint32_t count = 1;   ///< of the fleet

  bool operator==(const Member&) const = default;
};

/// "request[3]"
[[nodiscard]] inline std::string name_of_member(const std::string& family, std::uint32_t number) {
  return family + "[" + std::to_string(number) + "]";
}

/// "lend[0]"
[[nodiscard]] inline std::string first_of(const Member& family) { return name_of_member(family.family, 0); }

/// " (and 2 more)": parts of the family of `id` besides it for which `such` holds. nullopt: one before it does, and the
/// message about that one has counted this one.
template <class Id, class Parts, class Such>
[[nodiscard]] std::optional<std::string> others_of_family(const Parts& parts, Id id, Such such) {
  if (!parts[id].member) return std::string();
  const Member& member = *parts[id].member;
  std::uint32_t count = 0;
  for (std::uint32_t number = 0; number < member.count; ++number) {
    const Id other{id.value - member.number + number};
    if (other == id || !such(other)) continue;
    if (number < member.number) return std::nullopt;
    ++count;
  }
  return count == 0 ? std::string() : " (and " + std::to_string(count) + " more)";
}

}  // namespace tessera::spec
