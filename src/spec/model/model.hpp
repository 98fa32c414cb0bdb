#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "spec/model/communication_model.hpp"
#include "spec/model/deployment.hpp"
#include "spec/model/ids.hpp"
#include "spec/model/panel.hpp"
#include "spec/model/property.hpp"
#include "spec/model/takes.hpp"
#include "spec/model/timing.hpp"
#include "spec/model/types.hpp"
#include "spec/model/world.hpp"
#include "tessera/overrun.hpp"
#include "tessera/overtime.hpp"
#include "tessera/scalar.hpp"

/// The specification as data, as section "The specification file" of docs/reference/specification.md describes it.
/// Every default is filled in, and every name is resolved to a number. Nothing here depends on nets.
namespace tessera::spec {

using Duration = std::chrono::nanoseconds;

// ---------------------------------------------------------------------------------------------- behaviours

/// Something of the specification that an expression names. Each part of `in.line.left` is one.
struct Reference {
  enum class Kind : std::uint8_t {
    input,
    output,
    real,
    memory,
    value,  ///< of a memory cell with few values
    own_parameter,
    system_parameter,
    field,    ///< of a structure
    status,   ///< `fresh`, `age` ...: of a buffer
    elapsed,  ///< the time in the behaviour
    index,    ///< the number of the agent in its fleet
    member    ///< `i`: the number of the member of a fleet that the behaviour or the entry is for
  } kind = Kind::input;
  std::string path;  ///< up to and with this part, without subscripts: "in.line.left"
  /// Into Subsystem::inputs, ::outputs, ::real, ::memory or ::parameters, or Model::parameters. A field: into
  /// Structure::fields. A value: into FewValues::names. Otherwise none.
  std::optional<std::uint32_t> target{};
  StructureId structure{};  ///< of a field
  Span span;                ///< of this part alone; of the whole expression where its lines are joined
};

/// A C++ expression over in, out, memory and parameters; span is that of its text in the file.
struct Expression {
  std::string name;  ///< of an indexed condition; empty: unnamed
  /// As in the file: a duration may have a blank before its unit, as C++ has none (with_cpp_durations).
  std::string text;
  Span span;
  std::vector<Reference> references{};  ///< in the order of the text; what could not be understood is absent
  /// A number in a unit of time that stands beside a duration, and is one there.
  struct TimeNumber {
    std::size_t begin = 0, end = 0;  ///< in `text`, in bytes
    std::string unit;                ///< "h", "min", "s", "ms", "us" or "ns"
  };
  std::vector<TimeNumber> times{};        ///< in the order of the text; none contains another
  std::optional<std::uint32_t> member{};  ///< the value of `i` in the text
  /// It is `until` of that group: one of the terminal conditions of each behaviour in it, and of the group.
  BehaviourId until_of{};
};
[[nodiscard]] inline const std::vector<Reference>& references(const Expression& expression) {
  return expression.references;
}

/// A terminal or error condition (paper, sec. IV-D). It holds if one of its expressions holds.
struct Condition {
  enum class Kind : std::uint8_t { never, always, expressions } kind = Kind::never;
  Numbered<ExpressionId, Expression> expressions;
  Span span;
};

/// The condition under which an entry of `next` is taken: the paper's initial condition of the next behaviour.
struct When {
  enum class Kind : std::uint8_t {
    always,       ///< no `when`: after a terminal ending; see Endings
    never,        ///< `when: false`
    error,        ///< the behaviour ended by its error condition or by a failure
    terminal,     ///< the terminal expression `expression` of the behaviour held
    named_error,  ///< the error expression `expression` of the behaviour held
    expression    ///< `text` holds
  } kind = Kind::always;
  ExpressionId expression{};  ///< of Behaviour::terminal or ::error
  Expression text{};          ///< of any other kind than `expression`, only its span has a meaning
};

struct Next {
  BehaviourId behaviour{};  ///< none: `end`, of the subsystem or of the group that the behaviour is in
  When when;
  Span span;
  bool implied = false;  ///< not in the file: complete_next has added it
  bool inherited =
      false;  ///< not in the list: `on_error` or `until`, at `span`, says it, or the group around it
  /// To memory when it is taken; those of the behaviour that it leads to come last.
  std::vector<Change> sets{};
  /// A counter may have no value for `sets`. The entry is then not taken, as if its condition did not hold.
  bool may_be_blocked = false;
  std::optional<Member>
      member{};  ///< one of the entries that `to: lend[i]` stands for; `family` is that of the behaviour
};

enum class Transfer : std::uint8_t { sequential, parallel };

/// The parts of a group of behaviours, which has them instead of a transition function and communication.
struct Group {
  BehaviourId start{};              ///< a behaviour or group in it
  std::optional<Expression> until;  ///< holds: the group is left after this iteration
  bool may_fail = true;  ///< a failure of a behaviour in it may leave it; complete_groups finds it out
};

/// An output that an iteration of a behaviour may skip: then nothing is sent over its channels.
struct Skippable {
  BufferId output{};
  bool by_function = false;  ///< `skip: allowed`: the transition function decides, and `when` means nothing
  Condition when{};          ///< it is sent if this holds
  Span span{};
};

/// A behaviour, or a group of behaviours, which stands before what is in it. A group, too, has `next`, `sets` and an
/// ending: terminal if a behaviour in it leads to `end`, or its `until` holds; otherwise one that has left the group.
struct Behaviour {
  std::string name;      ///< "follow"; in a group with the names of the groups around it: "charge.ask"
  BehaviourId parent{};  ///< the group that it is in; none: the subsystem itself
  std::optional<Group> group{};
  Condition terminal;
  Condition error;
  Numbered<NextId, Next> next;  ///< never empty: `end` is the default; see complete_next
  bool next_given = false;      ///< false: that `end` is the default
  /// Output buffers in the order listed; nullopt: all, in the order of the channels.
  std::optional<std::vector<BufferId>> send;
  std::vector<Skippable> skippable{};  ///< of these outputs, in the order listed
  /// Input buffers in the order listed; nullopt: all, in the order of the channels.
  std::optional<std::vector<BufferId>> receive;
  Transfer transfer = Transfer::sequential;
  Takes takes{};                    ///< in simulated time
  std::vector<ResourceUse> uses{};  ///< each resource once
  std::vector<Change> sets{};       ///< to memory when it begins; of a group, with those of its start
  std::optional<Order> orders{};    ///< the goal that it orders when it begins; `sets` contains its change
  std::optional<Member> member{};   ///< of a behaviour `for: each robot`
  Span span;

