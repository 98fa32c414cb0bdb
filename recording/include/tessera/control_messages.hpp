#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "tessera/result.hpp"

/// The messages of the control socket of a running controller (tessera/monitor.hpp), for both of its ends.
/// share/tessera/control_socket.schema.json defines them.
namespace tessera {

/// The state of a controller at one moment.
struct Snapshot {
  /// A field of the memory of a subsystem: "free", "0.35".
  struct MemoryField {
    std::string name, value;
  };
  struct Subsystem {
    std::string path;
    std::optional<std::string> behaviour;  ///< the behaviour called last; nullopt: none yet
    bool calling = false, ended = false;
    std::uint64_t iterations = 0, firings = 0, overruns = 0, errors = 0;
    double period_s = 0, called_at_s = 0, call_s = 0, longest_call_s = 0;
    /// Calls that took longer than declared, and how often its thread went on later than the latency allows.
    std::uint64_t slow_calls = 0, late_wakeups = 0;
    double latest_wakeup_s = 0;       ///< the most time until it went on after it might
    std::vector<MemoryField> memory;  ///< at the end of its last iteration
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
    bool for_answer = false;  ///< it waits for the acknowledgement of its value; false: for a value
    std::string process;      ///< process of the other end; empty: this one
    double since_s = 0;
  };
  /// The link between this process and another.
  struct Link {
    std::string process, host;  ///< the other one; host empty: none is given
    bool reachable = false;
    double since_s = 0;             ///< of `reachable`
    std::optional<double> heard_s;  ///< its newest message; nullopt: none yet
    std::uint64_t sent = 0, repeated = 0, received = 0, duplicates = 0;  ///< messages
    std::uint64_t signs = 0, signs_lost = 0;                             ///< among its newest signs of life
    std::optional<double> clock_ahead_s;                                 ///< by its wall clock
    double clock_uncertainty_s = 0;
  };
  /// The network on which the processes of the system meet, as this run was told, and their names.
  struct Deployment {
    struct Process {
      std::string name, host;  ///< host empty: none is given
    };
    int domain = 0;
    std::string interface;
    std::vector<std::string> peers;
    std::vector<Process> processes;
  };
  /// Only for a run that was started with `--controlled`.
  struct Control {
    bool paused = false;       ///< it stands still, and all its firings are in its recording
    std::uint64_t pauses = 0;  ///< how often it has been paused
    double speed = 0;          ///< simulated seconds a second; 0: as fast as possible
    std::string broke_at;      ///< the place or transition whose breakpoint paused it; empty: none
  };
  std::string system, net_hash;
  std::int64_t pid = -1;                 ///< in the name space of the controller
  double time_s = 0;                     ///< by the clock of the run
  std::optional<std::string> recording;  ///< its file
  std::optional<std::string> emergency;  ///< the reason of the current emergency stop
  std::optional<std::string> process;    ///< its name in the deployment; nullopt: all agents run here
  std::string host, incarnation;         ///< with `process`; the incarnation is a number of up to 20 digits
  std::vector<Subsystem> subsystems;
  std::vector<Channel> channels;
  std::vector<Wait> waits;
  std::vector<Link> links;  ///< with `process`
  std::optional<Control> control;
  std::optional<Deployment> deployment;  ///< only in the first line of a connection
  bool brief = false;                    ///< lists are left out: of the network
  std::uint64_t left_out = 0;            ///< members of lists for which a message of the network has no room
};

/// The values that an operator can change, as they are now.
struct Offered {
  /// A parameter of one subsystem, or a control of a panel.
  struct Value {
    std::string path, value, unit;           ///< "robot.control.v", or a field; unit empty: none
    std::optional<double> minimum, maximum;  ///< of each element; nullopt: none
  };
  struct Panel {
    std::string path;  ///< of its real buffer
    double stale_s = 0;
    bool operated = false;  ///< false: it is neutral
    std::vector<Value> controls;
  };
  std::vector<Value> parameters;
  std::vector<Panel> panels;
};

/// The result of a command.
struct CommandAnswer {
  std::int64_t id = 0;
  std::optional<Problem> problem;    ///< nullopt: done
  bool elsewhere = false;            ///< no subsystem of this process has such a parameter or panel
  std::optional<Offered> offered{};  ///< of command::Offers
};

/// Precedes bytes of the recording.
struct PieceHead {
  std::size_t bytes = 0;
  bool begins = false, more = false;
};

/// Precedes bytes of the scene of the world (tessera/poses.hpp).
struct SceneHead {
  std::size_t bytes = 0;
  std::uint64_t from = 0, total = 0;  ///< total 0: there is none
};

struct ControllerHasEnded {};

/// One line, with its end. Text that is not UTF-8 is replaced (a path may hold any bytes).
[[nodiscard]] std::string line_of(const Snapshot& snapshot);
[[nodiscard]] std::string line_of(const CommandAnswer& answer);
[[nodiscard]] std::string line_of(const PieceHead& head);
[[nodiscard]] std::string line_of(const SceneHead& head);
[[nodiscard]] std::string line_of(const ControllerHasEnded& end);

using ControlLine = std::variant<Snapshot, CommandAnswer, PieceHead, SceneHead, ControllerHasEnded>;

/// A line without its end. Members that are missing keep their defaults, and unknown ones are passed over:
/// the controller may be of another version. nullopt: it is none.
[[nodiscard]] std::optional<ControlLine> read_control_line(std::string_view line);

/// The commands of a client; `name` stands in the line.
namespace command {

struct Recording {
  static constexpr auto name = "recording";
};
struct Scene {
  static constexpr auto name = "scene";
  std::uint64_t from = 0;
};
struct Own {
  static constexpr auto name = "own";
};
struct Set {
  static constexpr auto name = "set";
  std::string path, value;
  bool only_try = false;  ///< the answer says whether the value fits; nothing changes
};
/// The input of an operator for the panel of a real buffer.
struct Panel {
  static constexpr auto name = "panel";
  using Value = std::variant<double, bool>;
  std::string path;  ///< of the real buffer: "robot.operator.drive"
  std::string who;   ///< tells operators apart
  /// By field; fields without a value are neutral. nullopt: the operator lets go of the panel.
  std::optional<std::map<std::string, Value>> values;
};
/// Asks for the parameters and the panels.
struct Offers {
  static constexpr auto name = "offers";
};
struct EmergencyStop {
  static constexpr auto name = "emergency_stop";
  std::string why;  ///< empty: the words of the controller
};
struct Reset {
  static constexpr auto name = "reset";
};

// For runs in simulated time.
struct Pause {
  static constexpr auto name = "pause";
};
struct Resume {
  static constexpr auto name = "resume";
};
struct StepFiring {
  static constexpr auto name = "step_firing";
};
struct StepIteration {
  static constexpr auto name = "step_iteration";
  std::string subsystem;  ///< empty: any
};
struct Speed {
  static constexpr auto name = "speed";
  double value = 1;  ///< as Snapshot::Control::speed
};
struct Breakpoints {
  static constexpr auto name = "breakpoints";
  std::vector<std::string> places, transitions, conditions;  ///< names
};

}  // namespace command

using SimulationCommand = std::variant<command::Pause, command::Resume, command::StepFiring,
                                       command::StepIteration, command::Speed, command::Breakpoints>;
using ControlCommand =
    std::variant<command::Recording, command::Scene, command::Own, command::Set, command::Panel,
                 command::Offers, command::EmergencyStop, command::Reset, SimulationCommand>;

/// With its end. Text that is no UTF-8 is replaced: it names nothing, and the controller says so.
/// id: of the answer; nullopt: none is waited for.
[[nodiscard]] std::string line_of(const ControlCommand& command, std::optional<std::int64_t> id = {});

struct ControlRequest {
  std::int64_t id = 0;             ///< for the answer
  Result<ControlCommand> command;  ///< or why the line is none, or none that is known
};
/// Never throws, whatever a client sends.
[[nodiscard]] ControlRequest read_control_request(std::string_view line);

}  // namespace tessera
