// The same seed gives the same bytes, whoever watches, judges, steps or traces the run.
//
// TESSERA_SEEDS=100: the long form, with all examples that have a world, and so many seeds of each.

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "../environment.hpp"
#include "../schema/judge.hpp"
#include "command.hpp"
#include "project/build/controller.hpp"
#include "project/files/file_names.hpp"
#include "project/launch.hpp"
#include "project/process/control_connection.hpp"
#include "project/process/control_reader.hpp"
#include "project/process/listener.hpp"
#include "tessera/control_messages.hpp"
#include "tessera/monitor.hpp"
#include "tessera/recording.hpp"

using namespace std::chrono_literals;

namespace tessera::cli_test {
namespace {

[[nodiscard]] std::uint64_t seeds() { return from_environment("TESSERA_SEEDS", 2); }

/// Two robots, a camera, and an arm without wheels; the long form has the others, too.
[[nodiscard]] std::vector<std::string> examples() {
  std::vector<std::string> names{"05_depot", "06_sorting_cell", "09_arm"};
  if (std::getenv("TESSERA_SEEDS") != nullptr)
    names.insert(names.end(), {"01_line_follower", "07_fleet", "08_rover"});
  return names;
}

/// Pauses, steps, resumes and reads the recording of a controlled run, as its seed draws, until it has ended.
void disturb(const std::string& socket, std::uint64_t seed, std::size_t& answers) {
  using Received = project::ControlConnection::Received;
  std::optional<project::ControlConnection> connection;
  for (int tries = 0; tries < 2000 && !connection; ++tries) {
    connection = project::ControlConnection::to(socket);
    if (!connection) std::this_thread::sleep_for(5ms);
  }
  if (!connection) return;
  std::mt19937_64 draws(seed);
  std::int64_t id = 0;
  project::ControlReader heard;
  const auto say = [&](const ControlCommand& what) { return connection->send(line_of(what, ++id)); };
  const std::array<ControlCommand, 6> all{command::Pause{},  command::StepFiring{}, command::StepIteration{},
                                          command::Resume{}, command::Recording{},  command::Speed{0}};
  bool goes_on = true;
  for (int turn = 0; goes_on && turn < 60; ++turn) {
    goes_on = say(all[draws() % all.size()]) && connection->receive_at_once(heard) != Received::over;
    connection->wait(std::chrono::milliseconds(draws() % 4));
  }
  goes_on = goes_on && say(command::Speed{0}) && say(command::Resume{});
  while (connection->receive(heard) == Received::bytes) {
  }
  while (const std::optional<project::ControlMessage> message = heard.next())
    if (message->content && std::holds_alternative<CommandAnswer>(*message->content)) ++answers;
}

class SameBytes : public Command {
 protected:
  /// The results of one run.
  struct Left {
    std::string recording;
    nlohmann::json summary;
  };

  void make(const std::string& name) {
    struct : project::Listener {
      void say(std::string_view) override {}
      void progress(std::string_view) override {}
    } listener;
    controller_ = project::make_controller(example(name), {}, listener);
    ASSERT_TRUE(controller_) << name;
  }

  [[nodiscard]] project::Command command(std::uint64_t seed, const std::string& values) {
    project::LaunchOptions options;
    options.folder = folder_.string();
    options.duration = "3s";
    options.seed = seed;
    options.record_values = values;
    return project::controller_command(*controller_, options, "simulate", /*simulated=*/true);
  }

  [[nodiscard]] Left take(const project::Exit& exit) {
    const fs::path summary = folder_ / project::file_names::summary;
    EXPECT_TRUE(fs::exists(summary)) << exit.text;
    Left left{content_of(folder_ / recording_file_name), nlohmann::json::parse(content_of(summary))};
    schema_test::judge_summary(left.summary);
    fs::remove(summary);
    fs::remove(folder_ / recording_file_name);
    return left;
  }

  /// Nobody looks, nothing is judged.
  [[nodiscard]] Left alone(std::uint64_t seed, const std::string& values = "small") {
    const project::Command run = command(seed, values);
    const fs::path file = folder_ / project::file_names::simulation;
    nlohmann::json simulation = nlohmann::json::parse(content_of(file));
    simulation["checks"] = nlohmann::json::array();
    simulation["measures"] = nlohmann::json::object();
    write(file, simulation.dump());
    return take(project::capture(run));
  }

