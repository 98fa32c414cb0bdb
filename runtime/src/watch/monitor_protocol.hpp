#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace tessera {

// The lines that a monitor and its clients send each other, which tessera/monitor.hpp describes.

/// What a client sees of a run at one moment.
struct Snapshot {
  struct Subsystem {
    std::string path;
    std::optional<std::string> behaviour;  ///< the last that was called; nullopt: none yet
    bool calling = false, ended = false;
    std::uint64_t iterations = 0, firings = 0, overruns = 0, errors = 0;
    double period_s = 0, called_at_s = 0, call_s = 0, longest_call_s = 0;
  };
  struct Channel {
    std::string name;
    std::vector<std::string> marked;  ///< its places with a token
  };
  /// What a run in simulated time has besides.
  struct Simulation {
    bool paused = false;
    std::uint64_t pauses = 0;  ///< how often it has come to rest
    double speed = 0;          ///< simulated seconds a second; 0: as fast as possible
    std::string broke_at;      ///< the place or transition whose breakpoint paused it; empty: none
  };
  std::string system;
  std::int64_t pid = 0;
  std::string net_hash;
  double time_s = 0;
  std::vector<Subsystem> subsystems;
  std::vector<Channel> channels;
  std::optional<std::string> emergency;  ///< why an emergency stop stands
  std::optional<std::string> recording;  ///< its file
  std::optional<Simulation> simulation;
};

/// Lines, with their ends. What is no UTF-8 (a path may be anything) is replaced.
[[nodiscard]] std::string to_line(const Snapshot& snapshot);
[[nodiscard]] std::string answer_line(std::int64_t id, const std::string& error);
/// Before a piece of the recording.
[[nodiscard]] std::string piece_line(std::size_t bytes, bool begins, bool more);
[[nodiscard]] std::string ended_line();

namespace commands {

/// It is no command, or a member has another type.
struct Malformed {};
struct SetParameter {
  std::string path, value;
};
struct EmergencyStop {
  std::string why;
};
struct Reset {};
struct SendRecording {};
struct Own {};

// For runs in simulated time.
struct Pause {};
struct Resume {};
struct StepFiring {};
struct StepIteration {
  std::string subsystem;  ///< empty: any
};
struct SetSpeed {
  std::optional<double> value;  ///< nullopt: it is no number
};
struct SetBreakpoints {
  std::vector<std::string> places, transitions, conditions;  ///< names; empty: one that is no text
};
/// Its name is unknown.
struct Unknown {};

}  // namespace commands

using SimulationCommand =
    std::variant<commands::Unknown, commands::Pause, commands::Resume, commands::StepFiring,
                 commands::StepIteration, commands::SetSpeed, commands::SetBreakpoints>;
/// Each is answered by a line.
using AnsweredCommand = std::variant<commands::Malformed, commands::SetParameter, commands::EmergencyStop,
                                     commands::Reset, SimulationCommand>;
using Command = std::variant<AnsweredCommand, commands::SendRecording, commands::Own>;

struct Request {
  std::int64_t id = 0;  ///< for the answer
  Command command;
};
/// Never throws for what a client sends.
[[nodiscard]] Request parse_request(const std::string& line);

}  // namespace tessera
