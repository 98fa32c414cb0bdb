#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "drivers/panel.hpp"
#include "subsystem/memory_gauge.hpp"
#include "tessera/result.hpp"

namespace tessera {

// The lines that a monitor and its clients send each other. tessera/monitor.hpp describes them.

/// The state of a run at one moment, as a client sees it.
struct Snapshot {
  struct Subsystem {
    std::string path;
    std::optional<std::string> behaviour;  ///< the behaviour called last; nullopt: none yet
    bool calling = false, ended = false;
    std::uint64_t iterations = 0, firings = 0, overruns = 0, errors = 0;
    double period_s = 0, called_at_s = 0, call_s = 0, longest_call_s = 0;
    std::vector<MemoryGauge::Field> memory;
  };
  struct Channel {
    std::string name;
    std::vector<std::string> marked;  ///< its places with a token
    /// Since when a value has been on the way to another process without an answer.
    std::optional<double> sending_since_s;
  };
  /// A subsystem at rest that can go on only, or sooner, if the subsystem at the other end of a channel acts.
  struct Wait {
    std::string subsystem, waits_for, channel;  ///< two paths, and a name
    bool for_answer = false;                    ///< it waits for the acknowledgement of its value; false: for
                                                ///< a value
    std::string process;                        ///< process of the other end; empty: this one
    double since_s = 0;
  };
  /// The link between this process and another.
  struct Link {
    std::string process, host;  ///< the other one; host empty: none is given
    bool reachable = false;
    double since_s = 0;             ///< of `reachable`
    std::optional<double> heard_s;  ///< its newest message; nullopt: none yet
    std::uint64_t sent = 0, repeated = 0, received = 0, duplicates = 0;  ///< as LinkGauges
    std::uint32_t signs = 0, signs_lost = 0;                             ///< among its newest signs of life
    std::optional<double> clock_ahead_s;                                 ///< by its wall clock
    double clock_uncertainty_s = 0;
  };
  /// The part of a deployed system that this process is.
  struct Process {
    std::string name, host;
    std::uint64_t incarnation = 0;
  };
  /// The network on which the processes of the system meet, as this run was told, and their names.
  struct Deployment {
    int domain = 0;
    std::string interface;
    std::vector<std::string> peers;
    struct Process {
      std::string name, host;  ///< host empty: none is given
    };
    std::vector<Process> processes;
  };
  /// Additional state of a run in simulated time.
  struct Simulation {
    bool paused = false;       ///< it stands still, and all its firings are in its recording
    std::uint64_t pauses = 0;  ///< how often it has been paused
    double speed = 0;          ///< simulated seconds a second; 0: as fast as possible
    std::string broke_at;      ///< the place or transition whose breakpoint paused it; empty: none
  };
  std::string system;
  std::int64_t pid = 0;
  std::string net_hash;
  double time_s = 0;
  std::vector<Subsystem> subsystems;
  std::vector<Channel> channels;
  std::vector<Wait> waits;
  std::optional<Process> process;        ///< nullopt: all agents run here
  std::vector<Link> links;               ///< only of a process
  std::optional<std::string> emergency;  ///< the reason of the current emergency stop
  std::optional<std::string> recording;  ///< its file
  std::optional<Simulation> simulation;
  std::optional<Deployment> deployment;  ///< only in the first line of a connection
  bool brief = false;                    ///< lists are left out: of the network
  std::uint64_t left_out = 0;            ///< members of lists for which a message of the network has no room
};

/// One line, with its line end. Text that is not UTF-8 is replaced (a path may hold any bytes).
[[nodiscard]] std::string to_line(const Snapshot& snapshot);
/// wrong: the mistake in the command. is_elsewhere: it is only that no part of this process has that name.
[[nodiscard]] std::string answer_line(std::int64_t id, const std::optional<Problem>& wrong,
                                      bool is_elsewhere = false);
/// The line before a piece of the recording.
[[nodiscard]] std::string piece_line(std::size_t bytes, bool begins, bool more);
/// The line before a piece of the scene. total: bytes of the whole.
[[nodiscard]] std::string scene_line(std::size_t bytes, std::uint64_t from, std::uint64_t total);
[[nodiscard]] std::string ended_line();

namespace commands {

/// Not a command, or a member has the wrong type.
struct Malformed {};
struct SetParameter {
  std::string path, value;
  bool only_try = false;  ///< the answer says whether the value fits; nothing changes
};
/// The input of an operator, or of one who lets go.
struct FeedPanel {
  PanelInput input;
};
struct EmergencyStop {
  std::string why;
};
struct Reset {};
struct SendRecording {};
struct SendScene {
  std::uint64_t from = 0;
};
struct Own {};

// For runs in simulated time.
struct Pause {};
struct Resume {};
struct StepFiring {};
struct StepIteration {
  std::string subsystem;  ///< empty: any
};
struct SetSpeed {
  std::optional<double> value;  ///< nullopt: not a number
};
struct SetBreakpoints {
  std::vector<std::string> places, transitions, conditions;  ///< names; an empty one was not a text
};
/// A command with an unknown name.
struct Unknown {};

}  // namespace commands

using SimulationCommand =
    std::variant<commands::Unknown, commands::Pause, commands::Resume, commands::StepFiring,
                 commands::StepIteration, commands::SetSpeed, commands::SetBreakpoints>;
/// Commands that are answered by a line each.
using AnsweredCommand = std::variant<commands::Malformed, commands::SetParameter, commands::FeedPanel,
                                     commands::EmergencyStop, commands::Reset, SimulationCommand>;
using Command = std::variant<AnsweredCommand, commands::SendRecording, commands::SendScene, commands::Own>;

struct Request {
  std::int64_t id = 0;  ///< for the answer
  Command command;
};
/// Never throws, whatever a client sends.
[[nodiscard]] Request parse_request(const std::string& line);

}  // namespace tessera
