// Drivers: which of them a run makes, their options, and their life.

#include <gtest/gtest.h>

#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

#include "drivers/whole_driver.hpp"
#include "nets.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

/// The calls of the drivers of this file, in order.
std::vector<std::string>& story() {
  static std::vector<std::string> lines;
  return lines;
}
std::vector<std::string> take_story() { return std::exchange(story(), {}); }

/// Records every call; options make it fail.
class Teller final : public Effector<double> {
 public:
  explicit Teller(const DriverSetup& setup)
      : name_(setup.text("name")),
        refuses_open_(setup.flag_or("refuses_open", false)),
        refuses_safe_(setup.flag_or("refuses_safe", false)),
        throws_safe_(setup.flag_or("throws_safe", false)),
        beats_(setup.duration_or("beats", 0ms)) {
    if (setup.flag_or("throws", false)) throw std::runtime_error("no such pin");
    tell("made");
  }
  bool open() override {
    if (refuses_open_) throw std::runtime_error("no cable");
    tell("open");
    return true;
  }
  bool write(const double& value) override {
    tell("write " + std::to_string(static_cast<int>(value)));
    if (throws_safe_) throw std::runtime_error("no current");
    return !refuses_safe_ || value != -1;
  }
  void close() override { tell("close"); }
  [[nodiscard]] Duration heartbeat_period() const override { return beats_; }
  void heartbeat() override { tell("beat"); }

 private:
  void tell(const std::string& what) const {
    static std::mutex mutex;  // two motors have a thread each
    const std::lock_guard lock(mutex);
    story().push_back(name_ + " " + what);
  }
  std::string name_;
  bool refuses_open_, refuses_safe_, throws_safe_;
  Duration beats_;
};

constexpr DriverOption named_real[] = {{"name", "real"}};
constexpr DriverOption named_simulated[] = {{"name", "simulated"}};
constexpr auto make_teller = make_driver<RealEffector, double, Teller>;

/// Two motors with a driver of either kind each.
struct TwoMotors : ::testing::Test {
  TwoMotors() {
    take_story();
    Script script;
    script.acts = true;
    script.call = [](ScriptState& state) { state.command = 5; };
    robot.add("robot.motor", nets::alone, script, 10ms, 0ms, Kind::effector);
    robot.add("robot.lift", nets::alone, script, 10ms, 0ms, Kind::effector);
    system = robot.system();
  }
  /// empty: it ran.
  std::string run(const RunOptions& options = simulated(15ms)) {
    system.real_drivers = real;
    system.simulated_drivers = simulation;
    std::string error;
    return execute(system, options, error) ? "" : error;
  }
  static bool told_of(const std::vector<std::string>& lines, const std::string& start) {
    return std::any_of(lines.begin(), lines.end(),
                       [&](const std::string& line) { return line.starts_with(start); });
  }

  static constexpr std::array places{"spec.yaml:3", "spec.yaml:4", "spec.yaml:7", "spec.yaml:8"};
  TestSystem robot;
  System system;
  std::vector<CppDriver> real{{"robot.motor.command", "Teller", &places[0], named_real, nullptr, make_teller},
                              {"robot.lift.command", "Teller", &places[1], named_real, nullptr, make_teller}};
  std::vector<CppDriver> simulation{
      {"robot.motor.command", "Teller", &places[2], named_simulated, nullptr, make_teller},
      {"robot.lift.command", "Teller", &places[3], named_simulated, nullptr, make_teller}};
};

TEST_F(TwoMotors, ASimulatedRunNeverMakesARealDriver) {
  EXPECT_EQ(run(), "");
  RunOptions steady_with_simulated = steady(15ms);
  steady_with_simulated.simulated_drivers = true;
  EXPECT_EQ(run(steady_with_simulated), "");
  simulation.pop_back();
  EXPECT_EQ(run(), "the real buffer robot.lift.command has no simulated driver");
  EXPECT_FALSE(told_of(take_story(), "real"));
}

TEST_F(TwoMotors, ARealRunMakesRealDriversOnly) {
  EXPECT_EQ(run(steady(15ms)), "");
  const std::vector<std::string> lines = take_story();
  EXPECT_TRUE(told_of(lines, "real"));
  EXPECT_FALSE(told_of(lines, "simulated"));
}

