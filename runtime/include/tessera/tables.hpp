#pragma once

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <string_view>

#include "tessera/device.hpp"
#include "tessera/net_words.hpp"
#include "tessera/subsystem.hpp"
#include "tessera/time.hpp"
#include "tessera/transition_role.hpp"

/// The net of a generated controller: constant tables, read once at start. Generated code includes this
/// file and states which version of it was used.
namespace tessera {

inline constexpr int tables_version = 4;

/// The operation that a token starts when it arrives in a place. The last two are no operations of the net:
/// they evaluate conditions when the token arrives, and store which of the conditional transitions
/// behind the place may fire.
struct Does {
  enum class Kind : std::uint8_t {
    nothing,
    call,
    count,
    write,
    read,
    begin,  ///< of a subsystem that receives first: waits for the instant of its rate, and counts
    decide,
    route
  } kind = Kind::nothing;
  std::string_view subject;  ///< behaviour (call, begin, decide, route) or port (write, read)
  std::uint16_t slot = 1;    ///< of the channel's memory, from 1 (write, read)
};
[[nodiscard]] constexpr Does calls(std::string_view behaviour) { return {Does::Kind::call, behaviour}; }
[[nodiscard]] constexpr Does counts() { return {Does::Kind::count, {}}; }
[[nodiscard]] constexpr Does begins(std::string_view behaviour) { return {Does::Kind::begin, behaviour}; }
[[nodiscard]] constexpr Does writes(std::string_view port, std::uint16_t slot = 1) {
  return {Does::Kind::write, port, slot};
}
[[nodiscard]] constexpr Does reads(std::string_view port, std::uint16_t slot = 1) {
  return {Does::Kind::read, port, slot};
}
[[nodiscard]] constexpr Does decides(std::string_view behaviour) { return {Does::Kind::decide, behaviour}; }
[[nodiscard]] constexpr Does routes(std::string_view behaviour) { return {Does::Kind::route, behaviour}; }

/// When an enabled transition may fire.
struct Guard {
  enum class Kind : std::uint8_t { none, go_on, terminal, error, next, elapsed } kind = Kind::none;
  std::uint16_t entry = 0;  ///< index into `next`, from 0
  std::string_view
      port{};  ///< elapsed: the port with the timeout; empty: that of the channel that the transition touches
};
inline constexpr Guard if_go_on{Guard::Kind::go_on}, if_terminal{Guard::Kind::terminal},
    if_error{Guard::Kind::error}, if_elapsed{Guard::Kind::elapsed};
[[nodiscard]] constexpr Guard if_next(std::uint16_t entry) { return {Guard::Kind::next, entry}; }
[[nodiscard]] constexpr Guard if_elapsed_at(std::string_view port) { return {Guard::Kind::elapsed, 0, port}; }

/// A place of a subsystem. Its name lacks the path of the subsystem ("follow.snd.motion.2").
struct Place {
  std::string_view name;
  Does does{};
};

/// The role of a transition in recordings.
struct TableRole {
  Step step = Step::other;
  std::string_view behaviour{};  ///< the behaviour that it belongs to, or leaves
  std::string_view port{};       ///< the port of its block
};

/// inputs and outputs name places of the subsystem ("in"), or fused places of a channel as
/// "port/place" ("motion/full").
struct Transition {
  std::string_view name;
  std::initializer_list<std::string_view> inputs, outputs;
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

struct Behaviour {
  std::string_view name;
  Duration takes{0};  ///< simulated time of its transition function
};

/// The part of the net that one subsystem executes.
struct SubsystemNet {
  std::span<const Behaviour> behaviours;
  std::span<const Port> ports;
  std::span<const Place> places;
  std::span<const Transition> transitions;
  std::string_view in = "in", out = "out";  ///< the places where its token enters and leaves
};

enum class Kind : std::uint8_t { control, receptor, effector };

/// The reaction of a subsystem with a rate to instants that it missed because its own work took too long.
enum class Overrun : std::uint8_t {
  skip,      ///< leaves them out
  catch_up,  ///< runs the missed iterations late, one after the other
  fault      ///< leaves them out; the next iteration, which is late, fails without calling its function
};

/// How the operating system schedules the thread of a subsystem on the steady clock.
struct RealTime {
  enum class Policy : std::uint8_t { usual, fifo, round_robin } policy = Policy::usual;
  int priority = 0;  ///< 1 .. 99, unless usual
  int cpu = -1;      ///< the processor it stays on; -1: any
};

/// How a subsystem treats time and faults.
struct Policies {
  Overrun overrun = Overrun::skip;
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

/// A name of a place: a text of the tables, or one of the words. Words get their values when a program is
/// linked, and tables are constants of the compiler: they must not depend on the order in which sources are
/// initialised.
class PlaceName {
 public:
  constexpr PlaceName(const char* text) : text_(text) {}              // NOLINT(google-explicit-constructor)
  constexpr PlaceName(std::string_view text) : text_(text) {}         // NOLINT(google-explicit-constructor)
  constexpr PlaceName(const std::string_view* word) : word_(word) {}  // NOLINT(google-explicit-constructor)
  operator std::string_view() const { return word_ == nullptr ? text_ : *word_; }  // NOLINT

