#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "tessera/driver_setup.hpp"
#include "tessera/poses.hpp"
#include "tessera/result.hpp"
#include "tessera/time.hpp"
#include "tessera/value_encoding.hpp"
#include "tessera/world_state.hpp"

namespace tessera {

/// The life of a device, which all drivers have in common.
///
/// A run takes these steps in order: it makes every driver; it calls `open` of every device, one after the
/// other, effectors first; it reads, writes and calls heartbeats; it gives the last safe command; it calls
/// `close` of every opened device, the last one first.
///
/// * The constructor only stores what it is given. It does not touch the device.
/// * Each effector is given its safe command at once after its `open`, so every device of the system has got
///   its safe command before the first transition fires.
/// * If a device cannot be opened or refuses this first safe command, the run does not start. The devices
///   that are open already are closed; the last thing that they were given is the safe command.
/// * Signals are handled before the first device is opened.
///
/// Threads: constructor, `open`, `close` and destructor are called by the thread that starts the run;
///          everything else by the thread of the subsystem. The safe command of a subsystem whose user code
///          does not return may come from another thread. Two calls to one driver never overlap.
class Device {
 public:
  Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  virtual ~Device() = default;

  /// Connects to the device. false, or an exception: the run does not start. An exception says why.
  [[nodiscard]] virtual bool open() { return true; }
  /// Called after the last safe command on every orderly way out of the run. An exception becomes a warning.
  virtual void close() {}
  /// How often `heartbeat` is to be called; zero: never. Asked once, before `open`. Half of the device's own
  /// timeout is a good choice, because a wake-up can come late.
  [[nodiscard]] virtual Duration heartbeat_period() const { return Duration::zero(); }
  /// Called by the subsystem's own thread from the start of the run to its end: while the subsystem waits,
  /// and after every transition function. It is not called while user code runs. So the timer of a device
  /// with a dead-man's switch expires when user code hangs, and when the process is gone. An exception is a
  /// fault of the class `device`; the effectors of the subsystem get the safe command.
  virtual void heartbeat() {}
};

/// A real receptor R: read before every transition function of its virtual receptor.
class RealReceptor : public Device {
 public:
  /// Fills `value`: the bytes of the real buffer's type, or the address of an object of that type if it is
  /// not trivially copyable. false: there is no value now; the buffer keeps the old one, which is not fresh.
  [[nodiscard]] virtual bool read(std::span<std::byte> value) = 0;
};

/// A real effector E: written after every transition function of its virtual effector, and whenever the
/// device gets the safe command.
class RealEffector : public Device {
 public:
  /// false: the device refused, which is an error of the subsystem.
  [[nodiscard]] virtual bool write(std::span<const std::byte> value) = 0;
};

/// A driver of an effector that also derives from Guarded lets the guardian process give its device
/// the safe command after the controller has died (docs/reference/safety.md). The guardian makes a driver from
/// the same setup and calls `open`, `write` with the safe value, and `close`. If one of them fails,
/// it tries again for a while.
///
/// So the driver has to work in another process. Its device can be opened again after the process
/// that had it open has died. It can also be opened a second time while a controller that is only
/// suspended still has it open.
class Guarded {
 public:
  virtual ~Guarded() = default;
};
template <class Class>
inline constexpr bool is_guarded = std::is_base_of_v<Guarded, Class>;

/// One value of an option: a number in SI units, true or false, or a name.
struct WorldValue {
  std::variant<double, bool, std::string> value = 0.0;
  /// The unit of a number: "m", "rad", "s" or "Hz". Empty: it has none.
  std::string unit{};

  WorldValue() = default;
  WorldValue(double number, std::string its_unit = {}) : value(number), unit(std::move(its_unit)) {}
  WorldValue(int number) : value(static_cast<double>(number)) {}
  WorldValue(bool flag) : value(flag) {}
  WorldValue(std::string name) : value(std::move(name)) {}
  WorldValue(const char* name) : value(std::string(name)) {}
};
/// An option of a device of the world: one value, or a list.
struct WorldOption {
  std::vector<WorldValue> values;
  bool is_list = false;

  WorldOption() = default;
  template <class Value>
  requires std::is_constructible_v<WorldValue, Value> WorldOption(Value value)
      : values{WorldValue(std::move(value))} {}
  WorldOption(std::vector<WorldValue> list) : values(std::move(list)), is_list(true) {}
};

/// A device of the simulated world behind a real buffer, as specifications and command lines name it.
struct DriverRequest {
  std::string path;                            ///< "robot.sensor.left"
  std::string kind;                            ///< "sensor"
  std::vector<std::string> targets;            ///< {"yaw", "shoulder"}
  std::map<std::string, WorldOption> options;  ///< e.g. {"noise", 0.01}
  /// The type of the real buffer, as tessera/value_encoding.hpp writes it: "float64[4]".
  std::string type{};
  /// Reads and stores values of that type. nullptr: the device is only to be judged.
  const ValueEncoding* encoding = nullptr;
  /// The declared unit of each scalar of the buffer, in the order of its type; empty: none has a unit.
  std::vector<std::string> units{};