  /// With checks, measures, a trace, and somebody who reads the recording, pauses and steps.
  [[nodiscard]] Left watched(std::uint64_t seed) {
    project::Command run = command(seed, "small");
    run.insert(run.end(),
               {"--controlled", "--speed=0", "--paused", "--trace", (folder_ / "trace.csv").string()});
    const std::atomic<bool> never = false;
    std::jthread watcher;
    const project::Exit exit = project::capture_apart(run, never, {}, [&](pid_t process) {
      const std::string socket = monitor_file(controller_->specification.model.system, process);
      watcher = std::jthread([this, socket, seed] { disturb(socket, seed, answers_); });
    });
    watcher.join();
    EXPECT_GT(fs::file_size(folder_ / "trace.csv"), 0U);
    fs::remove(folder_ / "trace.csv");
    return take(exit);
  }

  std::optional<project::Controller> controller_;
  std::size_t answers_ = 0;  ///< to those who disturbed
};

/// Time and transition of each firing.
[[nodiscard]] std::vector<std::pair<std::int64_t, std::uint32_t>> firings_in(const std::string& bytes) {
  RecordingReader reader;
  reader.feed(bytes);
  EXPECT_TRUE(reader.has_ended()) << reader.problem().value_or(Problem{}).text;
  std::vector<std::pair<std::int64_t, std::uint32_t>> firings;
  for (const Recording::Entry& entry : reader.recording().entries)
    if (entry.event.kind() == Event::Kind::firing)
      firings.emplace_back(entry.event.time_ns, entry.event.subject);
  return firings;
}

/// The recording without what the checks have found.
[[nodiscard]] std::string without_failed_checks(const std::string& bytes) {
  RecordingReader reader;
  reader.feed(bytes);
  std::string rest;
  for (const Recording::Entry& entry : reader.recording().entries) {
    const Event& event = entry.event;
    if (event.kind() == Event::Kind::fault && event.instance() == system_instance) continue;
    Event unnumbered = event;
    if (event.instance() == system_instance) unnumbered.sequence = 0;
    // The end of a run with a failed check says so.
    if (event.kind() == Event::Kind::stop) continue;
    rest.append(reinterpret_cast<const char*>(&unnumbered), sizeof unnumbered).append(entry.text);
  }
  return rest;
}

TEST_F(SameBytes, OfTheSameSeedWithAndWithoutChecksTraceAndPauses) {
  for (const std::string& name : examples()) {
    make(name);
    if (HasFatalFailure()) return;
    std::set<std::string> different;
    for (std::uint64_t seed = 1; seed <= seeds(); ++seed) {
      const Left plain = alone(seed), full = watched(seed);
      const std::string where = fmt::format("{}, seed {}", name, seed);
      ASSERT_GT(plain.recording.size(), 10'000U) << where;
      EXPECT_GT(plain.summary.at("firings").get<std::uint64_t>(), 100U) << where;
      const bool has_failed_check =
          full.recording != plain.recording && full.summary.at("failed").get<bool>();
      if (has_failed_check)
        EXPECT_TRUE(without_failed_checks(full.recording) == without_failed_checks(plain.recording)) << where;
      else
        EXPECT_TRUE(full.recording == plain.recording) << where;
      EXPECT_TRUE(firings_in(alone(seed, "none").recording) == firings_in(plain.recording)) << where;
      EXPECT_TRUE(firings_in(alone(seed, "all").recording) == firings_in(plain.recording)) << where;
      different.insert(plain.recording);
    }
    EXPECT_GT(different.size(), 1U) << name << ": the seed changes nothing, so nothing was compared";
    EXPECT_GT(answers_, 10 * seeds()) << name << ": nobody has disturbed these runs";
    answers_ = 0;
    fmt::print("{}: {} seeds, {} different runs\n", name, seeds(), different.size());
  }
}

}  // namespace
}  // namespace tessera::cli_test
