#include "managed/managed_run.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "assembly/ros2_arguments.hpp"
#include "drivers/ros2_library.hpp"
#include "managed/run_orders.hpp"
#include "nets/process_part.hpp"
#include "system/console.hpp"
#include "system/process_watch.hpp"
#include "system/stop_signals.hpp"
#include "tessera/driver_setup.hpp"
#include "tessera/ros2_nodes.hpp"

namespace tessera {
namespace {

constexpr int between_looks_ms = 20, signal_exit = 128;

void say_of_node(const std::string& text) { console::say(fmt::format("tessera: {}\n", text)); }

/// Adds options to the command line of a controller, where they count more than those behind them. At its end may be the
/// arguments of ROS 2.
void add_options(std::vector<std::string>& words, const std::vector<std::string>& options) {
  auto place = std::ranges::find(words, "run");
  if (place != words.end()) ++place;
  words.insert(place, options.begin(), options.end());
}

/// The node is where the drivers of ROS 2 are, or the first of them.
ManagedNodeSetup node_of(const System& system) {
  ManagedNodeSetup node;
  node.node = std::string(system.name);
  for (const CppDriver& driver : system.real_drivers) {
    const DriverSetup setup(std::string(driver.path), {driver.options.begin(), driver.options.end()});
    if (!setup.has("topic") || !setup.has("definition")) continue;
    node.interface = setup.text_or("interface", "lo");
    node.peers = setup.text_or("peers", "");
    if (setup.has("domain")) node.domain = static_cast<std::uint32_t>(setup.integer("domain"));
    break;
  }
  return node;
}

/// A run in a process of its own.
///
/// Threads: one at a time.
class ManagedRun {
 public:
  /// Throws DriverError.
  ManagedRun(std::vector<std::string> words) {
    std::array<int, 2> ends{-1, -1};
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
      throw DriverError(fmt::format("no socket for the run: {}", std::strerror(errno)));
    socket_ = ends[0];
    add_options(words, {"--orders", std::to_string(ends[1]), "--parent", std::to_string(getpid())});
    const int problem = start(words, ends[1]);
    close(ends[1]);
    if (problem == 0) return;
    close(socket_);
    throw DriverError(fmt::format("the run cannot be started: {}", std::strerror(problem)));
  }
  ManagedRun(const ManagedRun&) = delete;
  ManagedRun& operator=(const ManagedRun&) = delete;
  /// A run that has not ended notices that its socket is closed, and ends.
  ~ManagedRun() {
    close(socket_);
    if (!code_) waitpid(process_, nullptr, 0);
  }

  void order(RunOrders::Order order) const {
    const char byte = static_cast<char>(order);
    [[maybe_unused]] const ssize_t sent = send(socket_, &byte, 1, MSG_NOSIGNAL);
  }
  void kill(int signal) const {
    if (!code_) ::kill(process_, signal);
  }
  [[nodiscard]] int socket() const { return told_all_ ? -1 : socket_; }
  /// The newest state that it has told since the last call.
  [[nodiscard]] std::optional<RunOrders::State> told() {
    std::optional<RunOrders::State> state;
    for (char byte = 0;;) {
      const ssize_t count = recv(socket_, &byte, 1, MSG_DONTWAIT);
      if (count == 0) told_all_ = true;
      if (count != 1) return state;
      state = static_cast<RunOrders::State>(byte);
    }
  }
  /// The exit code, or 128 and the signal that has killed it; nullopt: it runs.
  [[nodiscard]] std::optional<int> ended() {
    int status = 0;
    if (!code_ && waitpid(process_, &status, WNOHANG) == process_) {
      code_ = WIFEXITED(status) ? WEXITSTATUS(status) : signal_exit + WTERMSIG(status);
      killed_ = WIFSIGNALED(status);
    }
    return code_;
  }
  /// Whether it has ended as it was asked to by a signal.
  [[nodiscard]] bool ended_by_signal() const { return code_ && *code_ > signal_exit && !killed_; }

 private:
  [[nodiscard]] int start(const std::vector<std::string>& words, int its_end) {
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, its_end, its_end);  // which stays open in the program
    const int problem =
        posix_spawn(&process_, "/proc/self/exe", &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    return problem;
  }

  pid_t process_ = -1;
  int socket_ = -1;
  bool told_all_ = false, killed_ = false;
  std::optional<int> code_;
};

/// The node and its runs, one after the other.
class ManagedSystem {
 public:
  ManagedSystem(ManagedNode& node, const RunOptions& options, std::vector<std::string> words)
      : node_(node), name_(node.name()), options_(options), words_(std::move(words)) {}

  /// Until the node is finalized. Returns the exit code.
  int serve() {
    say_of_node(
        fmt::format("{0} is unconfigured, and no device is open; it waits for `ros2 lifecycle set "
                    "{0} configure`",
                    name_));
    while (!finalized_) {
      if (const int signal = StopSignals::pending(); signal != 0 && !signal_) stop_by(signal);
      if (const auto order = node_.serve()) begin(*order);
      if (run_ != nullptr) look_at_run();
      if (!finalized_) await();
    }
    if (signal_) return signal_exit + *signal_;
    return failed_ ? 1 : 0;
  }

 private:
  void await() const {
    std::array<pollfd, 2> sources{
        pollfd{.fd = StopSignals::descriptor(), .events = POLLIN, .revents = 0},
        pollfd{.fd = run_ == nullptr ? -1 : run_->socket(), .events = POLLIN, .revents = 0}};
    poll(sources.data(), sources.size(), between_looks_ms);
    StopSignals::take_news();
  }

