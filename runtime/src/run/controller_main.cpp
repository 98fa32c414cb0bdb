#include <cxxabi.h>
#include <fmt/core.h>
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <memory>

#include "drivers/recorded_inputs.hpp"
#include "managed/managed_run.hpp"
#include "rerun/rerun.hpp"
#include "run/command_line.hpp"
#include "run/execute.hpp"
#include "run/schedules.hpp"
#include "run/summary_text.hpp"
#include "system/console.hpp"
#include "system/stop_signals.hpp"
#include "tessera/controller.hpp"
#include "tessera/printable.hpp"
#include "tessera/standard_streams.hpp"

namespace tessera {
namespace {

// The exit code after a signal is exit_signal plus the number of the signal.
constexpr int exit_ok = 0, exit_failed = 1, exit_signal = 128;

/// A terminal that was closed must not end the process here: fmt::print would throw.
void complain(std::string_view what) {
  const std::string text = fmt::format("error: {}\n", printable(what));
  static_cast<void>(std::fwrite(text.data(), 1, text.size(), stderr));
}

[[nodiscard]] bool write_summary(const std::string& file, const std::string& json) {
  if (file == "-") return static_cast<bool>(std::cout << json << std::flush);
  std::ofstream stream(file);
  stream << json << std::flush;
  return static_cast<bool>(stream);
}

[[nodiscard]] int report(const RunSummary& summary, const CommandLine& line) {
  // The end must not wait for a blocked terminal.
  const console::Session session;
  // A user who asks for a summary file prints it himself.
  if (summary.failed && line.summary.empty()) console::say(printable(summary_lines(summary)));
  if (!line.summary.empty() && !write_summary(line.summary, summary_json(summary, line.options))) {
    fmt::print(stderr, "error: cannot write '{}'\n", line.summary);
    return exit_failed;
  }
  if (summary.failed) return exit_failed;
  return summary.signal == 0 ? exit_ok : exit_signal + summary.signal;
}

/// Does not destroy objects that threads still use.
[[noreturn]] void end_process(const RunSummary& summary, const CommandLine& line) {
  const int code = report(summary, line);
  static_cast<void>(console::Session().settle());
  _exit(code);
}

[[nodiscard]] int run_schedules(const System& system, const CommandLine& line) {
  std::string error;
  const std::optional<ScheduleReport> report =
      try_schedules(system, line.options, {*line.schedules, line.jobs, line.coverage}, error);
  if (!report) {
    complain(error);
    return exit_failed;
  }
  const console::Session session;  // the processes of the runs are over: a thread may begin
  // A user who asks for a summary file prints it himself.
  if (line.summary.empty()) console::say(printable(schedules_text(*report)));
  if (!line.summary.empty() && !write_summary(line.summary, schedules_json(*report))) {
    fmt::print(stderr, "error: cannot write '{}'\n", line.summary);
    return exit_failed;
  }
  if (report->failed > 0) return exit_failed;
  return report->interrupted == 0 ? exit_ok : exit_signal + report->interrupted;
}

[[nodiscard]] int run_again(const System& system, const CommandLine& line) {
  std::string error;
  const std::optional<RerunReport> report = rerun(system, line.options, line.from, error);
  if (!report) {
    complain(error);
    return exit_failed;
  }
  if (line.summary != "-") fmt::print("{}", printable(rerun_text(*report)));
  if (!line.summary.empty() && !write_summary(line.summary, rerun_json(*report))) {
    fmt::print(stderr, "error: cannot write '{}'\n", line.summary);
    return exit_failed;
  }
  return report->first ? exit_failed : exit_ok;
}

}  // namespace

int controller_main(const System& system, int argc, char** argv) try {
  open_missing_streams();
  const std::variant<CommandLine, int> parsed = parse_command_line(system, argc, argv);
  if (const int* code = std::get_if<int>(&parsed)) return *code;
  const CommandLine& line = std::get<CommandLine>(parsed);
  if (line.schedules) return run_schedules(system, line);
  if (!line.from.empty()) return run_again(system, line);
  if (line.managed && line.options.orders < 0) return run_managed(system, line.options, argc, argv);
  std::string error;
  std::unique_ptr<RecordedInputs> inputs;
  RunOptions options = line.options;
  if (!line.inputs.empty()) {
    inputs = RecordedInputs::read(line.inputs, error);
    if (inputs == nullptr) return complain(error), exit_failed;
    options.substitutes = inputs.get();
  }
  const GiveUp give_up{.end_process = [&](const RunSummary& summary) { end_process(summary, line); }};
  const std::optional<RunSummary> summary = execute(system, options, nullptr, give_up, error);
  if (!summary) {
    complain(error);
    const int signal = StopSignals::pending();  // one may have come while devices were opened
    return signal == 0 ? exit_failed : exit_signal + signal;
  }
  return report(*summary, line);
} catch (const std::exception& exception) {
  complain(exception.what());
  return exit_failed;
} catch (const abi::__forced_unwind&) {
  throw;
} catch (...) {
  fmt::print(stderr, "error: an exception that is no std::exception\n");
  return exit_failed;
}

}  // namespace tessera
