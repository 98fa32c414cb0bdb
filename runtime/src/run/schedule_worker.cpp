#include "run/schedule_worker.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <stdexcept>
#include <utility>

#include "run/execute.hpp"
#include "system/console.hpp"
#include "system/stop_signals.hpp"

namespace tessera {
namespace {

// Exit codes of a worker. The lines that it has written say more.
constexpr int exit_done = 0, exit_unheard = 3;
/// The first character of a line that is not a result.
constexpr char error_mark = '!';
/// RunSummary::ended of a run that neither its net nor the user's code has ended.
constexpr std::string_view out_of_time = "duration";

[[nodiscard]] std::string_view name_of(RunSummary::Failure failure) {
  switch (failure) {
    case RunSummary::Failure::deadlock:
      return "deadlock";
    case RunSummary::Failure::stuck:
      return "stuck for good";
    case RunSummary::Failure::scenario:
      return "scenario";
    case RunSummary::Failure::unsafe:
      return "unsafe device";
    case RunSummary::Failure::world:
      return "world";
    case RunSummary::Failure::check:
    case RunSummary::Failure::none:
      break;
  }
  return "other";
}

[[nodiscard]] ScheduleResult result_of(std::uint64_t seed, const RunSummary& summary, const RunTally& tally) {
  const bool only_check = summary.failure == RunSummary::Failure::check;
  // Behind the semicolon stand the checks that failed.
  const bool used_up =
      summary.ended == out_of_time || (only_check && summary.ended.starts_with("duration; "));
  ScheduleResult result{.seed = seed,
                        .failed = summary.failed,
                        .interrupted = false,
                        .simulated = summary.simulated,
                        .firings = summary.firings,
                        .ended = summary.ended,
                        .events = {},
                        .injected = summary.injected,
                        .ended_by_itself = (!summary.failed || only_check) && summary.signal == 0 && !used_up,
                        .used = {},
                        .only_check_failed = only_check};
  for (const RunSummary::Used& used : summary.used)
    result.used.push_back({used.resource, used.unit, used.amount});
  for (const RunTally::SeenFault& fault : tally.faults())
    result.events.push_back(
        {.kind = std::string(tessera::name_of(fault.fault)),
         .name = fault.instance == system_instance ? fault.name : summary.subsystems[fault.instance].path,
         .at_s = seconds(fault.first.time_since_epoch()),
         .text = fault.text});
  const bool unexplained = summary.failed && result.events.empty();
  if (unexplained || (summary.failed && !only_check && summary.failure != RunSummary::Failure::none))
    result.events.push_back({.kind = std::string(name_of(summary.failure)),
                             .name = "",
                             .at_s = seconds(summary.simulated),
                             .text = summary.warnings.empty() || summary.failure != RunSummary::Failure::world
                                         ? summary.ended
                                         : summary.warnings.back()});
  return result;
}

/// false: the reader has gone.
[[nodiscard]] bool put_line(int descriptor, std::string line) {
  line += '\n';
  for (std::string_view left = line; !left.empty();) {
    const ssize_t count = write(descriptor, left.data(), left.size());
    if (count < 0 && errno != EINTR) return false;
    if (count > 0) left.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

/// Each run allocates and frees the same memory as the one before, so the process keeps it.
void keep_memory() {
  constexpr int most = 32 << 20;  // the upper limit of glibc
  mallopt(M_MMAP_THRESHOLD, most);
  mallopt(M_TRIM_THRESHOLD, most);
  mallopt(M_TOP_PAD, 1 << 24);
}

[[nodiscard]] int run_from_queue(const ScheduleWorker::Task& task, unsigned number, int output, int note) {
  keep_memory();
  console::silence(true);
  RunOptions options = task.options;
  // The last chance of a dying process writes where and why.
  options.death_note = fmt::format("/proc/self/fd/{}", note);
  while (StopSignals::pending() == 0) {
    const std::optional<std::uint64_t> seed = task.seeds.take(number);
    if (!seed) return exit_done;
    options.seed = *seed;
    if (options.world) options.world->seed = *seed;
    RunTally tally(task.firings);
    std::string error;
    const std::optional<RunSummary> summary = execute(task.system, options, &tally, {}, error);
    if (!summary) {
      std::ranges::replace(error, '\n', ' ');
      if (!put_line(output, fmt::format("{}{} {}", error_mark, *seed, error))) return exit_unheard;
      continue;
    }
    ScheduleResult result = result_of(*seed, *summary, tally);
    result.interrupted = summary->signal != 0;
    if (!put_line(output, to_line(result))) return exit_unheard;
  }
  return exit_done;
}

[[nodiscard]] std::runtime_error errno_failure(const char* what) {
  return std::runtime_error(fmt::format("{}: {}", what, std::strerror(errno)));
}

}  // namespace

// ------------------------------------------------------------------------------------------ shared memory

SharedCounters::SharedCounters(std::size_t count) {
  if (count == 0) return;
  void* const memory =
      mmap(nullptr, count * sizeof(std::uint64_t), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  all_ = {static_cast<std::uint64_t*>(memory), count};
}

SharedCounters::~SharedCounters() {
  if (!all_.empty()) munmap(all_.data(), all_.size_bytes());
}

std::optional<std::uint64_t> SeedQueue::take(unsigned worker) {
  // A run that is not taken is not counted: the number never exceeds the last.
  std::uint64_t run = at(0).load();
  do {
    if (run >= count_) {
      at(1 + std::size_t{worker}).store(0);
      return std::nullopt;
    }
    // Written first: if the process dies right after this, the run is known.
    at(1 + std::size_t{worker}).store(run + 1);
  } while (!at(0).compare_exchange_weak(run, run + 1));
  return first_ + run;
}

std::optional<std::uint64_t> SeedQueue::taken_by(unsigned worker) const {
  const std::uint64_t run = at(1 + std::size_t{worker}).load();
  if (run == 0) return std::nullopt;
  return first_ + run - 1;
}

// ------------------------------------------------------------------------------------------ a worker

struct ScheduleWorker::Process {
  pid_t id = -1;
  int output = -1, note = -1;
  std::string begun;  // the part of a line that has come

  Process() = default;
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process() {
    if (id > 0) {
      kill(id, SIGKILL);
      waitpid(id, nullptr, 0);
    }
    for (const int descriptor : {output, note})
      if (descriptor >= 0) close(descriptor);
  }
};

ScheduleWorker::ScheduleWorker(const Task& task, unsigned number)
    : process_(std::make_unique<Process>()), number_(number) {
  std::array<int, 2> ends{-1, -1};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw errno_failure("a pipe to a process that runs schedules");
  process_->output = ends[0];
  process_->note = memfd_create("tessera_death", MFD_CLOEXEC);
  fcntl(process_->output, F_SETFL, O_NONBLOCK);
  std::fflush(nullptr);  // buffered text must not be written twice
  const pid_t parent = getpid();
  process_->id = fork();
  if (process_->id < 0) {
    const std::runtime_error reason = errno_failure("a process that runs schedules");
    close(ends[1]);
    throw reason;
  }
  if (process_->id > 0) {
    close(ends[1]);
    return;
  }
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(exit_unheard);
  if (task.quiet)
    if (const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC); nowhere >= 0)
      dup2(nowhere, STDERR_FILENO);
  int code = exit_unheard;
  try {
    code = run_from_queue(task, number, ends[1], process_->note);
  } catch (const std::exception& exception) {
    std::fprintf(stderr, "error: %s\n", exception.what());
  }
  std::fflush(nullptr);
  _exit(code);  // the parent ends everything else that this process inherited
}

ScheduleWorker::~ScheduleWorker() = default;

int ScheduleWorker::descriptor() const { return process_->output; }

ScheduleWorker::News ScheduleWorker::read() {
  News news;
  std::array<char, 1 << 16> bytes;
  for (;;) {
    const ssize_t count = ::read(process_->output, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    news.ended = count == 0;
    if (count <= 0) break;
    process_->begun.append(bytes.data(), static_cast<std::size_t>(count));
  }
  std::size_t begin = 0;
  for (std::size_t end; (end = process_->begun.find('\n', begin)) != std::string::npos; begin = end + 1) {
    const std::string_view line = std::string_view(process_->begun).substr(begin, end - begin);
    const std::size_t space = line.find(' ');
    if (line.starts_with(error_mark) && space != std::string_view::npos)
      news.refusals.push_back(
          {std::strtoull(line.data() + 1, nullptr, 10), std::string(line.substr(space + 1))});
    else if (std::optional<ScheduleResult> result = from_line(line))
      news.results.push_back(std::move(*result));
  }
  process_->begun.erase(0, begin);
  return news;
}

void ScheduleWorker::signal(int signal) const {
  if (process_->id > 0) kill(process_->id, signal);
}

std::string ScheduleWorker::death() {
  int status = 0;
  while (waitpid(process_->id, &status, 0) < 0 && errno == EINTR) {
  }
  process_->id = -1;
  if (WIFEXITED(status) && WEXITSTATUS(status) == exit_done) return "";
  std::array<char, 1024> note{};
  const ssize_t length = pread(process_->note, note.data(), note.size(), 0);
  const std::string_view text(note.data(), length > 0 ? static_cast<std::size_t>(length) : 0);
  const std::size_t line = text.find('\n');
  if (line != std::string_view::npos)
    return fmt::format("{}: {}", text.substr(0, line),
                       text.substr(line + 1, text.find('\n', line + 1) - line - 1));
  if (WIFSIGNALED(status)) return fmt::format("killed by {}", signal_name(WTERMSIG(status)));
  return fmt::format("the process has ended with exit code {}", WEXITSTATUS(status));
}

}  // namespace tessera