  [[nodiscard]] bool is_group() const { return group.has_value(); }
  /// "ask": the name among its neighbours.
  [[nodiscard]] std::string_view label() const;
  /// "charge_ask": its name in C++.
  [[nodiscard]] std::string identifier() const;
  /// nullptr: every iteration sends it, or none.
  [[nodiscard]] const Skippable* skips(BufferId output) const;
};

// -------------------------------------------------------------------------------------- subsystems, agents

enum class SubsystemKind : std::uint8_t { control, receptor, effector };

using tessera::Overrun;
using tessera::Overtime;

/// How the operating system schedules the thread of a subsystem that runs in real time.
struct RealTime {
  enum class Policy : std::uint8_t { fifo, round_robin } policy = Policy::fifo;
  std::uint32_t priority = 50;  ///< 1 .. 99
  std::optional<std::uint32_t> cpu;
};

/// The limits of a command to a real buffer, or to a number inside it.
struct Limit {
  RealId real;
  std::string field;  ///< inside the buffer: "pose.x"; empty: the buffer itself. In an array: of each element
  std::optional<double> minimum, maximum;
  std::optional<double> per_second;  ///< the largest change within a second
  /// a command beyond the limit is a fault; otherwise the limit is sent in its place
  bool fault = false;
  Span span;
};

/// Whether numbers of commands may be infinite or NaN, because the device gives such numbers a meaning.
struct NonFinite {
  RealId real;
  std::string field;  ///< inside the buffer, as in Limit; empty: all its numbers
  bool allowed = true;
  Span span;
};

struct Subsystem {
  SubsystemKind kind = SubsystemKind::control;
  std::string name;  ///< "control" for the control subsystem
  std::optional<Duration> period;
  BehaviourId start{0};
  bool receive_first = false;  ///< an iteration receives before its transition function, not after it
  Numbered<BufferId, Field> inputs, outputs;
  std::vector<Field> memory;
  std::vector<Parameter> parameters;
  Numbered<RealId, Field>
      real;  ///< read before (receptor) or written after (effector) the transition function
  Numbered<RealId, std::string> safe;  ///< effector: C++ initialiser per real buffer; empty string: zero
  std::vector<Limit> limits;           ///< effector: of real buffers
  std::vector<NonFinite> non_finite;   ///< effector: in real buffers, instead of `non_finite_allowed`
  /// effector: if an input is older than this, the device gets the safe command
  std::optional<Duration> stale;
  /// effector: a fault or a stale input begins an emergency stop, which lasts until an operator ends it
  bool operator_resets = false;
  Overrun overrun = Overrun::skip;
  Overtime overtime = Overtime::tell;
  std::optional<Duration> watchdog;  ///< a transition function that takes longer is a fault
  bool non_finite_allowed = false;   ///< outputs and real outputs may be infinite or NaN
  std::optional<RealTime> realtime;
  Numbered<BehaviourId, Behaviour> behaviours;
  Span span;