  void stop_by(int signal) {
    signal_ = signal;
    if (run_ != nullptr) run_->kill(signal);
    if (!under_way_ && node_.begin(LifecycleOrder::shutdown)) under_way_ = LifecycleOrder::shutdown;
    if (run_ == nullptr) finalize();
  }

  void begin(LifecycleOrder order) {
    under_way_ = order;
    switch (order) {
      case LifecycleOrder::configure:
        return configure();
      case LifecycleOrder::activate:
        return run_->order(RunOrders::Order::go_on);
      case LifecycleOrder::deactivate:
        return run_->order(RunOrders::Order::hold);
      case LifecycleOrder::cleanup:
        return run_->order(RunOrders::Order::end);
      case LifecycleOrder::shutdown:
        if (run_ == nullptr) return finalize();
        return run_->order(RunOrders::Order::end);
    }
  }

  void configure() {
    std::vector<std::string> words = words_;
    if (const std::string file = recording_of_run(options_.recording, ++runs_); !file.empty() && runs_ > 1) {
      add_options(words, {"--record", file});
      say_of_node("this run is recorded in " + file);
    }
    try {
      run_ = std::make_unique<ManagedRun>(std::move(words));
    } catch (const DriverError& wrong) {
      say_of_node(fmt::format("error: {}", wrong.what()));
      finish(LifecycleOutcome::failure);
    }
  }

  void look_at_run() {
    const std::optional<int> code = run_->ended();  // before what it has told: nothing comes after it
    if (const auto state = run_->told()) {
      if (state == RunOrders::State::held && under_way_ == LifecycleOrder::configure)
        finish(LifecycleOutcome::success, "is inactive; it waits for `ros2 lifecycle set {} activate`");
      else if (state == RunOrders::State::held && under_way_ == LifecycleOrder::deactivate)
        finish(LifecycleOutcome::success, "is inactive: the run is held");
      else if (state == RunOrders::State::runs && under_way_ == LifecycleOrder::activate)
        finish(LifecycleOutcome::success, "is active");
    }
    if (code) run_has_ended(*code, run_->ended_by_signal());
  }

  void run_has_ended(int code, bool by_signal) {
    run_.reset();
    const bool well = code == 0;
    failed_ = failed_ || (!well && !by_signal);
    if (signal_ || under_way_ == LifecycleOrder::shutdown) return finalize();
    if (by_signal) {
      signal_ = code - signal_exit;
      return finalize();
    }
    if (under_way_ == LifecycleOrder::configure)
      return finish(LifecycleOutcome::failure, "could not be configured, and is unconfigured");
    if (under_way_ == LifecycleOrder::cleanup && well)
      return finish(LifecycleOutcome::success, "is unconfigured, and no device is open");
    if (well) return finalize();  // the net has ended, or its time was up
    const std::string what = "is unconfigured, because its run has failed";
    if (under_way_) return finish(LifecycleOutcome::error, what);
    node_.fail();
    tell(what);
  }

  void finalize() {
    finalized_ = true;
    if (under_way_ != LifecycleOrder::shutdown) {
      if (under_way_) node_.finish(LifecycleOutcome::error);
      static_cast<void>(node_.begin(LifecycleOrder::shutdown));
    }
    finish(LifecycleOutcome::success, "is finalized");
  }

  void finish(LifecycleOutcome outcome, const std::string& what = "") {
    under_way_.reset();
    node_.finish(outcome);
    if (!what.empty()) tell(what);
  }
  void tell(const std::string& what) const {
    const std::size_t name = what.find("{}");
    say_of_node(fmt::format("{} {}", name_,
                            name == std::string::npos ? what : std::string(what).replace(name, 2, name_)));
  }

  ManagedNode& node_;
  const std::string name_;
  const RunOptions& options_;
  const std::vector<std::string> words_;
  std::unique_ptr<ManagedRun> run_;
  std::optional<LifecycleOrder> under_way_;
  std::optional<int> signal_;
  unsigned runs_ = 0;
  bool failed_ = false, finalized_ = false;
};

}  // namespace

std::string recording_of_run(const std::string& recording, unsigned run) {
  if (recording.empty() || run < 2) return recording;
  const std::filesystem::path file(recording);
  return (file.parent_path() / fmt::format("{}-{}{}", file.stem().string(), run, file.extension().string()))
      .string();
}

int run_managed(const System& system, const RunOptions& options, int argc, char** argv) {
  const StopSignals signals;
  const console::Session session;
  const auto refuse = [](std::string_view why) {
    console::say(fmt::format("error: no managed node: {}\n", why));
    return 1;
  };
  if (system.processes.size() > 1)
    return refuse("a process of a deployment cannot be held: the others would wait for it");
  const ManagedNodeSetup setup = node_of(system);
  std::string error;
  RunOptions named = options;  // the run says what the arguments change
  if (Ros2ArgumentNotes notes; !take_ros2_arguments(all_of(system), named, notes, error))
    return refuse(error);
  error = "it cannot be made";
  std::unique_ptr<ManagedNode> node;
  try {
    node = reinterpret_cast<ManagedNodeMaker>(
        ros2_function({TESSERA_ROS2_BUILT, TESSERA_ROS2_INSTALLED}, managed_node_function))(setup, error);
  } catch (const DriverError& wrong) {
    error = wrong.what();
  }
  if (node == nullptr) return refuse(error);
  std::optional<ProcessWatch> parent;
  constexpr pid_t none = -1;  // it had already ended
  if (options.parent != 0)
    parent.emplace(getppid() == options.parent ? options.parent : none, [] { kill(getpid(), SIGTERM); });
  return ManagedSystem(*node, options, {argv, argv + argc}).serve();
}

}  // namespace tessera
