#pragma once

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <string_view>

#include "tessera/net_roles.hpp"
#include "tessera/overrun.hpp"
#include "tessera/overtime.hpp"
#include "tessera/time.hpp"

/// The net of a generated controller: constant tables, read once at start. Generated code includes this
/// file and states which version of it was used. Rows name each other by number, from 0: behaviours, ports and
/// places by their positions in the tables of their subsystem. Names are for people: recordings, drawings, and
/// the hash of the net.
namespace tessera {

inline constexpr int tables_version = 7;

class DriverSetup;
class RealEffector;
class RealReceptor;
class Subsystem;
struct DriverOption;

/// The operation that a token starts when it arrives in a place. The last four are no operations of the net:
/// `decide`, `route` and `ask` evaluate conditions when the token arrives, and store which of the conditional
/// transitions behind the place may fire; `know` is of a place that stands for a value of a fact.
struct Does {
  enum class Kind : std::uint8_t {
    nothing,
    call,
    count,
    write,
    read,
    begin,  ///< of a subsystem that receives first: waits for the instant of its rate, and counts
    decide,
    route,
    know,  ///< the subsystem may have a token in such places besides its own: a transition reads it
    ask    ///< whether this iteration sends what it may skip
  } kind = Kind::nothing;
  /// behaviour (call, begin, decide, route), port (write, read, ask) or fact (know)
  std::uint16_t subject = 0;
  /// of the channel's memory, from 1 (write, read); the value of the fact (know); the behaviour (ask)
  std::uint16_t slot = 1;
};
[[nodiscard]] constexpr Does calls(std::uint16_t behaviour) { return {Does::Kind::call, behaviour}; }
[[nodiscard]] constexpr Does counts() { return {Does::Kind::count}; }
[[nodiscard]] constexpr Does begins(std::uint16_t behaviour) { return {Does::Kind::begin, behaviour}; }
[[nodiscard]] constexpr Does writes(std::uint16_t port, std::uint16_t slot = 1) {
  return {Does::Kind::write, port, slot};
}
[[nodiscard]] constexpr Does reads(std::uint16_t port, std::uint16_t slot = 1) {
  return {Does::Kind::read, port, slot};
}
[[nodiscard]] constexpr Does decides(std::uint16_t behaviour) { return {Does::Kind::decide, behaviour}; }
[[nodiscard]] constexpr Does routes(std::uint16_t behaviour) { return {Does::Kind::route, behaviour}; }

[[nodiscard]] constexpr Does knows(std::uint16_t fact, std::uint16_t value) {
  return {Does::Kind::know, fact, value};
}

[[nodiscard]] constexpr Does asks(std::uint16_t port, std::uint16_t behaviour) {
  return {Does::Kind::ask, port, behaviour};
}

/// Instead of the number of a behaviour or port: there is none.
inline constexpr std::uint16_t nobody = UINT16_MAX;

/// When an enabled transition may fire.
struct Guard {
  enum class Kind : std::uint8_t {
    none,
    go_on,
    terminal,
    error,
    next,
    elapsed,
    send,  ///< the iteration sends what it may skip
    skip,  ///< it does not
    told   ///< the value that was read tells that the goal is in that state
  } kind = Kind::none;
  std::uint16_t entry = 0;  ///< index into `next`, from 0; the state of the goal (told)
  /// elapsed: the port with the timeout; nobody: that of the channel that the transition touches
  std::uint16_t port = nobody;
};
inline constexpr Guard if_go_on{Guard::Kind::go_on}, if_terminal{Guard::Kind::terminal},
    if_error{Guard::Kind::error}, if_elapsed{Guard::Kind::elapsed}, if_sends{Guard::Kind::send},
    if_skips{Guard::Kind::skip};
[[nodiscard]] constexpr Guard if_next(std::uint16_t entry) { return {Guard::Kind::next, entry}; }
[[nodiscard]] constexpr Guard if_told(std::uint16_t state) { return {Guard::Kind::told, state}; }
[[nodiscard]] constexpr Guard if_elapsed_at(std::uint16_t port) { return {Guard::Kind::elapsed, 0, port}; }

/// A place of a subsystem. Its name lacks the path of the subsystem ("follow.snd.motion.2").
struct Place {
  std::string_view name;
  Does does{};
  std::uint32_t tokens = 0;  ///< at the start; only of a place that stands for a value of a fact
};

/// A variable of the subsystem that its net knows. One of the places of its values holds a token.
struct Fact {
  enum class Kind : std::uint8_t {
    received,  ///< whether the last receive of the input `name` took a value: 0 it did, 1 it did not
    sent,   ///< whether the last send of the output `name` was acknowledged in time: 0 it was, 1 it was not
    memory  ///< the value of a memory cell, which the net changes: among its values in their order
  } kind;
  std::string_view name;
};

/// The role of a transition in recordings.
struct TableRole {
  Step step = Step::other;
  std::uint16_t behaviour = nobody;  ///< the behaviour that it belongs to, or leaves
  std::uint16_t port = nobody;       ///< the port of its block
};

/// An end of an arc: a place of the subsystem, or one of the memory of the channel behind a port.
class ArcEnd {
 public:
  constexpr ArcEnd(std::uint16_t place) : place_(place) {}  // NOLINT(google-explicit-constructor)
  constexpr ArcEnd(std::uint16_t port, std::uint16_t place) : port_(port), place_(place) {}

