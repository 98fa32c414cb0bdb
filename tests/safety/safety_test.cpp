// Whatever happens to a controller, the last command of every device is the safe one: the rows of
// docs/reference/safety.md. TESSERA_SAFETY_RUNS=100 is the long form.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "../scratch.hpp"
#include "project/process/process.hpp"
#include "tessera/recording.hpp"
#include "trials.hpp"

namespace tessera::safety_test {
namespace {

using After = Case::After;
using Output = RobotProcess::Output;

/// A folder of one test, which only its user may enter.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (fs::temp_directory_path() / "tessera_safety_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make " + name);
    path_ = name;
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() { remove_scratch(path_); }
  [[nodiscard]] const fs::path& path() const { return path_; }
  [[nodiscard]] std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  fs::path path_;
};

constexpr char ctrl_c = '\x03', ctrl_backslash = '\x1c', ctrl_z = '\x1a', ctrl_s = '\x13';

std::int64_t hang_up(RobotProcess& robot) {
  const std::int64_t now_ns = command_log::now_ns();
  robot.hang_up();
  return now_ns;
}

/// After Ctrl-S, or with a pipe that is full, a function that never returns.
std::int64_t loop_behind_ctrl_s(RobotProcess& robot) {
  robot.type(ctrl_s);
  robot.do_harm(Harm::loop, Place::control);
  return 0;
}
std::int64_t chatter_into_full_pipe(RobotProcess& robot) {
  robot.stop_reading();
  robot.do_harm(Harm::chatter, Place::control);
  return command_log::now_ns();
}
std::int64_t chatter_into_closed_pipe(RobotProcess& robot) {
  robot.hang_up();
  robot.do_harm(Harm::chatter, Place::control);
  return command_log::now_ns();
}

/// When it goes on, its other threads wake before the one that learns that the guardian has acted.
std::int64_t stand_still(RobotProcess& robot) {
  robot.delay_supervisor(true);
  return sends(SIGSTOP)(robot);
}

std::int64_t kill_guardian(RobotProcess& robot) {
  const std::int64_t now_ns = command_log::now_ns();
  robot.send_guardian(SIGKILL);
  return now_ns;
}
std::int64_t stop_guardian(RobotProcess& robot) {
  const std::int64_t now_ns = command_log::now_ns();
  robot.send_guardian(SIGSTOP);
  return now_ns;
}

/// Both signals wait until it goes on.
std::function<std::int64_t(RobotProcess&)> stands_still_and_gets(int signal) {
  return [signal](RobotProcess& robot) {
    const std::int64_t now_ns = sends(SIGSTOP)(robot);
    robot.send(signal);
    return now_ns;
  };
}

/// The one below `tessera run`.
std::int64_t kill_controller(RobotProcess& robot) {
  const std::int64_t now_ns = command_log::now_ns();
  for (const pid_t process : robot.commanders()) kill(process, SIGKILL);
  return now_ns;
}

/// The driver never returns from a command, so the controller cannot make its device safe.
std::int64_t stop_while_a_driver_hangs(RobotProcess& robot) {
  robot.do_harm(Harm::loop, Place::driver);
  while (robot.struck_ns() == 0 && !robot.await_end(milliseconds(1))) continue;
  return sends(SIGTERM)(robot);
}

TEST(Safety, SignalsGiveTheSafeCommand) {
  try_all({
      {"SIGINT", sends(SIGINT)},
      {"SIGTERM", sends(SIGTERM)},
      {"SIGHUP", sends(SIGHUP)},
      {"SIGQUIT", sends(SIGQUIT)},
      {"SIGUSR1", sends(SIGUSR1)},
      {"SIGUSR2", sends(SIGUSR2)},
      {"SIGALRM", sends(SIGALRM)},
      {"SIGVTALRM", sends(SIGVTALRM)},
      {"SIGPROF", sends(SIGPROF)},
      {"SIGIO", sends(SIGIO)},
      {"SIGPWR", sends(SIGPWR)},
      {"SIGXCPU", sends(SIGXCPU)},
      {"SIGSTKFLT", sends(SIGSTKFLT)},
      {"a real-time signal", sends(SIGRTMIN + 3)},
      {"SIGPIPE", sends(SIGPIPE), After::goes_on},
      {"SIGXFSZ", sends(SIGXFSZ), After::goes_on},
      {"SIGTSTP", sends(SIGTSTP), After::pauses},
      {"Ctrl-C", types(ctrl_c)},
      {"Ctrl-\\", types(ctrl_backslash)},
      {"Ctrl-Z", types(ctrl_z), After::pauses},
      {"closed terminal", hang_up},
  });
}

TEST(Safety, BlockedAndClosedOutputHoldsUpNothing) {
  try_all({
      {"endless loop behind Ctrl-S", loop_behind_ctrl_s, After::hangs},
      {"full pipe", chatter_into_full_pipe, After::goes_on, Output::pipe},
      {"closed pipe", chatter_into_closed_pipe, After::goes_on, Output::pipe},
  });
}

/// The faults that the robot causes in itself, in a function of the controller and in one of the motor.
void add(std::vector<Case>& cases, const std::string& name, Harm harm, const std::string& says) {
  for (const Place place : {Place::control, Place::motor}) {
    const bool control = place == Place::control;
    Case one;
    one.name = name + (control ? " in control" : " in motor");
    one.strike = does(harm, place);
    one.says = (control ? "robot.control.follow: " : "robot.motor.drive: ") + says;
    one.arguments = {"--no-guardian"};  // the controller does it by itself
    cases.push_back(one);
  }
}

TEST(Safety, DeathsOfTheProcessGiveTheSafeCommandFirst) {
  std::vector<Case> cases;
  add(cases, "abort", Harm::abort, "killed by SIGABRT");
  add(cases, "exit", Harm::exit, "called exit(0)");
  add(cases, "quick_exit", Harm::quick_exit, "called quick_exit");
  add(cases, "SIGSEGV", Harm::segv, "killed by SIGSEGV at address 0x0");
  add(cases, "SIGBUS", Harm::bus, "killed by SIGBUS at address 0x");
  add(cases, "SIGFPE", Harm::fpe, "killed by SIGFPE");
  add(cases, "SIGILL", Harm::ill, "killed by SIGILL");
  add(cases, "SIGSYS", Harm::sys, "killed by SIGSYS");
  add(cases, "SIGTRAP", Harm::trap, "killed by SIGTRAP");
  add(cases, "std::terminate", Harm::terminate, "killed by SIGABRT (std::terminate)");
  add(cases, "stack overflow", Harm::stack_overflow, "killed by SIGSEGV at address 0x");
  for (std::size_t index = cases.size() - 2; index < cases.size(); ++index)
    cases[index].bar = milliseconds(500);  // filling the stack takes its time, too
  for (const auto& [name, harm, says] :
       {std::tuple{"pthread_exit", Harm::pthread_exit, "pthread_exit"},
        std::tuple{"throw of a number", Harm::throw_number, "an exception that is no std::exception"},
        std::tuple{"no memory", Harm::out_of_memory, "bad_alloc"}})
    for (const Place place : {Place::control, Place::motor})
      cases.push_back({.name = std::string(name) + (place == Place::control ? " in control" : " in motor"),
                       .strike = does(harm, place),
                       .says = says,
                       .arguments = {"--no-guardian"}});
  try_all(cases);
}

/// The driver that dies holds the lock of its device.
TEST(Safety, DeathsInsideADriverGiveTheSafeCommandFirst) {
  std::vector<Case> cases;
  for (const auto& [name, harm, says] :
       {std::tuple{"abort in a driver", Harm::abort, "robot.motor.drive: killed by SIGABRT"},
        std::tuple{"SIGSEGV in a driver", Harm::segv, "robot.motor.drive: killed by SIGSEGV at address 0x0"},
        std::tuple{"exit in a driver", Harm::exit, "robot.motor.drive: called exit(0)"}})
    cases.push_back(
        {.name = name, .strike = does(harm, Place::driver), .says = says, .arguments = {"--no-guardian"}});
  try_all(cases);
}

TEST(Safety, FunctionsThatHangLeaveTheDevicesSafe) {
  Case loops{.name = "endless loop in control",
             .strike = does(Harm::loop, Place::control),
             .after = After::hangs,
             .bar = milliseconds(150)};  // watchdog and stale
  try_all({loops});
  // Not beside others: each takes a processor from threads without priority.
  loops.name = "FIFO loop in control";
  loops.strike = does(Harm::fifo_loop, Place::control);
  try_all({loops});
}

/// No function hangs: control only sends no value any more.
TEST(Safety, ValuesThatStopComingLeaveTheDevicesSafe) {
  try_all({{.name = "values stop coming",
            .strike = does(Harm::mute, Place::control),
            .after = After::hangs,
            .bar = milliseconds(150),  // stale + 100 ms
            .says = "has had no valid value for 0.05 s"}});
}

/// On a pipe, since a terminal hangs up when the controller, which has it, dies.
TEST(Safety, TheGuardianActsWhereTheControllerCannot) {
  const milliseconds stands_still(2600);
  const std::string has_died =
      "the controller has died; not guarded, so its state is unknown: robot.arm.lamp; "
      "robot.arm.joint, robot.motor.left, robot.motor.right have got their safe commands, after ";
  std::vector<Case> cases{
      {.name = "SIGKILL", .strike = sends(SIGKILL), .says = has_died},
      {.name = "SIGKILL by itself", .strike = does(Harm::kill, Place::control), .says = has_died},
      {.name = "_exit in control", .strike = does(Harm::underscore_exit, Place::control), .says = has_died},
      {.name = "_exit in a driver", .strike = does(Harm::underscore_exit, Place::driver), .says = has_died},
      {.name = "SIGSEGV with a guardian", .strike = does(Harm::segv, Place::motor), .says = has_died},
      {.name = "SIGSTOP",
       .strike = stand_still,
       .after = After::halts,
       .bar = stands_still,
       .says = "the controller stands still, since it is stopped"},
      {.name = "exec in control",
       .strike = does(Harm::exec, Place::control),
       .bar = stands_still,
       .says = "the controller stands still, and is killed"},
      {.name = "SIGTERM with a guardian", .strike = sends(SIGTERM)},
      {.name = "SIGTERM while a driver hangs",
       .strike = stop_while_a_driver_hangs,
       .bar = milliseconds(4100),
       .says = "after the stop; robot.motor.left has not taken its safe command"},
  };
  const std::vector<std::string> in_the_loop{
      project().controller.string(), "simulate", "--hardware", "robot.motor", "--hardware", "robot.arm"};
  for (Case one :
       {Case{.name = "SIGKILL, hardware in the loop", .strike = sends(SIGKILL), .says = has_died},
        Case{.name = "SIGSEGV, hardware in the loop", .strike = does(Harm::segv, Place::control)}}) {
    one.command = in_the_loop;
    cases.push_back(one);
  }
  Case unguarded{.name = "SIGKILL of the guardian",
                 .strike = kill_guardian,
                 .bar = milliseconds(300),
                 .says = "the guardian of the devices has ended"};
  cases.push_back(unguarded);
  unguarded.name = "SIGKILL of the guardian, hardware in the loop";
  unguarded.command = in_the_loop;
  cases.push_back(unguarded);
  for (Case& one : cases) one.output = Output::pipe;
  try_all(cases);
}

/// Whatever else ends the run, and whatever comes first when it goes on.
TEST(Safety, ARunInWhichTheGuardianActedHasFailed) {
  std::vector<Case> cases{
      {.name = "SIGSTOP, and the time of --for passes",
       .strike = sends(SIGSTOP),
       .says = "the controller stands still, since it is stopped",
       .arguments = {"--for", "2s"}},
      {.name = "SIGSTOP and SIGINT", .strike = stands_still_and_gets(SIGINT)},
      {.name = "SIGSTOP and SIGTERM", .strike = stands_still_and_gets(SIGTERM)},
      {.name = "SIGSTOP and SIGTSTP", .strike = stands_still_and_gets(SIGTSTP)},
  };
  for (Case& one : cases) {
    one.after = After::halts;
    one.output = Output::pipe;
    one.bar = milliseconds(2600);
    if (one.says.empty()) one.says = "the controller stands still, since it is stopped";
    one.code = 1;
  }
  try_all(cases);
}

TEST(Safety, TheRecordingAndTheSummarySayThatTheGuardianActed) {
  const ScratchFolder folder;
  RobotProcess robot({project().controller.string(), "run", "--also", "--record", folder / "run.tsr",
                      "--summary", folder / "summary.json"},
                     Output::pipe);
  ASSERT_TRUE(robot.await_driving()) << robot.text();
  robot.send(SIGSTOP);
  ASSERT_TRUE(robot.await_text("since it is stopped", std::chrono::seconds(30))) << robot.text();
  robot.send(SIGINT);
  robot.send(SIGCONT);
  ASSERT_TRUE(robot.await_end(std::chrono::seconds(30))) << robot.text();
  const std::string what = "the guardian has given the devices the safe command";
  const auto summary = nlohmann::json::parse(std::ifstream(folder / "summary.json"));
  EXPECT_TRUE(summary.at("failed"));
  EXPECT_NE(summary.at("ended").get<std::string>().find(what), std::string::npos) << summary;
  std::string error;
  const std::optional<Recording> recording = read_recording(folder / "run.tsr", error);
  ASSERT_TRUE(recording) << error;
  const auto& [event, text] = recording->entries.back();
  EXPECT_EQ(event.kind(), Event::Kind::stop);
  EXPECT_EQ(event.version, 1U) << "it has failed";
  EXPECT_NE(text.find(what), std::string::npos) << text;
}

TEST(Safety, AGuardianThatStandsStillStopsTheRun) {
  Case stopped{.name = "SIGSTOP of the guardian",
               .strike = stop_guardian,
               .output = Output::pipe,
               .bar = milliseconds(2600),
               .says = "the guardian of the devices stands still",
               .code = 1};
  Case in_the_loop = stopped;
  in_the_loop.name += ", hardware in the loop";
  in_the_loop.command = {
      project().controller.string(), "simulate", "--hardware", "robot.motor", "--hardware", "robot.arm"};
  try_all({stopped, in_the_loop});
}

/// Nobody knows what the device does whose driver hangs. The supervisor knows it from the watchdog of its subsystem.
TEST(Safety, ADriverThatHangsLeavesTheDevicesOfOtherSubsystemsSafe) {
  try_all(
      {{.name = "endless loop in a driver",
        .strike = does(Harm::loop, Place::driver),
        .after = After::hangs,
        .output = Output::pipe,
        .bar = milliseconds(150),  // watchdog + 100 ms
        .says = "robot.motor.left has not taken its safe command; until then the other devices have theirs",
        .hangs = 0}});
}

/// Whatever the safe commands are for: the driver of the first device of the motor does not return from its own.
TEST(Safety, ADriverThatHangsInItsSafeCommandLeavesTheOtherDevicesSafe) {
  const auto hanging = [](std::function<std::int64_t(RobotProcess&)> strike) {
    return [strike](RobotProcess& robot) {
      robot.hang_in_safe_commands();
      return strike(robot);
    };
  };
  std::vector<Case> cases{
      {.name = "SIGTERM, and a safe command hangs", .strike = hanging(sends(SIGTERM))},
      {.name = "stale, and a safe command hangs",
       .strike = hanging(does(Harm::mute, Place::control)),
       .bar = milliseconds(150)},
      {.name = "loop in motor, and a safe command hangs",
       .strike = hanging(does(Harm::loop, Place::motor)),
       .bar = milliseconds(150)},
      {.name = "SIGSEGV, and a safe command hangs", .strike = hanging(does(Harm::segv, Place::control))},
  };
  for (Case& one : cases) {
    one.after = After::hangs;
    one.output = Output::pipe;
    one.hangs = 0;
    one.arguments = {"--no-guardian"};  // the controller does it by itself
  }
  try_all(cases);
}

/// One line at the start, and again by `tessera run` when the controller was killed.
TEST(Safety, DevicesThatNothingProtectsAreNamed) {
  const std::string start = "if the controller is killed, nothing gives the safe command to ";
  try_all({
      {.name = "start",
       .strike = sends(SIGTERM),
       .output = Output::pipe,
       .says = start + "robot.arm.lamp (docs/reference/safety.md)"},
      {.name = "start without a guardian",
       .strike = sends(SIGTERM),
       .output = Output::pipe,
       .says =
           start +
           "robot.arm.joint, robot.arm.lamp, robot.motor.left, robot.motor.right (docs/reference/safety.md)",
       .arguments = {"--no-guardian"}},
      {.name = "SIGKILL of the controller below tessera run",
       .strike = kill_controller,
       .output = Output::pipe,
       .says = "tessera: error: the controller was killed by SIGKILL; NOT SAFE, because nothing has given "
               "the safe "
               "command to robot.arm.lamp",
       .command = {std::string(TESSERA_BINARY_DIR) + "/tessera", "run", project().folder.string()}},
  });
}

/// The other one goes on undisturbed.
TEST(Safety, RealDevicesHaveOneRunAtATime) {
  const std::string controller = project().controller.string(), tessera = TESSERA_BINARY_DIR "/tessera";
  RobotProcess first({controller, "run"}, Output::pipe);
  ASSERT_TRUE(first.await_driving()) << first.text();
  const std::string refusal = fmt::format(
      "process {0} uses the real devices of safety already: stop it first (`kill {0}`", first.child());
  const ScratchFolder folder;
  fs::create_directory_symlink(project().folder, folder / "other_name");
  const std::vector<std::vector<std::string>> commands{
      {controller, "run", "--for", "10s"},
      {folder / "other_name/.tessera/build/release/controller", "run", "--for", "10s"},
      {controller, "simulate", "--hardware", "robot.motor", "--for", "10s"},
      {tessera, "run", project().folder.string(), "--for", "10s"},
      {tessera, "run", folder / "other_name", "--for", "10s"}};
  for (const std::vector<std::string>& command : commands) {
    const tessera::project::Exit other = tessera::project::capture(command);
    EXPECT_EQ(other.code, 1) << command.back() << other.text;
    EXPECT_NE(other.text.find(refusal), std::string::npos) << other.text;
  }
  RobotProcess also({controller, "run", "--also"}, Output::pipe);
  EXPECT_TRUE(also.await_driving()) << also.text();
  EXPECT_TRUE(first.await_driving()) << first.text();
  first.send(SIGKILL);
  ASSERT_TRUE(first.await_end(std::chrono::seconds(30)));
  RobotProcess next({controller, "run"}, Output::pipe);
  EXPECT_TRUE(next.await_driving()) << next.text();
}

/// Another user has made the folder of the control sockets first.
TEST(Safety, ARunThatCannotBeStoppedFromOutsideDoesNotStart) {
  const ScratchFolder folder;
  fs::create_directory(folder / "tessera");
  fs::permissions(folder / "tessera", fs::perms::all);
  const std::vector<std::string> environment{"XDG_RUNTIME_DIR=" + folder.path().string()};
  const std::string controller = project().controller.string();
  const std::string wrong =
      folder / "tessera' may be entered by other users: remove it, or set XDG_RUNTIME_DIR";
  RobotProcess refused({controller, "run", "--also"}, Output::pipe, environment);
  const std::optional<int> end = refused.await_end(std::chrono::seconds(30));
  ASSERT_TRUE(end) << refused.text();
  ASSERT_TRUE(refused.await_nobody_left(std::chrono::seconds(30)));
  EXPECT_EQ(WEXITSTATUS(*end), 1);
  EXPECT_NE(refused.text().find(
                "the run could not be stopped from outside, since it has no control socket: '" + wrong),
            std::string::npos)
      << refused.text();
  EXPECT_TRUE(refused.commanders().empty()) << "no device was touched";
  const auto stop = [&] {
    return tessera::project::capture(
        {"env", environment.front(), TESSERA_BINARY_DIR "/tessera", "emergency-stop"});
  };
  const tessera::project::Exit unknown = stop();
  EXPECT_EQ(unknown.code, 1);
  EXPECT_NE(unknown.text.find("it is unknown whether other controllers run: '" + wrong), std::string::npos)
      << unknown.text;
  EXPECT_EQ(unknown.text.find("no controller is running"), std::string::npos) << unknown.text;
  RobotProcess runs({controller, "run", "--also", "--no-monitor"}, Output::pipe, environment);
  ASSERT_TRUE(runs.await_driving()) << runs.text();
  const tessera::project::Exit named = stop();
  EXPECT_EQ(named.code, 1);
  EXPECT_NE(
      named.text.find(fmt::format(
          "NOT STOPPED, because it runs without a control socket (--no-monitor): process {} ", runs.child())),
      std::string::npos)
      << named.text;
}

/// Runs without a terminal, so that no SIGHUP is sent.
TEST(Safety, ControllersDoNotOutliveTheirParent) {
  const std::vector<std::string> run{std::string(TESSERA_BINARY_DIR) + "/tessera", "run",
                                     project().folder.string()};
  try_all({
      {.name = "SIGKILL of tessera run",
       .strike = sends(SIGKILL),
       .output = Output::pipe,
       .says = "the process that started the controller has ended",
       .command = run},
      {.name = "SIGSEGV below tessera run",
       .strike = does(Harm::segv, Place::control),
       .says = "tessera: error: the controller was killed by SIGSEGV at address 0x0 in robot.control.follow",
       .command = run},
      {.name = "_exit below tessera run",
       .strike = does(Harm::underscore_exit, Place::control),
       .says = "tessera: error: the controller has ended without a message",
       .command = run},
  });
}

}  // namespace
}  // namespace tessera::safety_test
