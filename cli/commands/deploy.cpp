#include "cli/commands/deploy.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>

#include "cli/recordings/overtime.hpp"
#include "cli/recordings/process_bags.hpp"
#include "cli/terminal.hpp"
#include "cli/unhurried_output.hpp"
#include "diagnostics/source.hpp"
#include "project/files/file_names.hpp"
#include "project/meeting_place.hpp"
#include "project/process/death.hpp"
#include "project/process/restart_gate.hpp"
#include "spec/parser.hpp"
#include "tessera/channel_limits.hpp"
#include "tessera/given_values.hpp"
#include "tessera/monitor.hpp"
#include "tessera/process_claim.hpp"
#include "tessera/signals.hpp"

namespace tessera::cli {

using namespace project;

namespace {

/// The names of `--only`; empty: it was not given. Throws std::runtime_error: a name does not exist.
std::vector<std::string> names_of_only(const std::string& list) {
  if (list == DeployOptions::all) return {};
  std::vector<std::string> names = names_between_commas(list);
  if (names.empty()) throw std::runtime_error("--only names no process");
  return names;
}

/// Whether all of these processes may start here. Prints why not.
bool may_start(const spec::Model& model, const std::vector<std::uint32_t>& processes,
               const NetworkOptions& network) {
  const std::uint32_t domain = domain_of(*model.deployment, network);
  for (const std::uint32_t number : processes) {
    const spec::Process& process = model.deployment->processes[number];
    const ClaimedProcess claimed{
        .system = model.system,
        .process = process.name,
        .domain = static_cast<int>(domain),
        .interface = network.interface.empty() ? process.interface : network.interface};
    if (const auto other = ProcessClaim(claimed).other())
      return complain(runs_already(claimed, *other) + "; nothing was started"), false;
  }
  return true;
}

/// A warning about the limits of a restart: other processes wait for ever for messages that a dead process
/// has lost.
void warn_of_partition(const Controller& controller, const DeployOptions& deploy) {
  if (deploy.restart == "never" && deploy.on_failure == "stop") return;
  const auto& all = controller.report.properties;
  const auto found = std::ranges::find(all, "survives_partition", &verify::PropertyResult::name);
  if (found != all.end() && found->verdict == verify::Verdict::violated)
    terminal().say(
        "tessera: warning: survives_partition is violated: a process that waits for one that has failed "
        "may wait for ever (`tessera verify` says where a timeout is missing)\n");
}

/// Prints the lines of the processes, and stores how each has ended.
class DeployedRun final : public ProcessSetListener {
 public:
  DeployedRun(const Controller& controller, const RunFolder& folder, const LaunchOptions& options,
              const DeployOptions& deploy, Placement placement)
      : controller_(controller),
        folder_(folder.path()),
        options_(options),
        deploy_(deploy),
        placement_(std::move(placement)),
        coloured_(isatty(STDOUT_FILENO) != 0 && std::getenv("NO_COLOR") == nullptr),
        file_(folder_ / file_names::deployment, controller),
        told_(std::make_unique<UnhurriedOutput>(STDERR_FILENO)),
        said_(
            std::make_unique<UnhurriedOutput>(STDOUT_FILENO, [told = told_.get()](std::string_view problem) {
              told->write(fmt::format(
                  "tessera: cannot write to standard output: {}; the processes go on (Ctrl-C stops them)\n",
                  problem));
            })) {
    if (!deploy.bags.empty()) bags_.emplace(deploy.bags, controller.specification);
    std::fflush(stdout);
    options_.progress = false;  // several processes cannot share one line
    for (const std::uint32_t number : placement_.here) width_ = std::max(width_, name_of(number).size());
    ends_.resize(placement_.here.size());
    began_.resize(placement_.here.size());
    if (restarts())
      gate_.emplace(monitor_folder(), controller_.specification.model.system, controller_.report.net_hash);
  }