  [[nodiscard]] constexpr bool is_shared() const { return port_ != nobody; }
  [[nodiscard]] constexpr std::uint16_t port() const { return port_; }
  /// Into the places of the subsystem, or of the channel.
  [[nodiscard]] constexpr std::uint16_t place() const { return place_; }

 private:
  std::uint16_t port_ = nobody, place_;
};
/// A place of the memory of the channel behind a port.
[[nodiscard]] constexpr ArcEnd memory(std::uint16_t port, std::uint16_t place) { return {port, place}; }

struct Transition {
  std::string_view name;
  std::initializer_list<ArcEnd> inputs, outputs;
  Guard guard{};
  TableRole role{};
};

enum class Side : std::uint8_t { send, receive };

/// One end of a channel inside a subsystem: the block "motion" or "motion#2", and its buffer.
struct Port {
  std::string_view name;
  Side side;
  std::string_view buffer;
};

/// A point of the distribution of the times of calls: `below` of 2^32 calls take less than `time`.
struct TimePoint {
  Duration time;
  std::uint32_t below;
};

/// The use of a resource while a behaviour is the present one.
struct Use {
  std::uint16_t resource;  ///< into System::resources
  double per_second;       ///< in the unit of the resource
};

struct Behaviour {
  std::string_view name;
  Duration takes{0};    ///< least simulated time of its transition function
  Duration at_most{0};  ///< most; less than `takes`: that is the time of each call
  /// The distribution between the two; all times between two neighbouring points are equally likely. `below` is 0
  /// in the first point and UINT32_MAX in the last one. Empty: all times between the two are equally likely.
  std::span<const TimePoint> times{};
  std::span<const Use> uses{};
};

/// The part of the net that one subsystem executes.
struct SubsystemNet {
  std::span<const Behaviour> behaviours;
  std::span<const Port> ports;
  std::span<const Place> places;
  std::span<const Transition> transitions;
  std::uint16_t in = 0, out = 1;  ///< the places where its token enters and leaves
  std::span<const Fact> facts{};
};

enum class Kind : std::uint8_t { control, receptor, effector };

/// How the operating system schedules the thread of a subsystem on the steady clock.
struct RealTime {
  enum class Policy : std::uint8_t { usual, fifo, round_robin } policy = Policy::usual;
  int priority = 0;  ///< 1 .. 99, unless usual
  int cpu = -1;      ///< the processor it stays on; -1: any
};

/// How a subsystem treats time and faults.
struct Policies {
  Overrun overrun = Overrun::skip;
  Overtime overtime = Overtime::tell;
  Duration watchdog{0};             ///< a transition function that takes longer is a fault; zero: no watchdog
  bool operator_resets = false;     ///< effector: a fault or a stale input begins an emergency stop
  bool non_finite_allowed = false;  ///< outputs to channels may be infinite or NaN; real ones: Bindings
  RealTime realtime{};
};

/// One subsystem of one agent.
struct Instance {
  std::string_view agent;  ///< "robot[3]"
  std::string_view name;   ///< "control"; the path is agent.name
  Kind kind;
  const SubsystemNet* net;
  std::unique_ptr<Subsystem> (*make)();
  Duration period{0};  ///< zero: no rate
  Duration stale{0};   ///< zero: inputs never get stale
  Policies policies{};
};

/// A place of the memory of a channel.
struct FusedPlace {
  std::string_view name;
  std::uint32_t tokens = 0;
  PlaceRole role = PlaceRole::none;
};

/// A transition of the medium of a channel between processes. Its ends are places of the channel's memory.
struct MediumTransition {
  std::string_view name;
  Step step;
  std::initializer_list<std::uint16_t> inputs, outputs;
};

struct End {
  std::uint32_t instance;       ///< into System::instances
  std::uint16_t port = nobody;  ///< nobody: no behaviour of that instance uses the channel

