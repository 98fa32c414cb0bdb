#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tessera/controller.hpp"
#include "tessera/recording.hpp"

namespace tessera {

/// A point where user code acted differently from the recording.
struct Difference {
  std::string subsystem;
  Time at{};                ///< of the call of the transition function, or of the decision
  std::uint64_t iteration;  ///< of the subsystem
  std::string what;         ///< "motion.linear"; or a decision, a failure, a stop
  std::string recorded, computed;
};

/// The result of running user code again.
struct RerunReport {
  std::string recording;
  Duration recorded{};  ///< duration of the recorded run
  struct PerBuffer {
    std::string path;
    std::uint64_t differing = 0;  ///< iterations after which the buffer held another value
  };
  struct PerSubsystem {
    std::string path;
    std::uint64_t iterations = 0;  ///< that were run again and compared
    std::uint64_t decisions = 0;   ///< conditions that were decided differently
    std::vector<PerBuffer> outputs;
  };
  std::vector<PerSubsystem> subsystems;
  std::optional<Difference> first;  ///< the earliest one; nullopt: the code acts as in the recording
};

/// Runs the user's code of a controller again on recorded data. Every transition function and every
/// condition is called at the recorded time, with the recorded iteration and inputs. The results are
/// compared with the recorded ones. Whatever the results are, the next inputs and the path through the net
/// are the recorded ones. So every difference is caused by the user code itself; it can affect later
/// iterations only through the memory of the subsystem. Devices, world and channels are not needed.
/// Parameters, seed and planted faults are the recorded ones, followed by those of the options.
///
/// Errors: a recording that cannot be read, that belongs to another net or has other types of buffers, or
///         that lacks values, events or its beginning: nullopt and `error`.
///
/// Threads: as execute.
[[nodiscard]] std::optional<RerunReport> rerun(const System& system, RunOptions options,
                                               const std::string& recording, std::string& error);

/// As text for people.
[[nodiscard]] std::string rerun_text(const RerunReport& report);
/// As JSON for programs.
[[nodiscard]] std::string rerun_json(const RerunReport& report);

}  // namespace tessera
