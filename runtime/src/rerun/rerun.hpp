#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tessera/controller.hpp"
#include "tessera/recording.hpp"

namespace tessera {

/// Where user code did something else than in the recording.
struct Difference {
  std::string subsystem;
  Time at{};                ///< of the call of the transition function, or of the decision
  std::uint64_t iteration;  ///< of the subsystem
  std::string what;         ///< "motion.linear"; or a decision, a failure, a stop
  std::string recorded, computed;
};

/// What came of running user code again.
struct RerunReport {
  std::string recording;
  Duration recorded{};  ///< how long the run was
  struct PerBuffer {
    std::string path;
    std::uint64_t differing = 0;  ///< iterations after which it held another value
  };
  struct PerSubsystem {
    std::string path;
    std::uint64_t iterations = 0;  ///< that were run again and compared
    std::uint64_t decisions = 0;   ///< that were made in another way
    std::vector<PerBuffer> outputs;
  };
  std::vector<PerSubsystem> subsystems;
  std::optional<Difference> first;  ///< by time; nullopt: it does what it did
};

/// Runs the user's code of a controller again on what a recording says it was given: every transition
/// function and condition is called at the time, with the iteration and with the inputs that are recorded,
/// and what it makes of them is compared with what is recorded. Whatever it makes, the next inputs and the
/// path through the net are the recorded ones, so every difference is the user code's own, and none follows
/// from another but by way of what the subsystem remembers. Devices, world and channels are not needed;
/// parameters, seed and injected faults are the recorded ones, after which those of the options come.
///
/// Errors: a recording that cannot be read, is of another net or of other types of buffers, lacks values or
/// events or its beginning: nullopt and `error`.
///
/// Threads: as execute.
[[nodiscard]] std::optional<RerunReport> rerun(const System& system, RunOptions options,
                                               const std::string& recording, std::string& error);

/// For people.
[[nodiscard]] std::string rerun_text(const RerunReport& report);
/// For machines.
[[nodiscard]] std::string rerun_json(const RerunReport& report);

}  // namespace tessera
