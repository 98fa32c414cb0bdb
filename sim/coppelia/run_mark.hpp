#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace tessera::coppelia {

/// Identifies the process that simulates. A run leaves it in CoppeliaSim, so that the next run can tell an
/// abandoned simulation from one that is in use.
struct RunMark {
  std::string machine;  ///< identifies the machine since its boot; a container is a machine of its own
  std::string host;
  std::int64_t process = 0;
  std::string began;        ///< because process numbers are reused
  bool has_loaded = false;  ///< the run has loaded the scene that is open
};

enum class Owner : std::uint8_t { lives, has_gone, on_another_machine };

[[nodiscard]] RunMark mark_of_this_process(bool has_loaded);
[[nodiscard]] Owner owner_of(const RunMark& mark);

[[nodiscard]] std::string text_of(const RunMark& mark);
/// nullopt: the text is no mark.
[[nodiscard]] std::optional<RunMark> mark_of(const std::string& text);

}  // namespace tessera::coppelia