  int run() {
    const FailurePolicy policy{.restarts = restarts(), .stops_all = deploy_.on_failure == "stop"};
    ProcessSet set(
        placement_.here.size(),
        [this](std::size_t which, unsigned start) { return command_of(which, start); }, policy, *this);
    stopped_by_ = set.run();
    said_->write(table());
    return exit_code();
  }

  void started(std::size_t which, unsigned start, pid_t pid) override {
    if (start == 1) began_[which] = Clock::now();
    const std::uint32_t number = placement_.here[which];
    file_.started(number, start, pid);
    if (bags_) tell_of_bag(which, bags_->begin(which, files_of(number, start).recording));
  }
  void said(std::size_t which, std::string_view line) override {
    const std::string& name = name_of(placement_.here[which]);
    said_->write(coloured_ ? fmt::format("\033[{}m{:<{}} |\033[0m {}\n", colours[which % colours.size()],
                                         name, width_, line)
                           : fmt::format("{:<{}} | {}\n", name, width_, line));
  }
  void ended(const ProcessEnd& end, std::optional<std::chrono::milliseconds> again_in) override {
    const std::uint32_t number = placement_.here[end.process];
    End& kept = ends_[end.process];
    kept = {
        .how = how_it_ended(number, end), .starts = end.start, .end = end, .failed = has_failed(number, end)};
    file_.ended(number, end, kept.how);
    if (bags_) tell_of_bag(end.process, bags_->end(end.process));
    if (!kept.failed) return;
    any_failed_ = any_failed_ || !again_in;
    if (gate_ && again_in) gate_->failed(name_of(number));
    tell(fmt::format("{}: {}", name_of(number), kept.how) +
         (again_in                   ? fmt::format("; start {} in {:.1f} s", end.start + 1,
                                                   std::chrono::duration<double>(*again_in).count())
          : restarts() && !end.asked ? "; it has failed too often and is not started again"
                                     : ""));
  }
  Again may_start_again(std::size_t which) override {
    const std::string& name = name_of(placement_.here[which]);
    if (const auto left = time_left(which); left && left->count() <= 0)
      return stays_down(which, "the time of --for is over");
    const auto [answer, why] = gate_->ask(name);
    if (answer == RestartGate::Answer::closed) return stays_down(which, why);
    if (answer == RestartGate::Answer::open) {
      if (ends_[which].is_told_to_wait) tell(name + " is started again");
      return Again::now;
    }
    if (!why.empty() && !std::exchange(ends_[which].is_told_to_wait, true))
      tell(fmt::format("{} is not started again yet: {}", name, why));
    return Again::later;
  }
  void stopping(int signal) override {
    asked_by_ = signal == 0 ? SIGTERM : signal;
    tell(signal == 0 ? "one process has failed: all are stopped (--on-failure go-on lets the others go on)"
                     : fmt::format("{}: all processes are stopped", signal_name(signal)));
  }
  void waits_for(const std::vector<std::size_t>& processes) override {
    std::string names;
    for (const std::size_t which : processes)
      names += (names.empty() ? "" : ", ") + name_of(placement_.here[which]);
    tell("waits for " + names + "; Ctrl-C once more ends a process that hangs");
  }

 private:
  struct End {
    std::string how;
    unsigned starts = 0;
    ProcessEnd end;
    bool failed = false;
    bool is_told_to_wait = false;  ///< that its next start waits
  };
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] bool restarts() const { return deploy_.restart == "on-failure"; }
  Again stays_down(std::size_t which, const std::string& why) {
    any_failed_ = true;
    tell(fmt::format("{} is not started again: {}", name_of(placement_.here[which]), why));
    return Again::never;
  }
  /// The rest of `--for`, which begins with the first start of a process. nullopt: no limit.
  [[nodiscard]] std::optional<std::chrono::milliseconds> time_left(std::size_t which) const {
    const std::optional<Duration> whole = parse_duration(options_.duration);
    if (!whole) return std::nullopt;
    return std::chrono::ceil<std::chrono::milliseconds>(began_[which] + *whole - Clock::now());
  }