  /// The agent that owns the device: "robot[3]" of "robot[3].sensor.left".
  [[nodiscard]] std::string agent() const { return path.substr(0, path.find('.')); }
};
template <class T>
[[nodiscard]] DriverRequest request_for(DriverRequest request) {
  request.encoding = value_encoding_of<T>();
  request.type = request.encoding->type();
  return request;
}

/// The mistake in a request.
struct DriverProblem {
  std::string text;            ///< "the world has no sensor 'gyr'"
  std::string hint;            ///< "did you mean 'gyro'?"; empty: none
  std::string subject;         ///< the target or the name of the option that is wrong; empty: all of it
  bool second_writer = false;  ///< another device writes the same element of the world
};

/// A simulator that is a separate program and a server: CoppeliaSim.
struct WorldServer {
  std::string host = "localhost";
  std::uint16_t port = 23000;
  std::string scene;  ///< file that the server loads; empty: the scene that it has open
  Duration timeout = std::chrono::seconds(10);  ///< for one answer
};

struct WorldOptions {
  std::string world;  ///< MJCF file; empty: another program simulates the world (`server`)
  std::string track;  ///< PNG of the floor, dark is line; empty: a white floor
  double metres_per_pixel = 0.005;
  std::optional<double> start_x_m, start_y_m, start_heading_rad;  ///< unset: as the world file says
  double footprint_m = 0.008;                                     ///< diameter of a light sensor's view
  std::uint64_t seed = 1;                                         ///< of sensor noise
  std::string trace;   ///< file that gets the path of the robot; empty: none
  std::string checks;  ///< JSON: the checks and measures of the run (docs/use/worlds.md); empty: none
  std::string models;  ///< JSON: the placed models (docs/use/worlds.md); empty: none
  std::optional<WorldServer> server{};
  /// No run follows: the world is only asked about problems with its devices. A world on a server then makes
  /// no connection, and reports what it knows without one.
  bool only_asked = false;
};

/// A check of the run that has failed.
struct WorldFailure {
  std::string check;  ///< its name
  std::string text;   ///< its demand, and the facts
  double time_s = 0;  ///< by the simulated clock
};

/// The appearance of a simulated world.
struct WorldScene {
  struct Body {
    std::string name;
    std::string agent;  ///< the agent whose devices it carries; empty: none, or it is not known
    std::optional<std::size_t> parent{};  ///< number of the body that it is attached to; nullopt: none of
                                          ///< these
  };
  /// A light sensor: the point at which it looks, in the frame of a body, and the diameter of that point.
  struct Eye {
    std::size_t body = 0;  ///< number in `bodies`
    std::array<double, 3> at_m{};
    double footprint_m = 0;
  };
  std::string glb;           ///< a glTF 2.0 file with a node per body, named like it
  std::vector<Body> bodies;  ///< those that can move
  std::vector<Eye> eyes{};   ///< of the bodies, in the order in which the devices were made
};

/// Takes the poses of the bodies of a world.
class PoseSink {
 public:
  virtual ~PoseSink() = default;
  /// time: by the clock of the world. poses: in the order of WorldScene::bodies; valid during the call.
  virtual void take(Time time, std::span<const BodyPose> poses) = 0;
};

/// A simulated world. It makes devices and moves in lock-step with the clock.
///
/// Threads: advance_to and the devices may be called from different threads (the world locks).
class World {
 public:
  virtual ~World() = default;
  /// nullptr and `error` if the world has no such thing, or it does not fit the buffer.
  [[nodiscard]] virtual std::unique_ptr<RealReceptor> receptor(const DriverRequest& request,
                                                               std::string& error) = 0;
  [[nodiscard]] virtual std::unique_ptr<RealEffector> effector(const DriverRequest& request,
                                                               std::string& error) = 0;
  /// The problem with such a device; nullopt: there is none, or the world does not say.
  [[nodiscard]] virtual std::optional<DriverProblem> problem_with(const DriverRequest& /*request*/,
                                                                  bool /*effector*/) {
    return std::nullopt;
  }
  /// The world's state for drivers that are C++ classes; names are those that `agent` uses.
  /// nullptr: this world does not give it.
  [[nodiscard]] virtual std::shared_ptr<WorldState> state(const std::string& /*agent*/) { return nullptr; }
  /// Computes the physics up to `time`, deterministically. Never goes back. Throws a std::exception once the
  /// world has failed, which ends the run.
  virtual void advance_to(Time time) = 0;
  /// Why the world cannot judge by these checks and measures (WorldOptions::checks); nullopt: it can, or does
  /// not say.
  [[nodiscard]] virtual std::optional<Problem> problem_with_checks(const std::string& /*json*/) {
    return std::nullopt;
  }
  /// The checks that have failed since the last call.
  [[nodiscard]] virtual std::vector<WorldFailure> take_failures() { return {}; }
  /// JSON with `checks` and `measures` of the run (docs/use/worlds.md), at its end; empty: there are none.
  [[nodiscard]] virtual std::string results() { return {}; }
  /// nullopt: the world has no picture. devices: all devices of the run that the world may have made.
  [[nodiscard]] virtual std::optional<WorldScene> scene(std::span<const DriverRequest> /*devices*/) {
    return std::nullopt;
  }
  /// From now on, `advance_to` gives the sink the poses of all bodies of the scene once per `pose_period`.
  /// This does not change the physics. The sink must live as long as `advance_to` is called.
  virtual void show_poses(PoseSink& /*sink*/) {}
  /// Writes the trace to its file. false and `error` if that failed.
  [[nodiscard]] virtual bool finish(std::string& error) = 0;
};

/// The types of the functions that the world's shared library exports. Their names have the version of this
/// interface, so that a controller and a library of different versions do not come together.
using OpenWorld = std::unique_ptr<World> (*)(const WorldOptions& options, std::string& error);
inline constexpr const char* open_world_function = "tessera_open_world_4";
/// Lists the contents of a world as JSON. false and `error`: it does not open.
using ListWorld = bool (*)(const WorldOptions& options, std::string& json, std::string& error);
inline constexpr const char* list_world_function = "tessera_list_world_4";

/// Draws a world from recorded poses of its bodies, without simulating it.
///
/// Threads: one at a time.
class WorldPainter {
 public:
  virtual ~WorldPainter() = default;
  /// poses: in the order of WorldScene::bodies. rgb: three bytes a pixel, rows from the top. Throws
  /// std::runtime_error.
  virtual void paint(std::span<const BodyPose> poses, std::span<std::uint8_t> rgb) = 0;
};
struct PictureOptions {
  int width = 640, height = 480;
  std::string camera;                ///< a camera of the world; empty: a camera that sees the sphere below
  std::array<double, 3> middle_m{};  ///< what it looks at
  double radius_m = 1;               ///< radius of the sphere around the middle that is visible
  double elevation_deg = -50;        ///< -90: from above
  std::vector<std::string> bodies;   ///< the names of those whose poses will be given
};
/// nullptr and `error`: it does not open, has other bodies, or this machine cannot render.
using OpenPainter = std::unique_ptr<WorldPainter> (*)(const WorldOptions& options,
                                                      const PictureOptions& picture, std::string& error);
inline constexpr const char* open_painter_function = "tessera_open_painter_1";

/// A driver written by the user in C++ (`cpp: Class`) derives from Receptor<T> or Effector<T>.
/// T is the type of the real buffer, or the structure `Real` of the subsystem's header if the driver
/// serves all its real buffers.
template <class T>
class Receptor : public RealReceptor {
 public:
  using Value = T;
  /// nullopt: there is no value now. An exception is an error of the subsystem.
  virtual std::optional<T> read() = 0;
  [[nodiscard]] bool read(std::span<std::byte> value) final {
    const std::optional<T> now = read();
    if (!now) return false;
    if constexpr (std::is_trivially_copyable_v<T>)
      std::memcpy(value.data(), &*now, std::min(sizeof(T), value.size()));
    else
      *reinterpret_cast<T*>(value.data()) = *now;
    return true;
  }
};
template <class T>
class Effector : public RealEffector {
 public:
  using Value = T;
  /// false: the device refused.
  virtual bool write(const T& value) = 0;
  [[nodiscard]] bool write(std::span<const std::byte> bytes) final {
    if constexpr (std::is_trivially_copyable_v<T>) {
      T value;
      std::copy_n(bytes.data(), sizeof(T), reinterpret_cast<std::byte*>(&value));
      return write(value);
    } else {
      return write(*reinterpret_cast<const T*>(bytes.data()));
    }
  }
};

/// Makes the user's driver `Class` behind a real buffer of type `Value`. Generated controllers call this.
/// Base is RealReceptor or RealEffector.
///
/// Errors:  throws DriverError if options are given that the driver does not know, and whatever the
///          constructor of the driver throws.
template <class Base, class Value, class Class>
[[nodiscard]] std::unique_ptr<Base> make_driver(const DriverSetup& setup) {
  static_assert(std::is_base_of_v<Base, Class>,
                "the driver must derive from tessera::Receptor (receptors) or tessera::Effector (effectors)");
  if constexpr (requires { typename Class::Value; })
    static_assert(std::is_same_v<typename Class::Value, Value>,
                  "the driver has another type than its real buffer");
  static_assert(!std::is_abstract_v<Class>,
                "the driver lacks a function: `std::optional<T> read() override` of a receptor, or "
                "`bool write(const T&) override` of an effector");
  constexpr bool takes_setup = std::is_constructible_v<Class, const DriverSetup&>;
  static_assert(takes_setup || std::is_default_constructible_v<Class> || std::is_abstract_v<Class>,
                "the driver needs a constructor without parameters, or one that takes a const "
                "tessera::DriverSetup&");
  std::unique_ptr<Base> made;
  if constexpr (takes_setup)
    made = std::make_unique<Class>(setup);
  else
    made = std::make_unique<Class>();
  refuse_unknown_options(setup, takes_setup);
  return made;
}

}  // namespace tessera
