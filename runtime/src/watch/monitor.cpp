#include "watch/monitor.hpp"

#include <cxxabi.h>
#include <fmt/core.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>
#include <variant>

#include "system/console.hpp"
#include "system/waker.hpp"
#include "watch/snapshot.hpp"

namespace tessera {
namespace {

constexpr int send_period_ms = 200, controlled_period_ms = 40;
constexpr int look_at_devices_ms = 5;  // while an operator waits for them
/// Clients that only watch must leave room for an emergency stop. One beyond their number gets the present state,
/// and goes unless it sends a command: those of this project do that within two seconds.
constexpr std::size_t most_watchers = 64, most_clients = 128;
constexpr std::int64_t trial_ns = 3'000'000'000;
/// A snapshot of a large system takes long to write. The thread then rests for this many times as long.
constexpr std::int64_t rest_per_work = 50;

/// "line_follower"; "depot.cart[0]" for one process of a deployed system.
[[nodiscard]] std::string name_of_controller(const Assembly& assembly) {
  const std::string& process = assembly.options.network.process;
  return std::string(assembly.system.name) + (process.empty() ? "" : "." + process);
}

/// The unchanged path if the absolute one cannot be determined: the folder may be gone.
[[nodiscard]] std::string absolute(const std::string& path) {
  if (path.empty()) return path;
  std::error_code problem;
  const std::filesystem::path whole = std::filesystem::absolute(path, problem);
  return problem ? path : whole.string();
}

}  // namespace

std::unique_ptr<MonitorSocket> Monitor::listen(const Assembly& assembly) {
  return std::make_unique<MonitorSocket>(name_of_controller(assembly));
}

Monitor::Monitor(Assembly& assembly, const Clock& clock, std::unique_ptr<MonitorSocket> listening,
                 RemoteControl* remote)
    : assembly_(assembly),
      clock_(clock),
      recording_path_(absolute(assembly.options.recording)),
      listening_(std::move(listening)),
      remote_(remote),
      stops_(assembly.executors, assembly.control) {
  failure_ = listening_->failure();
  if (listening_->descriptor() < 0) return;
  ending_ = eventfd(0, EFD_CLOEXEC);
  while (remote_ == nullptr && accept_client()) continue;
  try {
    thread_ = std::thread([this] { serve(); });
  } catch (const std::system_error& error) {
    failure_ = Problem{error.what()};
  }
}

Monitor::~Monitor() {
  if (thread_.joinable()) {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = write(ending_, &one, sizeof one);
    thread_.join();
  }
  try {
    stops_.give_all(answer);
  } catch (const std::exception&) {  // no memory: the end of the connection is the answer
  }
  for (std::unique_ptr<MonitorClient>& client : clients_) {
    try {
      send_end(*client);
    } catch (const std::exception&) {  // the client has received less than it could have
    }
    client.reset();
  }
  if (ending_ >= 0) close(ending_);
}

void Monitor::warn_of_failure(Time now) const {
  if (failure_)
    console::print(
        LogLevel::warning, now, "tessera",
        fmt::format("`tessera top`, `set` and `emergency-stop` cannot reach this run: {}", failure_->text));
}

// -------------------------------------------------------------------------------------------- the thread

/// A failure while serving clients ends the monitor and not the run.
void Monitor::serve() {
  std::string_view what = "an exception that is no std::exception";
  std::string text;
  try {
    return serve_until_ended();
  } catch (const abi::__forced_unwind&) {
    throw;
  } catch (const std::exception& exception) {
    try {
      text = fmt::format("`tessera top`, `set` and `emergency-stop` cannot reach this run any more: {}",
                         exception.what());
      what = text;
    } catch (...) {  // no memory for more
    }
  } catch (...) {
  }
  console::print(LogLevel::warning, clock_.now(), "tessera", what);
}

void Monitor::serve_until_ended() {
  std::int64_t due_ns = 0;
  for (;;) {
    std::vector<pollfd> sources{
        pollfd{.fd = ending_, .events = POLLIN, .revents = 0},
        pollfd{.fd = cannot_accept_ ? -1 : listening_->descriptor(), .events = POLLIN, .revents = 0}};
    for (const std::unique_ptr<MonitorClient>& client : clients_) {
      const int wanted = POLLIN | (client->up_to_date() ? 0 : POLLOUT);
      sources.push_back({.fd = client->socket(), .events = static_cast<short>(wanted), .revents = 0});
    }
    const std::int64_t left_ms = (due_ns - monotonic_ns()) / 1'000'000 + 1;
    // No client is connected: it does no work.
    int wait_ms =
        clients_.empty() && !cannot_accept_ ? -1 : static_cast<int>(std::max<std::int64_t>(left_ms, 0));
    if (!stops_.none()) wait_ms = std::min(wait_ms, look_at_devices_ms);
    poll(sources.data(), sources.size(), wait_ms);
    if ((sources[0].revents & POLLIN) != 0) return;
    for (std::size_t client = 0; client + 2 < sources.size(); ++client) {
      const int ready = sources[client + 2].revents;
      if ((ready & POLLOUT) != 0) clients_[client]->send();
      if ((ready & ~POLLOUT) != 0) receive(*clients_[client]);
    }
    remove_gone_clients();
    if ((sources[1].revents & POLLIN) != 0) accept_client();
    answer_stops();
    const std::int64_t begin_ns = monotonic_ns();
    if (begin_ns < due_ns) continue;
    cannot_accept_ = false;
    send_snapshots();
    const std::int64_t end_ns = monotonic_ns(),
                       period_ms = remote_ == nullptr ? send_period_ms : controlled_period_ms;
    due_ns = end_ns + std::max(period_ms * 1'000'000, (end_ns - begin_ns) * rest_per_work);
  }
}

/// false: none is waiting.
bool Monitor::accept_client() {
  const MonitorSocket::Accepted accepted = listening_->accept();
  cannot_accept_ = accepted.exhausted;
  if (accepted.socket < 0) return false;
  auto client = std::make_unique<MonitorClient>(accepted.socket);
  if (clients_.size() >= most_clients && !make_room()) return true;
  put_on_trial(*client);
  Snapshot first = snapshot();
  first.deployment = deployment_of(assembly_);
  client->add(line_of(first));
  client->send();
  clients_.push_back(std::move(client));
  if (remote_ != nullptr) remote_->show_recording();
  receive(*clients_.back());  // before anybody else can take its room
  return true;
}

/// The one that has been on trial for the longest time must go. false: there is none.
bool Monitor::make_room() {
  const auto oldest = std::ranges::find_if(clients_, [](const auto& one) { return one->is_on_trial(); });
  if (oldest == clients_.end()) return false;
  stops_.forget(**oldest);
  clients_.erase(oldest);
  return true;
}

void Monitor::put_on_trial(MonitorClient& client) const {
  const auto watchers = std::ranges::count_if(
      clients_, [](const auto& one) { return !one->has_asked() && !one->is_on_trial(); });
  if (std::cmp_greater_equal(watchers, most_watchers)) client.expect_command_until(monotonic_ns() + trial_ns);
}

void Monitor::receive(MonitorClient& client) {
  if (client.receive() == 0) return;
  execute_commands(client);
  client.check_limits();
}

/// Executes the commands of a client that has gone without waiting for the answer: one may be an emergency
/// stop, sent while this process was held up.
void Monitor::receive_rest(MonitorClient& client) {
  for (std::size_t received = 0; received < MonitorClient::longest_command;) {
    const std::size_t count = client.receive();
    if (count == 0) return;
    execute_commands(client);
    received += count;
  }
}

void Monitor::remove_gone_clients() {
  const std::int64_t now_ns = clients_.empty() ? 0 : monotonic_ns();
  std::erase_if(clients_, [&](const std::unique_ptr<MonitorClient>& client) {
    const bool has_failed = client->is_on_trial() && now_ns > client->command_until_ns();
    if (!client->gone() && !has_failed) return false;
    receive_rest(*client);
    if (!client->gone() && client->has_asked()) return false;
    stops_.forget(*client);
    if (client->owns_run() && remote_ != nullptr) remote_->abandon();
    return true;
  });
}

/// A client that has not taken the last line yet does not get this one.
void Monitor::send_snapshots() {
  std::string line;
  if (remote_ != nullptr && !clients_.empty()) remote_->show_recording();
  for (const std::unique_ptr<MonitorClient>& client : clients_) {
    if (!client->up_to_date()) {
      client->skip_snapshot();
      continue;
    }
    if (line.empty()) line = line_of(snapshot());
    client->add(line);
    client->send();
  }
  remove_gone_clients();
}

/// Sends the end, and the part of the recording that the client does not have.
void Monitor::send_end(MonitorClient& client) {
  client.add(line_of(ControllerHasEnded{}));
  client.send();
  bool more = client.has_recording();
  while (more && client.up_to_date() && !client.gone()) {
    more = client.add_piece(assembly_.options.recording);
    client.send();
  }
}

Snapshot Monitor::snapshot() const {
  Snapshot snapshot = take_snapshot(assembly_, clock_);
  if (!recording_path_.empty()) snapshot.recording = recording_path_;
  if (remote_ != nullptr) snapshot.control = remote_->shown();
  return snapshot;
}

// -------------------------------------------------------------------------------------------- commands

void Monitor::execute_commands(MonitorClient& client) {
  while (const std::optional<std::string> line = client.take_line())
    execute_request(client, read_control_request(*line));
}

/// A client that has gone gets no answer and no recording.
void Monitor::execute_request(MonitorClient& client, const ControlRequest& request) {
  if (!request.command)
    return answer(client, {.id = request.id, .problem = Problem{request.command.problem()}});
  const ControlCommand& command = *request.command;
  std::visit(
      [&]<class Command>(const Command& one) {
        if constexpr (std::is_same_v<Command, command::Own>) {
          client.own_run();
        } else if constexpr (std::is_same_v<Command, command::Recording> ||
                             std::is_same_v<Command, command::Scene>) {
          send_piece(client, one);
        } else if constexpr (std::is_same_v<Command, command::Offers>) {
          answer(client, {.id = request.id, .problem = {}, .offered = offered()});
        } else {
          const std::optional<Problem> wrong = this->execute(one);
          // In simulated time, the devices may stand still, and no person is near them.
          if (remote_ == nullptr && std::is_same_v<Command, command::EmergencyStop> && !client.gone())
            stops_.await(client, request.id);
          else
            answer(client, {.id = request.id, .problem = wrong, .elsewhere = wrong && is_elsewhere(command)});
        }
      },
      command);
}

template <class Command>
void Monitor::send_piece(MonitorClient& client, const Command& command) {
  if (client.gone()) return;
  // Without this, a client that always has a piece on the way would never get a snapshot.
  if (client.take_skipped()) client.add(line_of(snapshot()));
  if constexpr (std::is_same_v<Command, command::Scene>)
    client.add_scene(assembly_.scene_file, command.from);
  else
    client.add_piece(assembly_.options.recording);
  client.send();
}

void Monitor::answer_stops() { stops_.give(answer); }

void Monitor::answer(MonitorClient& client, const CommandAnswer& answer) {
  if (client.gone()) return;
  client.add(line_of(answer));
  client.send();
}

std::optional<Problem> Monitor::execute(const SimulationCommand& command) {
  if (remote_ == nullptr) return Problem{"a controller in real time cannot be paused"};
  return remote_->execute(command);
}

std::optional<Problem> Monitor::execute(const command::Set& command) {
  if (command.only_try) return assembly_.changes->try_out(command.path, command.value);
  return assembly_.changes->ask(command.path, command.value);
}

std::optional<Problem> Monitor::execute(const command::Panel& command) {
  return assembly_.panels.feed(command);
}

Offered Monitor::offered() const { return {assembly_.changes->offered(), assembly_.panels.offered()}; }

/// Whether the name exists in another process only.
bool Monitor::is_elsewhere(const ControlCommand& command) const {
  if (const auto* const set = std::get_if<command::Set>(&command))
    return !assembly_.changes->knows(set->path);
  const auto* const panel = std::get_if<command::Panel>(&command);
  return panel != nullptr && !assembly_.panels.knows(panel->path);
}

std::optional<Problem> Monitor::execute(const command::EmergencyStop& command) {
  assembly_.control.begin_emergency(command.why.empty() ? "an operator asks for it" : command.why);
  return std::nullopt;
}

/// A device that has not obeyed the stop must not move again. If it does not obey within Effectors::patience, the
/// run fails.
std::optional<Problem> Monitor::execute(const command::Reset& /*command*/) {
  if (remote_ == nullptr && assembly_.control.emergency())
    if (const std::optional<Problem> wrong = stops_.not_safe_yet())
      return Problem{fmt::format("not reset: {}", wrong->text)};
  if (assembly_.control.end_emergency(clock_.now() + Duration(1))) return std::nullopt;
  return Problem{"there is no emergency stop"};
}

}  // namespace tessera