TEST_F(TwoMotors, HardwareInTheLoopIsRealAndNotFasterThanTheWallClock) {
  RunOptions options = simulated(60ms);
  options.hardware = {"robot.lift"};
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(run(options), "");
  EXPECT_GE(std::chrono::steady_clock::now() - start, 60ms);
  const std::vector<std::string> lines = take_story();
  EXPECT_EQ(std::count(lines.begin(), lines.end(), "real made"), 1);
  EXPECT_EQ(std::count(lines.begin(), lines.end(), "simulated made"), 1);
}

TEST_F(TwoMotors, HardwareIsRefusedWhereTimeCouldLeapAndWhereThereIsNone) {
  RunOptions options = simulated(15ms);
  options.hardware = {"robot.arm"};
  EXPECT_NE(run(options).find("hardware is asked for at 'robot.arm'"), std::string::npos);
  options.hardware = {"robot.lift"};
  options.monitor = true;
  EXPECT_NE(run(options).find("cannot be paused"), std::string::npos);
  RunOptions real_run = steady(15ms);
  real_run.hardware = {"robot.lift"};
  EXPECT_NE(run(real_run).find("for simulated runs"), std::string::npos);
  const std::vector<std::string> lines = take_story();
  EXPECT_FALSE(told_of(lines, "real"));
  EXPECT_FALSE(told_of(lines, "simulated open"));
}

TEST_F(TwoMotors, EveryDeviceIsMadeThenOpenedAndSafeBeforeTheFirstCommandAndClosedAfterTheLast) {
  static constexpr DriverOption a[] = {{"name", "a"}}, b[] = {{"name", "b"}};
  simulation[0].options = a;
  simulation[1].options = b;
  EXPECT_EQ(run(simulated(5ms)), "");
  const std::vector<std::string> lines = take_story();
  const std::vector<std::string> beginning{"a made",     "b made", "a open",
                                           "a write -1", "b open", "b write -1"};
  ASSERT_GT(lines.size(), beginning.size() + 2);
  EXPECT_EQ(std::vector(lines.begin(), lines.begin() + 6), beginning);
  EXPECT_EQ(std::vector(lines.end() - 2, lines.end()), (std::vector<std::string>{"b close", "a close"}));
  EXPECT_EQ(std::count(lines.begin(), lines.end(), "a write 5"), 1);
}

TEST_F(TwoMotors, ADeviceThatCannotBeOpenedKeepsTheRunFromStarting) {
  static constexpr DriverOption broken[] = {{"name", "b"}, {"refuses_open", true}};
  simulation[1].options = broken;
  EXPECT_EQ(run(), "the device of robot.lift.command cannot be opened: no cable");
  EXPECT_EQ(take_story(), (std::vector<std::string>{"simulated made", "b made", "simulated open",
                                                    "simulated write -1", "simulated close"}));
}

TEST_F(TwoMotors, ADeviceThatRefusesItsFirstSafeCommandKeepsTheRunFromStarting) {
  static constexpr DriverOption deaf[] = {{"name", "b"}, {"refuses_safe", true}};
  simulation[1].options = deaf;
  EXPECT_EQ(run(), "the device of robot.lift.command is open and refuses its safe command");
  const std::vector<std::string> lines = take_story();
  EXPECT_EQ(std::vector(lines.end() - 2, lines.end()),
            (std::vector<std::string>{"b close", "simulated close"}));
}

TEST_F(TwoMotors, ADeviceWhoseFirstSafeCommandThrowsIsNamedAndClosedAndNoOtherIsOpened) {
  static constexpr DriverOption broken[] = {{"name", "b"}, {"throws_safe", true}};
  simulation[0].options = broken;
  EXPECT_EQ(run(), "the device of robot.motor.command is open and refuses its safe command: no current");
  EXPECT_EQ(take_story(),
            (std::vector<std::string>{"b made", "simulated made", "b open", "b write -1", "b close"}));
}

TEST_F(TwoMotors, WhatAConstructorThrowsIsToldWithTheLineOfTheSpecification) {
  static constexpr DriverOption thrown[] = {{"name", "b"}, {"throws", true}},
                                unknown[] = {{"name", "b"}, {"pni", 4.0}};
  simulation[0].options = thrown;
  simulation[1].options = unknown;
  EXPECT_EQ(run(),
            "spec.yaml:7: the driver Teller of robot.motor.command: no such pin\n"
            "spec.yaml:8: the driver Teller of robot.lift.command: the driver has no option 'pni'");
  simulation[0].options = simulation[1].options = {};
  EXPECT_NE(run().find("option 'name' is missing"), std::string::npos);
}

