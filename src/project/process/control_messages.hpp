#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "tessera/result.hpp"

/// The messages of the control socket of a running controller (tessera/monitor.hpp), as its clients see them.
/// share/tessera/control_socket.schema.json defines them.
namespace tessera::project {

/// The present state of a controller.
struct Snapshot {
  struct Subsystem {
    std::string path;
    std::optional<std::string> behaviour;  ///< nullopt: no transition function was called yet
    bool calling = false, ended = false;
    std::uint64_t iterations = 0, firings = 0, overruns = 0, errors = 0;
    double period_s = 0, called_at_s = 0, call_s = 0, longest_call_s = 0;
    struct MemoryField {
      std::string name, value;
    };
    std::vector<MemoryField> memory;  ///< at the end of its last iteration
  };
  struct Channel {
    std::string name;
    std::vector<std::string> marked;
    std::optional<double> sending_since_s;
  };
  /// A subsystem at rest that another can free.
  struct Wait {
    std::string subsystem, waits_for, channel;
    bool for_answer = false;
    std::string process;  ///< of the other; empty: the same
    double since_s = 0;
  };
  /// The knowledge that this process has of another.
  struct Link {
    std::string process, host;
    bool reachable = false;
    double since_s = 0;
    std::optional<double> heard_s;
    std::uint64_t sent = 0, repeated = 0, received = 0, duplicates = 0, signs = 0, signs_lost = 0;
    std::optional<double> clock_ahead_s;
    double clock_uncertainty_s = 0;
  };
  /// Only for a run that was started with `--controlled`.
  struct Control {
    bool paused = false;
    std::uint64_t pauses = 0;
    double speed = 0;
    std::string broke_at;
  };
  /// The network on which the processes of its system meet, and their names.
  struct Deployment {
    int domain = 0;
    std::string interface;
    std::vector<std::string> peers;
    struct Process {
      std::string name, host;  ///< host empty: none is given
    };
    std::vector<Process> processes;
  };
  std::string system, net_hash;
  std::int64_t process = -1;
  double time_s = 0;
  std::optional<std::string> recording, emergency;
  std::optional<std::string>
      name;                       ///< of this process in the deployment; nullopt: the system has one process
  std::string host, incarnation;  ///< the same
  std::vector<Wait> waits;
  std::vector<Link> links;
  std::vector<Subsystem> subsystems;
  std::vector<Channel> channels;
  std::optional<Control> control;
  std::optional<Deployment> deployment;  ///< only in the first line of a connection
  bool brief = false;                    ///< lists are left out: of the network
  std::uint64_t left_out = 0;            ///< members of lists that had no room
};

/// The result of a command.
struct CommandAnswer {
  std::int64_t id = 0;
  std::optional<Problem> problem;  ///< nullopt: done
  bool elsewhere = false;          ///< no subsystem of this process has such a parameter or panel
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

using ControlLine = std::variant<Snapshot, CommandAnswer, PieceHead, SceneHead, ControllerHasEnded>;

/// A line without its end. Members that are missing keep their defaults, and unknown ones are passed over:
/// the controller may be of another version. nullopt: it is none.
[[nodiscard]] std::optional<ControlLine> read_control_line(std::string_view line);

/// Without the memory, which clients that follow a run take from its recording.
[[nodiscard]] nlohmann::json json_of(const std::vector<Snapshot::Subsystem>& subsystems);
[[nodiscard]] nlohmann::json json_of(const std::vector<Snapshot::Channel>& channels);

/// The commands of a client.
namespace command {
struct Recording {};
struct Scene {
  std::uint64_t from = 0;
};
struct Own {};
struct Set {
  std::string path, value;
  bool only_try = false;  ///< whether the value fits; nothing changes
};
/// An input of an operator for the panel of a real buffer.
struct Panel {
  using Value = std::variant<double, bool>;
  std::string path, who;
  std::optional<std::map<std::string, Value>> values;  ///< by field; nullopt: the operator lets go
};
struct EmergencyStop {
  std::string why;  ///< empty: the controller's own words
};
struct Reset {};
struct Pause {};
struct Resume {};
struct StepFiring {};
struct StepIteration {
  std::string subsystem;  ///< empty: any
};
struct Speed {
  double value = 1;
};
/// By name.
struct Breakpoints {
  std::vector<std::string> places, transitions, conditions;
};
}  // namespace command

using ControlCommand =
    std::variant<command::Recording, command::Scene, command::Own, command::Set, command::Panel,
                 command::EmergencyStop, command::Reset, command::Pause, command::Resume, command::StepFiring,
                 command::StepIteration, command::Speed, command::Breakpoints>;

/// With its end. Text that is no UTF-8 is replaced: it names nothing, and the controller says so.
/// id: of the answer; nullopt: none is waited for.
[[nodiscard]] std::string line_of(const ControlCommand& command, std::optional<std::int64_t> id = {});

}  // namespace tessera::project