  /// Whether numbers at that place of a command may be infinite or NaN. Parts of it may have their own rule.
  /// field: empty: the whole buffer.
  [[nodiscard]] bool may_be_non_finite(RealId buffer, std::string_view field) const;
  /// Whether a part inside of that place has a rule of its own.
  [[nodiscard]] bool divides_non_finite(RealId buffer, std::string_view field) const;
};

/// The subsystems of an agent: an entry of `templates`, or an agent that `agents` describes in full.
struct Definition {
  std::string name;
  Numbered<DefinedSubsystemId, Subsystem>
      subsystems;  ///< control first, then receptors, then effectors, as in the file
  bool is_template = false;
  Span span;
};

/// One agent of the running system.
struct Agent {
  std::string path;  ///< "robot", or "robot[3]" in a fleet
  DefinitionId definition{0};
  FleetId fleet;
  std::uint32_t number = 0;      ///< within the fleet
  InstanceId first_instance{0};  ///< the instances of the agent follow one another
  ProcessId process{0};          ///< without a deployment 0
  Span span;

  /// The instance of one of the subsystems of its definition.
  [[nodiscard]] InstanceId instance(DefinedSubsystemId subsystem) const {
    return {first_instance.value + subsystem.value};
  }
};

/// One subsystem of one agent.
struct Instance {
  AgentId agent;
  DefinedSubsystemId subsystem;
};

// ---------------------------------------------------------------------------------------------- channels

/// blocking_once: a receiver waits for the first value; then it reads the newest one, new or not.
enum class Mode : std::uint8_t { non_blocking, blocking, blocking_once };

struct ChannelEnd {
  InstanceId instance;
  BufferId buffer;  ///< an output (from) or an input (to)
};

struct Channel {
  ChannelEnd from, to;
  Mode send = Mode::non_blocking;
  Mode receive = Mode::non_blocking;
  CommunicationModelId model;  ///< none: the built-in one of `send` and `receive`
  std::optional<Duration> send_timeout, receive_timeout;
  Span span;
};

// ---------------------------------------------------------------------------------------------- the rest

/// An option of a driver: `pin: 4`, `radius: 33 mm`, `device: /dev/ttyUSB0`, `inverted: true`.
struct DriverOption {
  std::variant<bool, double, std::string> value;
  /// The unit of a number; empty: none. For a C++ class as written; for the world the base unit of the
  /// number.
  std::string unit;
  bool is_list = false;  ///< of a device of the world; then `value` means nothing
  std::vector<DriverOption> list{};

