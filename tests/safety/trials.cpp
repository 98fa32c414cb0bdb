#include "trials.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <mutex>
#include <random>
#include <stdexcept>
#include <thread>

#include "../environment.hpp"

namespace tessera::safety_test {
namespace {

using std::chrono::seconds;

constexpr unsigned workers = 3;
constexpr milliseconds patience = seconds(30);  // for what must happen
constexpr milliseconds still{150};              // for so long must devices stay safe if the process lives on

[[nodiscard]] std::uint64_t runs() { return from_environment("TESSERA_SAFETY_RUNS", 2); }

/// The result of one trial.
struct Result {
  std::string failure;  // empty: none
  double latency_ms = 0;
  unsigned started_again = 0;
};

[[nodiscard]] std::string description(const RobotProcess& robot) {
  return fmt::format("\n--- the terminal ---\n{}\n---", robot.text());
}

void pass_random_time(RobotProcess& robot, std::mt19937& random) {
  const milliseconds time(std::uniform_int_distribution<int>(0, 40)(random));
  static_cast<void>(robot.await_end(time));
}

/// The measured values.
struct Times {
  std::int64_t event_ns = 0, safe_ns = 0;  // 0: not known yet
};

/// Empty, or the mistake in its further run.
[[nodiscard]] std::string see_it_through(const Case& one, RobotProcess& robot, Times& times) {
  using After = Case::After;
  if (one.after == After::goes_on) {
    if (!robot.await_driving(3)) return "it does not drive on";
    robot.read_again();
    times.event_ns = command_log::now_ns();
    robot.send(SIGTERM);
  }
  const bool stands = one.after == After::hangs || one.after == After::halts || one.after == After::pauses;
  // On a busy machine the devices may be safe already, since a value is late.
  if (one.after == After::halts && !robot.await_text(one.says, patience)) return "nobody says that it stands";
  if (stands && !robot.await_safe(still, patience)) return "the devices did not become safe";
  if (stands) times.safe_ns = robot.safe_since_ns();
  if (one.after == After::hangs) return "";
  if (one.after == After::halts) {
    robot.send(SIGCONT);
    if (!robot.await_end(still)) robot.delay_supervisor(false);
  }
  if (one.after == After::pauses) {
    robot.send(SIGCONT);
    if (!robot.await_driving(3)) return "it does not drive on";
    robot.send(SIGTERM);
  }
  const std::optional<int> end = robot.await_end(patience);
  if (!end) return "the controller did not end";
  if (one.code >= 0 && (!WIFEXITED(*end) || WEXITSTATUS(*end) != one.code))
    return fmt::format("it ended with status {:#x}", *end);
  if (!robot.await_nobody_left(patience)) return "somebody is left";
  if (one.after == After::halts && robot.drove_after_guardian())
    return "a device was commanded after the guardian had made it safe";
  return robot.is_safe() ? "" : "the last command is not the safe one";
}

[[nodiscard]] std::unique_ptr<RobotProcess> start(const Case& one) {
  std::vector<std::string> command = one.command;
  if (command.empty()) command = {project().controller.string(), "run"};
  command.insert(command.end(), one.arguments.begin(), one.arguments.end());
  command.emplace_back("--also");  // several at a time
  return std::make_unique<RobotProcess>(command, one.output, one.environment);
}

/// A robot that drives. If the machine pauses, the watchdogs rightly stop the robot before its trial begins. Then
/// another one is started, twice at most, and \p started_again counts that.
[[nodiscard]] std::unique_ptr<RobotProcess> driving(const Case& one, unsigned& started_again) {
  for (;; ++started_again) {
    std::unique_ptr<RobotProcess> robot = start(one);
    if (robot->await_driving()) return robot;
    const std::string what = "it does not drive" + description(*robot);
    if (started_again == 2) throw std::runtime_error(what);
    fmt::print("{}: {}\n--- another one is started\n", one.name, what);
  }
}

[[nodiscard]] Result try_once(const Case& one, std::mt19937& random) {
  unsigned started_again = 0;
  const std::unique_ptr<RobotProcess> started = driving(one, started_again);
  RobotProcess& robot = *started;
  pass_random_time(robot, random);
  if (one.hangs >= 0) robot.ignore(static_cast<std::uint32_t>(one.hangs));
  Times times{.event_ns = one.strike(robot)};
  std::string failure = see_it_through(one, robot, times);
  if (times.event_ns == 0) times.event_ns = robot.struck_ns();
  if (times.event_ns == 0) failure += " (the harm was not done)";
  if (times.safe_ns == 0) times.safe_ns = robot.safe_since_ns();
  if (failure.empty() && robot.text().find(one.says) == std::string::npos)
    failure = fmt::format("'{}' is not on the terminal", one.says);
  if (!failure.empty()) return {failure + description(robot)};
  return {"", std::max(0.0, static_cast<double>(times.safe_ns - times.event_ns) * 1e-6), started_again};
}

struct Figures {
  std::vector<double> latencies_ms;
  std::vector<std::string> failures;
  std::size_t started_again = 0;
};

void print_line(const std::string& line) {
  fmt::print("{}", line);
  std::fflush(stdout);
  if (const char* const file = std::getenv("TESSERA_SAFETY_TABLE"); file != nullptr)
    std::ofstream(file, std::ios::app) << line;
}

void judge(const Case& one, Figures& figures) {
  std::vector<double>& all = figures.latencies_ms;
  std::sort(all.begin(), all.end());
  const auto at = [&](double part) {
    return all.empty() ? 0.0 : all[static_cast<std::size_t>(part * static_cast<double>(all.size() - 1))];
  };
  const auto late = std::count_if(
      all.begin(), all.end(), [&](double latency) { return latency > static_cast<double>(one.bar.count()); });
  print_line(fmt::format("{:<34} {:>5} runs  p50 {:>7.1f} ms  max {:>7.1f} ms  over {} ms: {}  failed: {}\n",
                         one.name, all.size() + figures.failures.size(), at(0.5), at(1), one.bar.count(),
                         late, figures.failures.size()));
  if (!figures.failures.empty()) ADD_FAILURE() << one.name << ": " << figures.failures.front();
  EXPECT_LE(figures.started_again, 1 + runs() / 10) << one.name << ": robots stopped before their trials";
  const bool strict = std::getenv("TESSERA_SAFETY_STRICT") != nullptr;
  EXPECT_TRUE(late == 0 || !strict) << one.name;
}

}  // namespace

void try_all(const std::vector<Case>& cases) {
  ASSERT_TRUE(fs::exists(project().controller));
  std::vector<Figures> figures(cases.size());
  std::atomic<std::size_t> next{0};
  const std::size_t all = cases.size() * runs();
  std::mutex writing;
  std::size_t done = 0;
  const auto work = [&](unsigned seed) {
    std::mt19937 random(seed);
    for (std::size_t trial = next++; trial < all; trial = next++) {
      const std::size_t index = trial % cases.size();
      Result result;
      try {
        result = try_once(cases[index], random);
      } catch (const std::exception& problem) {
        result.failure = problem.what();
      }
      const std::lock_guard lock(writing);
      if (++done % 100 == 0) fmt::print("{} of {} trials\n", done, all), std::fflush(stdout);
      figures[index].started_again += result.started_again;
      if (result.failure.empty())
        figures[index].latencies_ms.push_back(result.latency_ms);
      else
        figures[index].failures.push_back(result.failure);
    }
  };
  std::vector<std::thread> threads;
  for (unsigned worker = 0; worker < workers; ++worker) threads.emplace_back(work, std::random_device()());
  for (std::thread& thread : threads) thread.join();
  for (std::size_t index = 0; index < cases.size(); ++index) judge(cases[index], figures[index]);
}

std::function<std::int64_t(RobotProcess&)> sends(int signal) {
  return [signal](RobotProcess& robot) {
    const std::int64_t now_ns = command_log::now_ns();
    robot.send(signal);
    return now_ns;
  };
}

std::function<std::int64_t(RobotProcess&)> types(char key) {
  return [key](RobotProcess& robot) {
    const std::int64_t now_ns = command_log::now_ns();
    robot.type(key);
    return now_ns;
  };
}

std::function<std::int64_t(RobotProcess&)> does(Harm harm, Place place) {
  return [harm, place](RobotProcess& robot) {
    robot.do_harm(harm, place);
    return std::int64_t{0};
  };
}

}  // namespace tessera::safety_test