  [[nodiscard]] const std::string& name_of(std::uint32_t number) const {
    return controller_.specification.model.deployment->processes[number].name;
  }
  [[nodiscard]] ProcessFiles files_of(std::uint32_t number, unsigned start) const {
    return process_files(folder_, name_of(number), start);
  }
  [[nodiscard]] Command command_of(std::size_t which, unsigned start) const {
    const std::uint32_t number = placement_.here[which];
    LaunchOptions own = options_;
    if (const auto left = time_left(which); left && start > 1)
      own.duration = fmt::format("{}ms", std::max<std::int64_t>(left->count(), 1));
    return process_command(controller_, own, deploy_.network, name_of(number), files_of(number, start));
  }
  void tell(const std::string& text) {
    said_->settle(std::chrono::milliseconds(100));  // usually both are one terminal
    told_->write("tessera: " + text + "\n");
    told_->settle(std::chrono::milliseconds(100));
  }

  void tell_of_bag(std::size_t which, const std::string& problem) {
    if (!problem.empty()) tell(fmt::format("{}: {}", name_of(placement_.here[which]), problem));
  }

  [[nodiscard]] nlohmann::json summary_of(std::uint32_t number, unsigned start) const {
    std::ifstream stream(files_of(number, start).summary);
    nlohmann::json summary = nlohmann::json::parse(stream, nullptr, /*allow_exceptions=*/false);
    return summary.is_object() ? summary : nlohmann::json::object();
  }
  /// A process that was asked to stop has failed if it died, or reports a failure itself.
  [[nodiscard]] bool has_failed(std::uint32_t number, const ProcessEnd& end) const {
    if (!end.asked) return end.exit.code != 0;
    if (never_began(number, end)) return false;
    const nlohmann::json summary = summary_of(number, end.start);
    return summary.empty() || summary.value("failed", false);
  }
  /// The signal came before the controller could handle it: it has moved no device.
  [[nodiscard]] bool never_began(std::uint32_t number, const ProcessEnd& end) const {
    return end.asked && end.exit.code == 128 + asked_by_ && end.ran < std::chrono::seconds(2) &&
           summary_of(number, end.start).empty();
  }
  [[nodiscard]] std::string how_it_ended(std::uint32_t number, const ProcessEnd& end) const {
    const nlohmann::json summary = summary_of(number, end.start);
    if (!summary.empty()) return "ended: " + summary.value("ended", std::string("no reason given"));
    if (never_began(number, end)) return "stopped before it had begun";
    const std::string death = describe_death(end.exit, files_of(number, end.start).note);
    if (!death.empty()) return death;
    return fmt::format("could not start (exit code {})", end.exit.code);
  }

  [[nodiscard]] std::string table() const {
    const std::size_t width = std::max<std::size_t>(width_, 7);
    std::string text = fmt::format("\n{:<{}}  {:>6}  {:>9}  {:>10}  {}\n", "process", width, "starts", "ran",
                                   "firings", "end");
    for (std::size_t which = 0; which < ends_.size(); ++which) {
      const End& end = ends_[which];
      const std::uint32_t number = placement_.here[which];
      if (end.starts == 0) {
        text += fmt::format("{:<{}}  not started\n", name_of(number), width);
        continue;
      }
      const nlohmann::json summary = summary_of(number, end.starts);
      const std::string firings =
          summary.contains("firings") ? summary.at("firings").dump() : std::string("-");
      text += fmt::format("{:<{}}  {:>6}  {:>7.1f} s  {:>10}  {}\n", name_of(number), width, end.starts,
                          std::chrono::duration<double>(end.end.ran).count(), firings, end.how);
      text += indented(overtime_text(summary, slow_calls_of(summary)));
    }
    if (std::ranges::all_of(placement_.here, [&](std::uint32_t number) {
          std::error_code none;
          return !std::filesystem::exists(files_of(number, 1).recording, none);
        }))
      return text + "nothing was recorded\n";
    if (bags_) text += fmt::format("bags in {}\n", deploy_.bags);
    return text + fmt::format("recordings in {}; `tessera replay --check {}` checks them together\n",
                              folder_.string(), shell_line({folder_.string()}));
  }