TEST_F(TwoMotors, HeartbeatsComeWhileTheSubsystemWaits) {
  static constexpr DriverOption beating[] = {{"name", "b"}, {"beats", 2.0, "ms"}};
  simulation[1].options = beating;
  EXPECT_EQ(run(simulated(99ms)), "");
  const std::vector<std::string> lines = take_story();
  EXPECT_EQ(std::count(lines.begin(), lines.end(), "b beat"), 50) << "every 2 ms from 0 to 98 ms";
  EXPECT_EQ(std::count(lines.begin(), lines.end(), "b write 5"), 10);
}

/// Waits for ever for a subsystem that has ended, with a device that needs heartbeats all the time.
TEST(Heartbeats, DoNotHideThatNothingCanEverHappenAgain) {
  static constexpr DriverOption beating[] = {{"name", "b"}, {"beats", 2.0, "ms"}};
  const std::vector<CppDriver> drivers{{"robot.b.command", "Teller", nullptr, beating, nullptr, make_teller}};
  for (const RunOptions& options : {simulated(1h), steady(60s)}) {
    TestSystem robot;
    Script once, waits;
    once.decide = [](const ScriptState&) { return Outcome::terminal; };
    waits.acts = true;
    const auto a = robot.add("robot.a", nets::nb_sender, once, 10ms);
    const auto b = robot.add("robot.b", nets::b_receiver, waits, 0ms, 0ms, Kind::effector);
    robot.connect(a, "x", b, "x", buffered);
    System system = robot.system();
    system.real_drivers = system.simulated_drivers = drivers;
    take_story();
    std::string error;
    const std::optional<RunSummary> summary = execute(system, options, error);
    ASSERT_TRUE(summary) << error;
    EXPECT_NE(summary->ended.find("nothing can ever happen again: robot.b"), std::string::npos)
        << summary->ended;
    const std::vector<std::string> lines = take_story();
    EXPECT_GE(std::count(lines.begin(), lines.end(), "b beat"),
              options.clock == RunOptions::Clock::steady ? 3 : 1);
  }
}

/// A class that takes no setup.
class Plain final : public Effector<double> {
  bool write(const double&) override { return true; }
};

TEST_F(TwoMotors, OptionsOfAClassThatTakesNoneAreAnError) {
  simulation[1] = {"robot.lift.command", "Plain", &places[3],
                   named_simulated,      nullptr, make_driver<RealEffector, double, Plain>};
  EXPECT_EQ(run(),
            "spec.yaml:8: the driver Plain of robot.lift.command: the driver has no option 'name': its class "
            "has no "
            "constructor that takes a const tessera::DriverSetup&");
  simulation[1].options = {};
  EXPECT_EQ(run(), "");
}

TEST(DriverSetup, KnowsWhoTheDriverIs) {
  const DriverSetup of_buffer("robot[3].motor.left"), of_subsystem("arm.joints");
  EXPECT_EQ(of_buffer.agent(), "robot[3]");
  EXPECT_EQ(of_buffer.index(), 3U);
  EXPECT_EQ(of_buffer.subsystem(), "motor");
  EXPECT_EQ(of_buffer.buffer(), "left");
  EXPECT_EQ(of_subsystem.index(), std::nullopt);
  EXPECT_EQ(of_subsystem.subsystem(), "joints");
  EXPECT_EQ(of_subsystem.buffer(), "");
}

