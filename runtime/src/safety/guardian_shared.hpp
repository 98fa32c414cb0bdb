#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "safety/guardian.hpp"

namespace tessera {

/// Stored in memory that both processes have mapped.
struct Guardian::Shared {
  enum class Stage : std::uint32_t {
    starts,    ///< the guardian makes its drivers
    ready,     ///< it watches the life of the controller
    failed,    ///< it cannot make its drivers
    beating,   ///< it also watches the beats
    dismissed  ///< it ends
  };
  std::atomic<Stage> stage{Stage::starts};
  std::atomic<bool> dying{false}, has_acted{false};
  std::atomic<std::uint64_t> beats{0};          ///< of the controller
  std::atomic<std::uint64_t> signs_of_life{0};  ///< of the guardian
  char error[1024]{};                           ///< set if it failed
};
static_assert(std::atomic<Guardian::Shared::Stage>::is_always_lock_free &&
              std::atomic<std::uint64_t>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

/// The main function of the guardian's process. Does not return.
[[noreturn]] void live_as_guardian(const System& system, const RunOptions& options, Guardian::Shared& shared,
                                   int news, pid_t controller);

/// The real drivers of effectors that such a run opens and that a guardian can serve.
[[nodiscard]] std::vector<const CppDriver*> guarded_drivers(const System& system, const RunOptions& options);

/// The real drivers of effectors that such a run opens and that no guardian makes safe.
[[nodiscard]] std::vector<std::string> effectors_without_guardian(const System& system,
                                                                  const RunOptions& options);

}  // namespace tessera
