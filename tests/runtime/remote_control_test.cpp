#include "watch/remote_control.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>
#include <vector>

#include "../eventually.hpp"
#include "../schema/judge.hpp"
#include "nets.hpp"
#include "rerun/rerun.hpp"
#include "tessera/monitor.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

using nlohmann::json;

/// Firings that a recording holds by now.
std::size_t firings_in(const std::string& file) {
  std::string error;
  const std::optional<Recording> recording = read_recording(file, error);
  std::size_t count = 0;
  if (recording)
    for (const Recording::Entry& entry : recording->entries)
      count += entry.event.kind() == Event::Kind::firing ? 1U : 0U;
  return count;
}

/// A run that is controlled: in a thread, with a socket in a folder of its own.
class Controlled : public ::testing::Test {
 protected:
  Controlled() {
    // Not scratch_file: its names are too long for a socket.
    folder_ = std::filesystem::temp_directory_path() / ("tessera." + std::to_string(getpid()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    setenv("XDG_RUNTIME_DIR", folder_.c_str(), 1);
    options_.duration = 1s;
    options_.monitor = true;
    options_.paused = true;
    options_.speed = 0;
    options_.recording = scratch_file("controlled");
  }
  ~Controlled() override {
    if (socket_ >= 0) close(socket_);
    if (running_.joinable()) running_.join();
    std::filesystem::remove_all(folder_);
  }

  static void build(TestSystem& system) {
    const std::uint32_t a = system.add("robot.a", nets::async_sender, {}, 10ms);
    const std::uint32_t b = system.add("robot.b", nets::async_receiver, {}, 20ms);
    system.connect(a, "x", b, "x", asynchronous);
  }

  void start() {
    build_(system_);
    made_ = &system_.system();
    running_ = std::thread([this] {
      std::string error;
      summary_ = execute(*made_, options_, error).value_or(RunSummary{});
      over_ = true;
    });
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string file =
        monitor_folder() + "/" + std::string(made_->name) + "." + std::to_string(getpid()) + ".sock";
    std::memcpy(address.sun_path, file.c_str(), file.size() + 1);
    socket_ = socket(AF_UNIX, SOCK_STREAM, 0);
    const auto connected = [&] {
      return connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    };
    ASSERT_TRUE(eventually(connected, [&] { return over_.load(); })) << summary_.ended;
  }
  bool hear() {
    char bytes[65536];
    const ssize_t count = recv(socket_, bytes, sizeof bytes, 0);
    if (count > 0) said_.append(bytes, static_cast<std::size_t>(count));
    return count > 0;
  }
  /// The next line that it accepts; null: the run is over.
  template <class Wanted>
  json await(Wanted wanted) {
    for (;;) {
      const std::size_t end = said_.find('\n');
      if (end == std::string::npos) {
        if (!hear()) return nullptr;
        continue;
      }
      const json line = json::parse(said_.substr(0, end), nullptr, false);
      said_.erase(0, end + 1);
      schema_test::judge_line(line);
      if (wanted(line)) return line;
    }
  }
  /// The bytes of the recording that come next.
  std::string next_piece() {
    const json head = await([](const json& line) { return line.contains("recording_bytes"); });
    if (head.is_null()) return "";
    more_ = head.at("more");
    const std::size_t size = head.at("recording_bytes");
    EXPECT_LE(size, longest_piece);
    while (said_.size() < size && hear()) continue;
    std::string bytes = said_.substr(0, size);
    said_.erase(0, size);
    return bytes;
  }
  std::string piece() {
    const std::string line = "{\"command\":\"recording\"}\n";
    send(socket_, line.data(), line.size(), MSG_NOSIGNAL);
    return next_piece();
  }
  std::string what_comes_at_the_end() {
    EXPECT_FALSE(await([](const json& line) { return line.contains("ended"); }).is_null());
    std::string bytes;
    for (std::string some = next_piece(); !some.empty(); some = next_piece()) bytes += some;
    return bytes;
  }
  /// What was wrong with it.
  std::string command(json what) {
    what["id"] = ++last_;
    const std::string line = what.dump() + "\n";
    send(socket_, line.data(), line.size(), MSG_NOSIGNAL);
    std::string wrong =
        await([&](const json& answer) { return answer.value("answer", 0) == last_; }).value("error", "none");
    if (wrong.empty()) schema_test::judge_command(what);
    return wrong;
  }
  json rest(std::uint64_t pauses) {
    return await(
        [&](const json& line) { return line.value("paused", false) && line.value("pauses", 0U) >= pauses; });
  }
  void finish() {
    EXPECT_EQ(command({{"command", "resume"}}), "");
    running_.join();
  }

  std::string folder_;
  std::function<void(TestSystem&)> build_ = build;
  TestSystem system_;
  const System* made_ = nullptr;  // of system_, while it runs
  RunOptions options_;
  RunSummary summary_;
  std::thread running_;
  std::atomic<bool> over_{false};
  int socket_ = -1, last_ = 0;
  bool more_ = false;  // of the recording
  std::string said_;
};

TEST_F(Controlled, PausesStepsAndSpeedChangeNothingInTheRecording) {
  {
    TestSystem plain;
    build(plain);
    RunOptions options;
    options.duration = 1s;
    options.recording = scratch_file("plain");
    static_cast<void>(run(plain, options));
  }
  start();
  json now = rest(1);
  for (std::uint64_t step = 2; step < 12; ++step) {
    EXPECT_EQ(command({{"command", "step_firing"}}), "");
    now = rest(step);
  }
  EXPECT_EQ(command({{"command", "step_iteration"}, {"subsystem", "robot.b"}}), "");
  rest(12);
  EXPECT_EQ(command({{"command", "speed"}, {"value", 1000}}), "");
  finish();
  EXPECT_EQ(summary_.ended, "duration");
  EXPECT_EQ(bytes_of(options_.recording), bytes_of(scratch_file("plain")));
}

TEST_F(Controlled, AStepIsOneFiringAndTheRecordingShowsItAtOnce) {
  start();
  rest(1);
  const std::size_t before = firings_in(options_.recording);
  EXPECT_EQ(before, 2U);  // t_in of system and agent
  for (std::uint64_t step = 1; step <= 5; ++step) {
    EXPECT_EQ(command({{"command", "step_firing"}}), "");
    rest(1 + step);
    EXPECT_EQ(firings_in(options_.recording), before + step);
  }
  finish();
}

TEST_F(Controlled, AnIterationEndsWhenTheTransitionFunctionIsCalledAgain) {
  start();
  rest(1);
  const auto iterations_of_b = [](const json& line) {
    return line.at("subsystems").at(1).at("iterations").get<std::uint64_t>();
  };
  std::uint64_t before = 0;
  for (std::uint64_t step = 2; step < 6; ++step) {
    EXPECT_EQ(command({{"command", "step_iteration"}, {"subsystem", "robot.b"}}), "");
    const std::uint64_t after = iterations_of_b(rest(step));
    EXPECT_EQ(after, before + 1);
    before = after;
  }
  finish();
}

TEST_F(Controlled, ABreakpointPausesWhenItsPlaceGetsAToken) {
  options_.paused = false;
  options_.speed = 0.001;  // hardly begins
  start();
  const std::string place = "robot.b.run.in";
  EXPECT_EQ(command({{"command", "breakpoints"}, {"places", {place}}}), "");
  EXPECT_EQ(command({{"command", "speed"}, {"value", 0}}), "");
  EXPECT_EQ(rest(1).at("broke_at"), place);
  EXPECT_EQ(command({{"command", "resume"}}), "");
  EXPECT_EQ(rest(2).at("broke_at"), place);
  EXPECT_EQ(command({{"command", "breakpoints"}, {"places", json::array()}}), "");
  finish();
  EXPECT_EQ(summary_.ended, "duration");
}

TEST_F(Controlled, ABreakpointPausesWhenItsTransitionHasFired) {
  start();
  rest(1);
  const Instance& a = made_->instances[0];
  const std::string transition = "robot.a." + std::string(a.net->transitions[0].name);
  EXPECT_EQ(command({{"command", "breakpoints"}, {"transitions", {transition}}}), "");
  EXPECT_EQ(command({{"command", "resume"}}), "");
  EXPECT_EQ(rest(2).at("broke_at"), transition);
  std::string error;
  const std::optional<Recording> recording = read_recording(options_.recording, error);
  ASSERT_TRUE(recording) << error;
  EXPECT_EQ(recording->transitions[recording->entries.back().event.subject].name, transition);
  EXPECT_EQ(command({{"command", "breakpoints"}}), "");
  finish();
}

TEST_F(Controlled, ABreakpointPausesWhenItsConditionComesToHoldBeforeItFires) {
  start();
  rest(1);
  const auto& transitions = made_->instances[0].net->transitions;
  const auto decided = std::find_if(transitions.begin(), transitions.end(), [](const Transition& one) {
    return one.guard.kind == Guard::Kind::go_on || one.guard.kind == Guard::Kind::terminal;
  });
  ASSERT_NE(decided, transitions.end());
  const std::string transition = "robot.a." + std::string(decided->name);
  EXPECT_EQ(command({{"command", "breakpoints"}, {"conditions", {transition}}}), "");
  EXPECT_EQ(command({{"command", "resume"}}), "");
  EXPECT_EQ(rest(2).at("broke_at"), transition);
  const std::size_t before = firings_in(options_.recording);
  EXPECT_EQ(command({{"command", "breakpoints"}}), "");
  EXPECT_EQ(command({{"command", "step_firing"}}), "");
  rest(3);
  EXPECT_EQ(firings_in(options_.recording), before + 1);
  finish();
}

TEST_F(Controlled, TheRecordingComesThroughTheSocketAsFarAsTheRunHasCome) {
  start();
  rest(1);
  std::string recorded;
  for (std::uint64_t step = 2; step < 10; ++step) {
    do recorded += piece();
    while (more_);
    EXPECT_EQ(recorded, bytes_of(options_.recording));
    EXPECT_EQ(command({{"command", "step_firing"}}), "");
    rest(step);
  }
  finish();
  recorded += what_comes_at_the_end();
  EXPECT_EQ(recorded, bytes_of(options_.recording));
}

TEST_F(Controlled, InRealTimeTheRecordingCanBeHadAndNothingElse) {
  options_.clock = RunOptions::Clock::steady;
  options_.duration = 600s;
  start();
  std::string recorded;
  while (recorded.size() < 10'000 || more_) recorded += piece();
  EXPECT_EQ(bytes_of(options_.recording).substr(0, recorded.size()), recorded);
  EXPECT_NE(command({{"command", "pause"}}), "");
  kill(getpid(), SIGTERM);
  running_.join();
  EXPECT_EQ(summary_.ended, "SIGTERM");
  recorded += what_comes_at_the_end();
  EXPECT_EQ(recorded, bytes_of(options_.recording));
}

TEST_F(Controlled, AParameterIsSetWhileItRunsAndRunsAgainFromTheRecording) {
  std::atomic<double> seen{0};
  build_ = [&](TestSystem& system) {
    Script script;
    script.call = [&](ScriptState& state) {
      state.out_x = state.gain;
      seen = state.gain;
    };
    const std::uint32_t a = system.add("robot.a", nets::async_sender, script, 2ms);
    const std::uint32_t b = system.add("robot.b", nets::async_receiver, {}, 2ms);
    system.connect(a, "x", b, "x", asynchronous);
  };
  options_.clock = RunOptions::Clock::steady;
  options_.duration = 600s;
  options_.values = RunOptions::Values::all;
  start();
  const auto set = [&](const char* path, const char* value) {
    return command({{"command", "set"}, {"path", path}, {"value", value}});
  };
  EXPECT_EQ(set("robot.a.gain", "11"), "parameter robot.a.gain = 11: 11 is out of range 0 to 10");
  EXPECT_EQ(set("gian", "2"), "unknown parameter 'gian'; did you mean 'gain'?");
  EXPECT_NE(command({{"command", "set"}, {"path", "gain"}, {"value", 2}}), "") << "a value is text";
  EXPECT_EQ(set("gain", "2.5"), "");
  EXPECT_TRUE(eventually([&] { return seen == 2.5; }));
  kill(getpid(), SIGTERM);
  running_.join();

  std::string error;
  const auto recording = read_recording(options_.recording, error);
  ASSERT_TRUE(recording) << error;
  std::vector<std::string> changes;
  for (const auto& [event, text] : recording->entries)
    if (event.kind() == Event::Kind::parameter) changes.push_back(text);
  EXPECT_THAT(changes, ::testing::UnorderedElementsAre("robot.a.gain=2.5", "robot.b.gain=2.5"));
  const auto again = rerun(system_.system(), RunOptions{}, options_.recording, error);
  ASSERT_TRUE(again) << error;
  EXPECT_FALSE(again->first) << again->first->what << ": " << again->first->recorded << ", "
                             << again->first->computed;
}

/// An effector that commands 5, and -1 as its safe command.
class EmergencyStop : public Controlled {
 protected:
  EmergencyStop() {
    options_.clock = RunOptions::Clock::steady;
    options_.duration = 600s;
    build_ = [this](TestSystem& system) {
      Script motor;
      motor.acts = true;
      motor.call = [](ScriptState& state) { state.command = 5; };
      system.devices.accept = [this](double value) {
        (value == 7 || value == -2 ? last_of_arm_ : last_) = value;
        return true;
      };
      system.add("robot.motor", nets::alone, motor, 2ms, 0ms, Kind::effector);
    };
  }
  std::uint64_t iterations() {
    return await([](const json& line) { return line.contains("subsystems"); })
        .at("subsystems")
        .at(0)
        .at("iterations");
  }
  std::atomic<double> last_{0}, last_of_arm_{0};
};

TEST_F(EmergencyStop, StandsUntilTheOperatorResetsIt) {
  start();
  EXPECT_TRUE(eventually([&] { return last_ == 5; }));
  EXPECT_EQ(command({{"command", "reset"}}), "there is no emergency stop");
  EXPECT_EQ(command({{"command", "emergency_stop"}, {"why", "smoke"}}), "");
  EXPECT_TRUE(eventually([&] { return last_ == -1; }));
  const json shown = await([](const json& line) { return line.contains("emergency"); });
  EXPECT_EQ(shown.at("emergency"), "smoke");
  const std::uint64_t before = iterations();
  EXPECT_TRUE(eventually([&] { return iterations() > before + 10; })) << "it goes on otherwise";
  EXPECT_EQ(last_, -1);
  EXPECT_EQ(command({{"command", "reset"}}), "");
  EXPECT_TRUE(eventually([&] { return last_ == 5; }));
  kill(getpid(), SIGTERM);
  running_.join();
  EXPECT_EQ(last_, -1);
  std::string error;
  const auto recording = read_recording(options_.recording, error);
  ASSERT_TRUE(recording) << error;
  std::string texts;
  for (const auto& [event, text] : recording->entries)
    if (event.kind() == Event::Kind::log || event.kind() == Event::Kind::safe) texts += text + "\n";
  EXPECT_THAT(texts, ::testing::HasSubstr("EMERGENCY STOP: smoke"));
  EXPECT_THAT(texts, ::testing::HasSubstr("robot.motor.command: safe command: emergency stop"));
  EXPECT_THAT(texts, ::testing::HasSubstr("the emergency stop is over"));
}

TEST_F(EmergencyStop, ComesThoughTheTransitionFunctionDoesNotReturn) {
  std::atomic<bool> release{false}, hanging{false};
  build_ = [&, usual = build_](TestSystem& system) {
    usual(system);
    Script hangs;
    hangs.acts = true;
    hangs.safe = -2;
    hangs.call = [&](ScriptState& state) {
      state.command = 7;
      hanging = state.context.iteration == 3;
      if (hanging) static_cast<void>(eventually([&] { return release.load(); }));
    };
    system.add("robot.arm", nets::alone, hangs, 2ms, 0ms, Kind::effector);
  };
  start();
  EXPECT_TRUE(eventually([&] { return last_ == 5 && last_of_arm_ == 7 && hanging; }));
  EXPECT_EQ(command({{"command", "emergency_stop"}}), "");
  EXPECT_TRUE(eventually([&] { return last_ == -1 && last_of_arm_ == -2; }));
  release = true;
  kill(getpid(), SIGTERM);
  running_.join();
  EXPECT_EQ(summary_.ended, "SIGTERM");
}

/// Commands of a motor whose transition function throws once.
std::vector<double> commands_around_a_fault(bool operator_resets) {
  TestSystem system;
  Script motor;
  motor.acts = true;
  motor.call = [](ScriptState& state) {
    state.command = 5;
    if (state.context.iteration == 3) throw std::runtime_error("lost");
  };
  motor.route = [](const ScriptState&, bool) { return 0; };
  Policies policies;
  policies.operator_resets = operator_resets;
  system.add("robot.motor", nets::two_behaviours, motor, 10ms, 0ms, Kind::effector, policies);
  static_cast<void>(run(system, simulated(200ms)));
  return system.devices.commands;
}

TEST(Recovery, IsByItselfOrByAnOperator) {
  const std::vector<double> automatic = commands_around_a_fault(false), held = commands_around_a_fault(true);
  EXPECT_GT(std::ranges::count(automatic, 5), 10);
  EXPECT_EQ(std::ranges::count(held, 5), 3) << "those before the fault";
  EXPECT_EQ(held.back(), -1);
}

TEST(EmergencyStopOfABehaviour, ReachesEveryDeviceAtOnce) {
  TestSystem system;
  Script watches, motor;
  watches.call = [](ScriptState& state) {
    if (state.context.iteration == 5) state.context.emergency_stop("too close");
  };
  motor.acts = true;
  motor.call = [](ScriptState& state) { state.command = 5; };
  system.add("robot.watch", nets::alone, watches, 10ms);
  system.add("robot.motor", nets::alone, motor, 1s, 0ms, Kind::effector);
  RunOptions options = simulated(3s);
  options.recording = scratch_file("run");
  static_cast<void>(run(system, options));
  std::string error;
  const auto recording = read_recording(options.recording, error);
  ASSERT_TRUE(recording) << error;
  std::int64_t safe_ns = -1;
  for (const auto& [event, text] : recording->entries)
    if (event.kind() == Event::Kind::safe && text.ends_with("emergency stop")) safe_ns = event.time_ns;
  EXPECT_EQ(safe_ns, 50'000'000) << "the motor's own turns are a second apart";
  EXPECT_EQ(std::ranges::count(system.devices.commands, 5), 1);
}

TEST_F(Controlled, WithoutARecordingThereAreNoBytes) {
  options_.recording.clear();
  start();
  rest(1);
  EXPECT_EQ(piece(), "");
  EXPECT_FALSE(more_);
  finish();
}

TEST_F(Controlled, CommandsThatMakeNoSenseAreAnsweredAndChangeNothing) {
  start();
  rest(1);
  for (const char* text :
       {R"({"command":"fly"})", R"({"command":3})", R"({"command":"speed"})",
        R"({"command":"speed","value":-1})", R"({"command":"speed","value":"x"})",
        R"({"command":"breakpoints","places":["nowhere"]})", R"({"command":"breakpoints","places":[1]})",
        R"({"command":"breakpoints","places":3})", R"({"command":"breakpoints","transitions":["nowhere"]})",
        R"({"command":"breakpoints","conditions":["robot.a"]})",
        R"({"command":"step_iteration","subsystem":"robot.z"})",
        R"({"command":"step_iteration","subsystem":[]})"})
    EXPECT_NE(command(json::parse(text)), "") << text;
  const std::string noise = "{\n[]\nnull\n\"x\"\n\xff\n";
  send(socket_, noise.data(), noise.size(), MSG_NOSIGNAL);
  EXPECT_EQ(rest(1).at("pauses"), 1);
  finish();
}

TEST_F(Controlled, EndsWithItsOwner) {
  start();
  rest(1);
  const std::string line = "{\"command\":\"own\"}\n";
  send(socket_, line.data(), line.size(), MSG_NOSIGNAL);
  EXPECT_EQ(command({{"command", "pause"}}), "");
  close(socket_);
  socket_ = -1;
  running_.join();
  EXPECT_EQ(summary_.ended, "stopped: who started it has gone");
}

/// A socket connected to the run.
[[nodiscard]] int another_client(const std::string& file) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, file.c_str(), file.size() + 1);
  const int client = socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0);
  if (connect(client, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return client;
  close(client);
  return -1;
}

TEST_F(Controlled, ObeysWhoHasGoneBeforeItIsHeard) {
  start();
  rest(1);
  const std::size_t before = firings_in(options_.recording), asked = 50;
  const std::string file = monitor_folder() + "/" + std::string(made_->name) + "." +
                           std::to_string(getpid()) + ".sock",
                    line = "{\"command\":\"step_firing\"}\n";
  for (std::size_t sent = 0; sent < asked;) {
    const int client = another_client(file);
    if (client < 0) continue;  // it has not got round to the last ones
    EXPECT_EQ(send(client, line.data(), line.size(), MSG_NOSIGNAL), static_cast<ssize_t>(line.size()));
    close(client);
    ++sent;
  }
  EXPECT_TRUE(eventually([&] { return firings_in(options_.recording) == before + asked; }));
  finish();
}

TEST_F(Controlled, HostileClientsDoNoHarm) {
  start();
  rest(1);
  const std::string file =
      monitor_folder() + "/" + std::string(made_->name) + "." + std::to_string(getpid()) + ".sock";
  const std::vector<std::string> talks{
      std::string(3'000'000, 'x'),                                  // no end of line
      std::string(500'000, '[') + "\n",                             // nested
      "{\"command\":\"breakpoints\",\"places\":[\"\xff\xfe\"]}\n",  // no UTF-8, which is in the answer
      "{\"id\":1e400,\"command\":\"speed\",\"value\":1e400}\n",
      "{\"id\":\"\xc3\",\"command\":{}}\n" + std::string(100, '\n'),
      std::string(1000, '\0'),
      "{\"command\":\"recording\"}"};  // half a line
  for (int round = 0; round < 300; ++round) {
    const int client = another_client(file);
    if (client < 0) continue;
    const std::string& talk = talks[static_cast<std::size_t>(round) % talks.size()];
    send(client, talk.data(), talk.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    close(client);
  }
  std::vector<int> clients;
  for (int count = 0; count < 64; ++count) clients.push_back(another_client(file));
  EXPECT_EQ(command({{"command", "pause"}}), "") << "it is still served";
  for (const int client : clients)
    if (client >= 0) close(client);
  finish();
  EXPECT_EQ(summary_.ended, "duration");
}

TEST_F(Controlled, APathThatIsNoTextAndAFolderThatHasGoneEndNothing) {
  const std::filesystem::path before = std::filesystem::current_path(),
                              gone = std::filesystem::path(folder_) / "gone";
  std::filesystem::create_directories(gone);
  std::filesystem::current_path(gone);
  options_.recording = "r\xff\xfe.tsr";
  start();
  std::filesystem::remove_all(gone);
  EXPECT_TRUE(rest(1).contains("recording"));
  EXPECT_NE(command({{"command", "breakpoints"}, {"places", {"nowhere"}}}), "");
  finish();
  std::filesystem::current_path(before);
  EXPECT_EQ(summary_.ended, "duration");
}

}  // namespace
}  // namespace tessera::testing