TEST(DriverSetup, ConvertsUnitsAndRefusesOtherQuantitiesAndTypes) {
  const DriverSetup setup("a.b.c", {{"radius", 33.0, "mm"},
                                    {"pin", 4.0},
                                    {"share", 0.5},
                                    {"port", "/dev/ttyUSB0"},
                                    {"inverted", true},
                                    {"every", 1.5, "min"},
                                    {"gain", 2.0, "V/rad"}});
  EXPECT_DOUBLE_EQ(setup.number("radius", "m"), 0.033);
  EXPECT_EQ(setup.number("pin", "m"), 4) << "a number without a unit counts as one in it";
  EXPECT_EQ(setup.integer("pin"), 4);
  EXPECT_EQ(setup.text("port"), "/dev/ttyUSB0");
  EXPECT_TRUE(setup.flag("inverted"));
  EXPECT_EQ(setup.duration("every"), 90s);
  EXPECT_EQ(setup.number("gain", "V/rad"), 2);
  EXPECT_EQ(setup.number_or("nothing", 7), 7);
  EXPECT_EQ(setup.text_or("nothing", "x"), "x");
  const auto message = [](const auto& ask) -> std::string {
    try {
      ask();
    } catch (const DriverError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message([&] { (void)setup.number("radius"); }),
            "option 'radius' must be a number without a unit, and it is a number with the unit 'mm'");
  EXPECT_EQ(message([&] { (void)setup.number("radius", "s"); }),
            "option 'radius' must be a number in s, and it is a number with the unit 'mm'");
  EXPECT_EQ(message([&] { (void)setup.integer("share"); }),
            "option 'share' must be a whole number, and it is 0.5");
  EXPECT_EQ(message([&] { (void)setup.text("pin"); }),
            "option 'pin' must be a text, and it is a number; write it in quotes");
  EXPECT_EQ(message([&] { (void)setup.duration("pin"); }),
            "option 'pin' must be a time such as 200 ms, and it is a number");
  EXPECT_NE(
      message([&] { (void)setup.flag("nothing"); }).find("option 'nothing' is missing; given are radius"),
      std::string::npos);
}

/// All real buffers of a subsystem at once.
struct Both {
  double left = 0;
  std::int32_t right = 0;
};
struct CountingSource final : Receptor<Both> {
  std::optional<Both> read() override {
    ++reads;
    if (fails) throw std::runtime_error("bus");
    return reads == 3 ? std::nullopt : std::optional(Both{static_cast<double>(reads), reads * 10});
  }
  std::int32_t reads = 0;
  bool fails = false;
};
struct CountingSink final : Effector<Both> {
  bool write(const Both& value) override {
    commands.emplace_back(value.left, value.right);
    return true;
  }
  std::vector<std::pair<double, int>> commands;
};

template <class T>
std::span<std::byte> bytes(T& value) {
  return std::as_writable_bytes(std::span(&value, 1));
}

TEST(WholeDriver, IsReadOnceAnIterationForAllItsBuffers) {
  Bindings bindings;
  Input<double> left;
  Input<std::int32_t> right;
  Both& both = bindings.all_real<Both>();
  bindings.real_input("left", left, &both.left);
  bindings.real_input("right", right, &both.right);
  auto made = std::make_unique<CountingSource>();
  CountingSource& source = *made;
  const auto parts = parts_of(std::unique_ptr<RealReceptor>(std::move(made)), bindings);
  double a = 0;
  std::int32_t b = 0;
  const auto read_both = [&] {
    const bool first = parts[0]->read(bytes(a));
    return std::pair(first, parts[1]->read(bytes(b)));
  };
  EXPECT_EQ(read_both(), std::pair(true, true));
  EXPECT_EQ(read_both(), std::pair(true, true));
  EXPECT_EQ(a, 2);
  EXPECT_EQ(b, 20);
  EXPECT_EQ(read_both(), std::pair(false, false)) << "the third reading has no value";
  EXPECT_EQ(b, 20);
  EXPECT_EQ(source.reads, 3);
  EXPECT_TRUE(parts[1]->read(bytes(b))) << "the first is left out, as an injected fault does";
  EXPECT_EQ(b, 40);
  source.fails = true;
  EXPECT_THROW((void)parts[0]->read(bytes(a)), std::runtime_error);
  source.fails = false;
  EXPECT_EQ(read_both(), std::pair(true, true));
  EXPECT_EQ(a, 6);
  EXPECT_EQ(b, 60);
}

TEST(WholeDriver, IsWrittenOnceAnIterationWithAllItsBuffers) {
  Bindings bindings;
  Output<double> left;
  Output<std::int32_t> right;
  Both& both = bindings.all_real<Both>();
  bindings.real_output("left", left, 0.0, &both.left);
  bindings.real_output("right", right, 0, &both.right);
  auto made = std::make_unique<CountingSink>();
  CountingSink& sink = *made;
  const auto parts = parts_of(std::unique_ptr<RealEffector>(std::move(made)), bindings);
  for (int round = 1; round <= 2; ++round) {
    double a = round;
    std::int32_t b = 10 * round;
    EXPECT_TRUE(parts[0]->write(bytes(a)));
    EXPECT_TRUE(parts[1]->write(bytes(b)));
  }
  EXPECT_EQ(sink.commands, (std::vector<std::pair<double, int>>{{1, 10}, {2, 20}}));
}

TEST(DriverSetup, SaysThatThereIsNoWorld) {
  EXPECT_THROW(static_cast<void>(DriverSetup("robot.motor.left").world()), DriverError);
}

}  // namespace
}  // namespace tessera::testing