 private:
  std::string_view text_;
  const std::string_view* word_ = nullptr;
};

/// A place of the memory of a channel.
struct FusedPlace {
  /// See net::PlaceRole. none: only the name is known.
  enum class Role : std::uint8_t {
    none,
    lock,
    empty,
    full,
    acknowledged,
    idle,
    sent,
    more,
    sent_memory,
    received_memory
  };
  PlaceName name;
  std::uint32_t tokens;
  Role role = Role::none;
};
namespace shared_places {
using Role = FusedPlace::Role;
inline constexpr FusedPlace lock{&words::lock, 1, Role::lock}, empty{&words::empty, 1, Role::empty},
    full{&words::full, 0, Role::full}, acknowledged{&words::acknowledged, 0, Role::acknowledged},
    idle{&words::idle, 1, Role::idle}, sent{&words::sent, 0, Role::sent}, more{&words::more, 0, Role::more},
    sent_memory{&words::sent_memory, 1, Role::sent_memory},
    received_memory{&words::received_memory, 1, Role::received_memory};
}  // namespace shared_places
inline constexpr FusedPlace asynchronous[] = {shared_places::lock};
inline constexpr FusedPlace buffered[] = {shared_places::empty, shared_places::full};
inline constexpr FusedPlace acknowledged[] = {shared_places::empty, shared_places::full,
                                              shared_places::acknowledged};
// The places of channels between processes (docs/use/fleets.md). The last list is for a sender that waits without
// a timeout.
inline constexpr FusedPlace networked_exchange[] = {shared_places::sent_memory,
                                                    shared_places::received_memory};
inline constexpr FusedPlace networked[] = {shared_places::idle, shared_places::sent, shared_places::more,
                                           shared_places::empty, shared_places::full};
inline constexpr FusedPlace networked_single[] = {shared_places::idle, shared_places::sent,
                                                  shared_places::empty, shared_places::full};

struct End {
  std::uint32_t instance;  ///< into System::instances
  std::string_view port;   ///< empty: no behaviour of that instance uses the channel
};

struct Channel {
  std::string_view name;  ///< "robot.control.motion->robot.motor.velocity"
  End from, to;
  std::span<const FusedPlace> places;
  Duration send_timeout{0}, receive_timeout{0};  ///< zero: waits for ever
  std::uint16_t slots{1};                        ///< values that the memory holds
};

/// A driver that the user wrote in C++; exactly one of the two makers is set.
struct CppDriver {
  std::string_view path;  ///< "robot.sensor.left"; or "arm.joints": all real buffers of that subsystem
  std::string_view class_name;
  std::string_view place;  ///< in the specification: "spec.yaml:41"
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
  std::span<const CppDriver> real_drivers;       ///< of the robot's devices
  std::span<const CppDriver> simulated_drivers;  ///< replace them in a simulated run
  std::span<const Process> processes{};          ///< empty: all agents are in one
  std::span<const std::uint32_t> process_of{};   ///< per instance, into processes
  std::uint32_t domain = 0;                      ///< of DDS
  Duration liveliness{0};  ///< a process that is silent for longer is disconnected for the others

  /// Whether the two ends of a channel are in different processes.
  [[nodiscard]] constexpr bool is_networked(const Channel& channel) const {
    return !processes.empty() && process_of[channel.from.instance] != process_of[channel.to.instance];
  }
};

}  // namespace tessera