  [[nodiscard]] int exit_code() const {
    if (any_failed_) return failed;
    return stopped_by_ == 0 ? ok : 128 + stopped_by_;
  }

  static constexpr std::array colours{36, 33, 32, 35, 34, 96, 93, 92, 95, 94};
  const Controller& controller_;
  std::filesystem::path folder_;
  LaunchOptions options_;
  const DeployOptions& deploy_;
  Placement placement_;
  bool coloured_, any_failed_ = false;
  DeploymentFile file_;
  /// Standard output and error. They are pointers, because their threads need a fixed address.
  std::unique_ptr<UnhurriedOutput> told_, said_;
  std::size_t width_ = 0;
  std::vector<End> ends_;
  std::vector<Clock::time_point> began_;  ///< the first start of each
  std::optional<RestartGate> gate_;
  std::optional<ProcessBags> bags_;
  int stopped_by_ = 0, asked_by_ = 0;
};

/// The commands for other machines, which a person has to run there.
void tell_of_others(const spec::Deployment& deployment, const Placement& placement,
                    const LaunchOptions& options, bool chosen) {
  std::map<std::string, std::string> by_host;
  for (const std::uint32_t number : placement.elsewhere) {
    const spec::Process& process = deployment.processes[number];
    std::string& names = by_host[process.host];
    names += (names.empty() ? "" : ", ") + process.name;
  }
  for (const auto& [host, names] : by_host) {
    const bool local = chosen && is_this_machine(host, machine_name());
    terminal().say(fmt::format("tessera: not started here: {}{}\n", names,
                               local ? " (--only)" : "; on " + command_elsewhere(options, host)));
  }
}

}  // namespace

bool check_deployment(const std::string& spec, const DeployOptions& deploy, const std::string& process) {
  diagnostics::Diagnostics found = diagnostics::load(spec_file(spec));
  const std::optional<spec::Model> model = found.has_errors() ? std::nullopt : spec::parse(found);
  if (!model) return true;
  const bool asked = deploy.asked || !process.empty();
  if (!model->deployment && !asked) return true;
  if (!model->deployment)
    return complain(
               "the specification has no `deploy`: --deploy and --process are for systems of several "
               "processes"),
           false;
  const spec::Deployment& deployment = *model->deployment;
  if (!asked && deployment.processes.size() > 1)
    return complain(
               fmt::format("the system is deployed in {} processes: `--deploy` starts those of this machine, "
                           "`--process NAME` one of them, and `tessera simulate` runs all in one",
                           deployment.processes.size())),
           false;
  const std::vector<std::string> named =
      process.empty() ? names_of_only(deploy.only) : std::vector<std::string>{process};
  // Throws for an unknown name.
  return may_start(*model, placement_of(deployment, named, machine_name()).here, deploy.network);
}

int run_deployed(const Controller& controller, const RunFolder& folder, const LaunchOptions& options,
                 const DeployOptions& deploy) {
  const spec::Deployment& deployment = *controller.specification.model.deployment;
  const std::vector<std::string> only = names_of_only(deploy.only);
  const Placement placement = placement_of(deployment, only, machine_name());
  tell_of_others(deployment, placement, options, !only.empty());
  if (placement.here.empty()) {
    folder.withdraw();
    return complain("no process of the deployment is for this machine ('" + machine_name() +
                    "'); --only NAME starts one here all the same");
  }
  warn_of_partition(controller, deploy);
  return DeployedRun(controller, folder, options, deploy, placement).run();
}

}  // namespace tessera::cli
