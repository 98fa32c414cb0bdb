#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "../file_bytes.hpp"
#include "named_net.hpp"
#include "tessera/bounded_string.hpp"
#include "tessera/controller.hpp"
#include "tessera/device.hpp"
#include "tessera/subsystem.hpp"
#include "tessera/tables.hpp"

namespace tessera::testing {

/// The data and actions of a Script subsystem. Values are doubles; x is the value in channels.
struct ScriptState {
  Input<double> x, y;
  SkippableOutput<double> out_x;
  Output<double> out_y;
  Input<double> sensed;
  Output<double> command;
  double gain = 1;
  std::int32_t level = 3;
  bool flag = false;
  BoundedString<8> label;
  std::array<double, 3> points{1, 2, 3};
  std::uint32_t count = 0;  // memory, as are the next two
  BoundedString<8> word;
  std::array<double, 600> map{};  // more than 4 KiB
  Context context;
  std::uint16_t behaviour = 0;
};

struct Script {
  std::function<void(ScriptState&)> call = [](ScriptState&) {};
  std::function<Outcome(const ScriptState&)> decide = [](const ScriptState&) { return Outcome::go_on; };
  std::function<int(const ScriptState&, bool failed)> route = [](const ScriptState&, bool) { return 0; };
  /// The answer for output x, which a net with such transitions may skip.
  std::function<Sending(const ScriptState&)> sends = [](const ScriptState&) { return Sending::sends; };
  bool senses = false, acts = false;  ///< has a real receptor, a real effector
  bool remembers = false;             ///< has memory
  bool writes = true;                 ///< `call` follows a write of the present values of x and y
  double safe = -1;
  Bindings::Limits limits{};  ///< of the command
};

/// A device that remembers.
struct Devices {
  std::vector<double> commands;        ///< of effectors, in order, but for the first
  std::vector<double> at_opening;      ///< the first commands of effectors, which they are given when opened
  std::function<bool(double&)> sense;  ///< of receptors
  std::function<bool(double)> accept;  ///< of effectors, from any thread; unset: yes
  std::function<void()> made;          ///< while an effector is made
};

/// A system written by hand. Owns the data that the tables point to; one at a time.
class TestSystem {
 public:
  TestSystem();
  TestSystem(const TestSystem&) = delete;
  TestSystem& operator=(const TestSystem&) = delete;
  ~TestSystem();

  /// Returns its index. Agents in order: "robot", then others.
  std::uint32_t add(std::string path, const SubsystemNet& net, Script script, Duration period = Duration{0},
                    Duration stale = Duration{0}, Kind kind = Kind::control, Policies policies = {});
  void connect(std::uint32_t from, std::string_view out_port, std::uint32_t to, std::string_view in_port,
               std::span<const FusedPlace> places, Duration send_timeout = Duration{0},
               Duration receive_timeout = Duration{0}, std::uint16_t slots = 1);
  /// Puts the instances into processes "p0", "p1", ...: one number per instance.
  void deploy(std::vector<std::uint32_t> process_of, Duration liveliness = std::chrono::seconds(1));
  /// The system made from the added parts; valid until the next change.
  [[nodiscard]] const System& system();

  Devices devices;
  Duration latency{0};
  std::vector<DriverOption> panel;  ///< before `add`: its receptors are panels with these options

 private:
  std::vector<std::unique_ptr<std::string>> names_;
  std::vector<Instance> instances_;
  /// port: its name; empty: the end is not used.
  [[nodiscard]] End end_of(std::uint32_t instance, std::string_view port) const;

  std::vector<Channel> channels_;
  std::vector<CppDriver> drivers_;
  std::vector<Process> processes_;
  std::vector<std::uint32_t> process_of_;
  Duration liveliness_{0};
  std::string hash_;
  System system_{};
};

/// Runs it; fails the test when it cannot start.
[[nodiscard]] RunSummary run(TestSystem& system, const RunOptions& options);

[[nodiscard]] inline RunOptions simulated(Duration duration) {
  RunOptions options;
  options.duration = duration;
  return options;
}
[[nodiscard]] inline RunOptions steady(Duration duration) {
  RunOptions options = simulated(duration);
  options.clock = RunOptions::Clock::steady;
  return options;
}

/// A name for a file of this test in a fresh directory.
[[nodiscard]] std::string scratch_file(const std::string& name);

}  // namespace tessera::testing