  bool operator==(const DriverOption&) const = default;
};

/// The driver of a real buffer, or of all real buffers of a subsystem.
struct Driver {
  InstanceId instance;
  RealId real;       ///< none: all of them
  std::string kind;  ///< "cpp", "ros2", "panel", or a kind of the simulated world: "sensor", ...
  /// The C++ class, or the names of elements of the world.
  struct Target {
    std::string name;
    Span span;
  };
  std::vector<Target> targets;
  std::map<std::string, DriverOption> options;
  std::map<std::string, Span> option_spans;
  std::optional<Panel> panel{};  ///< of kind "panel"
  Span span;

  /// Behind it is a device of the simulated world.
  [[nodiscard]] bool is_of_world() const { return kind != "cpp" && kind != "ros2" && kind != "panel"; }

  /// Precondition: the driver could be read.
  [[nodiscard]] const std::string& target() const { return targets.front().name; }
};

struct Simulation {
  std::string world;  ///< MuJoCo model; empty: none
  Span world_span;
  std::optional<CoppeliaServer> coppelia;  ///< instead of `world`
  std::optional<Track> track;
  std::vector<ModelPlacement> models;  ///< in the order of the file, fleets expanded agent by agent
  std::vector<Driver> drivers;
  std::vector<WorldCheck> checks;
  std::vector<UseCheck> use_checks;
  std::vector<WorldMeasure> measures;
  Span span;

  /// false: the drivers are C++ classes.
  [[nodiscard]] bool has_world() const { return !world.empty() || coppelia.has_value(); }
};

/// A whole specification. Invariant: every index is valid, and every path is resolved.
struct Model {
  std::string system;
  diagnostics::Sources sources;                 ///< of the lines of all spans
  Numbered<StructureId, Structure> structures;  ///< in an order in which each uses only earlier ones
  std::vector<Parameter> parameters;            ///< of the system, visible in every subsystem
  Numbered<DefinitionId, Definition> definitions;
  Numbered<AgentId, Agent> agents;
  Numbered<InstanceId, Instance> instances;  ///< every subsystem of every agent, agent by agent
  Numbered<CommunicationModelId, CommunicationModel> models;  ///< defined in the specification
  Numbered<ChannelId, Channel> channels;  ///< in the order of the file, fleets expanded agent by agent
  std::vector<Driver> drivers;            ///< of the real robot (`drivers:`)
  std::vector<Property> properties;
  Timing timing;
  std::optional<Simulation> simulation;
  std::optional<Deployment> deployment;

  /// The type of a value as recordings describe it: "float64[3]", "{x: float64, y: float64}".
  [[nodiscard]] std::string layout_of(const Type& type) const;
  [[nodiscard]] const Definition& definition_of(const Agent& agent) const {
    return definitions[agent.definition];
  }
  [[nodiscard]] const Subsystem& subsystem(InstanceId instance) const;
  /// "robot[3].control"
  [[nodiscard]] std::string instance_path(InstanceId instance) const;
  /// "robot[3].motor.left", or "arm.joints" for a driver of all real buffers.
  [[nodiscard]] std::string driver_path(const Driver& driver) const;
  /// Paths of the real buffers that have no driver among `those`.
  [[nodiscard]] std::vector<std::string> without_driver(const std::vector<Driver>& those) const;
  /// "robot.control.motion->robot.motor.velocity": the name of the channel's fused places.
  [[nodiscard]] std::string channel_name(const Channel& channel) const;
  /// Whether a sender or receiver may have to wait at the channel.
  [[nodiscard]] bool sender_waits(const Channel& channel) const;
  [[nodiscard]] bool receiver_waits(const Channel& channel) const;
  /// Whether the two ends of a channel are in different processes.
  [[nodiscard]] bool crosses_processes(const Channel& channel) const;
};

}  // namespace tessera::spec