  [[nodiscard]] constexpr bool is_used() const { return port != nobody; }
};

struct Channel {
  std::string_view name;  ///< "robot.control.motion->robot.motor.velocity"
  End from, to;
  std::span<const FusedPlace> places;            ///< channels of one kind share them
  Duration send_timeout{0}, receive_timeout{0};  ///< zero: waits for ever
  std::uint16_t slots{1};                        ///< values that the memory holds
  std::span<const MediumTransition> medium{};    ///< only between processes

  [[nodiscard]] constexpr bool is_used() const { return from.is_used() || to.is_used(); }
};

/// An end of an arc of a page above the subsystems: a place of the page, or the place where each page in it is
/// entered or left.
struct PageEnd {
  enum class Kind : std::uint8_t { own, entries, exits } kind = Kind::own;
  std::uint16_t place = 0;
  constexpr PageEnd(std::uint16_t own) : place(own) {}              // NOLINT(google-explicit-constructor)
  constexpr PageEnd(Kind of_pages_below) : kind(of_pages_below) {}  // NOLINT(google-explicit-constructor)
};
/// The ends of each page below.
inline constexpr PageEnd::Kind entries = PageEnd::Kind::entries, exits = PageEnd::Kind::exits;

struct PagePlace {
  std::string_view name;
  std::uint32_t tokens = 0;
};
struct PageTransition {
  std::string_view name;
  Step step;
  std::initializer_list<PageEnd> inputs, outputs;
};

/// The net of the system, or of each of its agents. Their pages look the same for any number of pages in them.
struct UpperPage {
  std::span<const PagePlace> places;
  std::span<const PageTransition> transitions;
  std::uint16_t in = 0, out = 1;  ///< the places where its token enters and leaves
};

/// A driver that the user wrote in C++; exactly one of the two makers is set.
struct CppDriver {
  std::string_view path;  ///< "robot.sensor.left"; or "arm.joints": all real buffers of that subsystem
  std::string_view class_name;
  const char* const* place;  ///< in the specification: "spec.yaml:41"; nullptr: not known
  std::span<const DriverOption> options;
  std::unique_ptr<RealReceptor> (*receptor)(const DriverSetup&) = nullptr;
  std::unique_ptr<RealEffector> (*effector)(const DriverSetup&) = nullptr;
  bool guarded = false;  ///< the class derives from Guarded
};

/// A process of a deployed system.
struct Process {
  std::string_view name;       ///< "base", "cart[3]"
  std::string_view host;       ///< its machine; empty: none given
  std::string_view interface;  ///< network interface of its machine; empty: none given
};

/// A chain of subsystems from a receptor to an effector, with what is proved of its times. A row stands for the
/// chains of all members of a fleet.
struct Chain {
  std::string_view name;         ///< "joints to motors"; of a fleet "robot[].eye -> robot[].control -> ..."
  Duration age{0}, reaction{0};  ///< at most; zero: there is no bound
};

/// A way of values along a chain: channels, each of which ends where the next one begins.
struct ChainWay {
  std::uint32_t chain;                            ///< into System::chains
  std::initializer_list<std::uint32_t> channels;  ///< into System::channels
  std::uint32_t member = UINT32_MAX;              ///< of the fleet; UINT32_MAX: there is none
};

/// Something that behaviours use: "energy", in "J".
struct Resource {
  std::string_view name, unit;
};

struct VerifiedProperty {
  std::string_view name, verdict, method;
};

/// A whole controller.
struct System {
  int tables_version;
  std::string_view name;
  std::string_view net_hash;  ///< of the verified net; the controller refuses to start with another net
  std::string_view verification_hash;
  std::span<const VerifiedProperty> verdicts;
  std::span<const Instance> instances;  ///< agent by agent
  std::span<const Channel> channels;
  const UpperPage* system_page;                  ///< its pages below are those of the agents
  const UpperPage* agent_page;                   ///< its pages below are the nets of the agent's instances
  std::span<const CppDriver> real_drivers;       ///< of the robot's devices
  std::span<const CppDriver> simulated_drivers;  ///< replace them in a simulated run
  std::span<const Process> processes{};          ///< empty: all agents are in one
  std::span<const std::uint32_t> process_of{};   ///< per instance, into processes
  std::uint32_t domain = 0;                      ///< of DDS
  Duration liveliness{0};  ///< a process that is silent for longer is disconnected for the others
  /// A thread goes on at most so long after it may; zero: the specification does not say it.
  Duration latency{0};
  std::span<const Resource> resources{};
  std::span<const Chain> chains{};  ///< their ages are measured; empty: the specification says no times
  /// Without those over a network, or over a channel with a communication model of its own.
  std::span<const ChainWay> chain_ways{};

  /// Whether the two ends of a channel are in different processes.
  [[nodiscard]] constexpr bool is_networked(const Channel& channel) const {
    return !processes.empty() && process_of[channel.from.instance] != process_of[channel.to.instance];
  }
};

}  // namespace tessera
