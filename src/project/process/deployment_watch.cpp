#include "project/process/deployment_watch.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <utility>
#include <variant>

#include "tessera/monitor.hpp"

namespace tessera::project {

namespace {

constexpr std::chrono::milliseconds look_period{500};
/// The time until a socket without a listener is tried again.
constexpr std::chrono::seconds pause_after_refusal{5};

/// Digits by their value, the rest letter by letter.
bool comes_before(std::string_view one, std::string_view other) {
  const auto digit = [](char letter) { return std::isdigit(static_cast<unsigned char>(letter)) != 0; };
  const auto number = [&](std::string_view& text) {
    std::size_t count = 0;
    while (count < text.size() && digit(text[count])) ++count;
    std::string_view digits = text.substr(0, count);
    text.remove_prefix(count);
    while (digits.size() > 1 && digits.front() == '0') digits.remove_prefix(1);
    return digits;
  };
  while (!one.empty() && !other.empty()) {
    if (digit(one.front()) && digit(other.front())) {
      const std::string_view left = number(one), right = number(other);
      if (left.size() != right.size()) return left.size() < right.size();
      if (left != right) return left < right;
      continue;
    }
    if (one.front() != other.front()) return one.front() < other.front();
    one.remove_prefix(1);
    other.remove_prefix(1);
  }
  return one.size() < other.size();
}

/// "depot.cart[0].4711.sock" of the system depot.
struct ProcessOfSocket {
  std::string name;  ///< "cart[0]"; empty: the system has one process
  std::int64_t number = -1;
  bool is_gone = false;  ///< no process has the number
};

/// The report of the process decides, if the name of the socket is too short for the system's or differs.
bool may_be_of(std::string_view socket, const std::string& system) {
  return has_shortened_name(socket) || socket.starts_with(system + ".");
}

ProcessOfSocket process_of_socket(std::string_view socket, const std::string& system) {
  if (socket.starts_with(system + ".")) socket.remove_prefix(system.size() + 1);
  socket.remove_suffix(std::string_view(".sock").size());
  const std::size_t dot = socket.rfind('.');
  const std::string_view number = dot == std::string_view::npos ? socket : socket.substr(dot + 1);
  ProcessOfSocket made;
  const auto [end, problem] = std::from_chars(number.data(), number.data() + number.size(), made.number);
  if (problem != std::errc{} || end != number.data() + number.size() || made.number <= 0) return {};
  if (dot != std::string_view::npos) made.name = socket.substr(0, dot);
  made.is_gone = kill(static_cast<pid_t>(made.number), 0) != 0 && errno == ESRCH;
  return made;
}

}  // namespace

const char* name_of(WatchedProcess::State state) {
  switch (state) {
    case WatchedProcess::State::running:
      return "running";
    case WatchedProcess::State::silent:
      return "silent";
    case WatchedProcess::State::ended:
      return "ended";
    case WatchedProcess::State::gone:
      return "gone";
  }
  return "";
}

DeploymentWatch::DeploymentWatch(std::filesystem::path folder, std::string system, std::string net_hash)
    : folder_(std::move(folder)),
      system_(std::move(system)),
      net_hash_(std::move(net_hash)),
      elsewhere_(net_hash_) {}

bool is_loopback(std::string_view interface) {
  return interface.empty() || interface == "lo" || interface.starts_with("127.");
}

void DeploymentWatch::watch_network(OpenFeed open, std::optional<Snapshot::Deployment> given, bool firm) {
  open_feed_ = std::move(open);
  given_ = std::move(given);
  if (given_) declared_ = given_->processes;
  is_placed_ = firm;
  patience_ = firm ? Clock::now() : Clock::now() + std::chrono::seconds(1);
}

/// Takes the network on which the processes meet from the first line of one of them.
void DeploymentWatch::learn(const Snapshot::Deployment& deployment, bool is_local) {
  if (declared_.empty() || is_local) declared_ = deployment.processes;
  if (!is_local || is_placed_ || !open_feed_) return;
  is_placed_ = true;
  given_.reset();
  feed_ = is_loopback(deployment.interface) ? nullptr : open_feed_(system_, deployment);
}

/// As the specification says, if no process of this machine says it.
void DeploymentWatch::enter_network() {
  if (!given_ || (!connected_.empty() && Clock::now() < patience_)) return;
  feed_ = open_feed_(system_, *given_);
  given_.reset();
}

bool DeploymentWatch::poll(std::chrono::milliseconds longest, const EachLine& each_line) {
  look_for_sockets();
  std::vector<const ControlConnection*> open;
  for (const auto& [socket, one] : connected_)
    if (one.connection) open.push_back(&*one.connection);
  ControlConnection::wait_for_any(open, std::min(longest, look_period));
  bool changed = false;
  for (auto& [socket, one] : connected_)
    if (one.connection) changed = read(socket, one, each_line) || changed;
  for (const auto& [socket, one] : connected_)
    if (one.process && one.process->is_there()) {
      replace_older(socket);
    }
  enter_network();
  if (feed_ != nullptr)
    changed = elsewhere_.take(*feed_, [&](const WatchedProcess& process, std::string_view line) {
      if (each_line && find(process.name()) == &process) each_line(line);
    }) || changed;
  return notice_silence() || changed;
}

void DeploymentWatch::look_for_sockets() {
  const Clock::time_point now = Clock::now();
  if (now < next_look_) return;
  next_look_ = now + look_period;
  for (const std::filesystem::path& file : control_sockets(folder_)) {
    const std::string name = file.filename().string();
    const auto known = connected_.find(name);
    if (!may_be_of(name, system_) || (known != connected_.end() && !known->second.takes_none)) continue;
    if (const auto refused = refused_.find(name);
        refused != refused_.end() && now < refused->second + pause_after_refusal)
      continue;
    try_socket(file, name);
  }
}

void DeploymentWatch::try_socket(const std::filesystem::path& file, const std::string& name) {
  ControlConnection::Attempt made = ControlConnection::attempt(file);
  if (!made.may_listen) {
    refused_[name] = Clock::now();
    connected_.erase(name);
    if (process_of_socket(name, system_).is_gone)
      note_found(name, connected_[name], WatchedProcess::State::gone);
    return;
  }
  refused_.erase(name);
  const auto [known, is_new] = connected_.try_emplace(name);
  Connected& one = known->second;
  one.takes_none = !made.connection;
  if (made.connection || is_new) one.made = Clock::now();
  one.connection = std::move(made.connection);
}

/// The state of a process that has sent nothing.
void DeploymentWatch::note_found(const std::string& socket, Connected& one,
                                 WatchedProcess::State state) const {
  const ProcessOfSocket known = process_of_socket(socket, system_);
  if (known.name.empty() || !socket.starts_with(system_.substr(0, socket.find(cut_off_name)))) return;
  Snapshot snapshot;
  snapshot.system = system_;
  snapshot.process = known.name;
  snapshot.pid = known.number;
  one.process = WatchedProcess{.state = state,
                               .since = {},
                               .heard = Clock::now(),
                               .socket = socket,
                               .is_local = one.connection && one.connection->is_process(known.number),
                               .snapshot = std::move(snapshot)};
}

/// Whether it is seen otherwise than before.
bool DeploymentWatch::read(const std::string& socket, Connected& one, const EachLine& each_line) {
  using Received = ControlConnection::Received;
  Received received = Received::bytes;
  while (received == Received::bytes && !one.heard.exceeds_limits())
    received = one.connection->receive_at_once(one.heard);
  bool changed = false;
  while (std::optional<ControlMessage> message = one.heard.next()) {
    if (one.ignored) continue;
    changed = take(socket, one, std::move(message->content)) || changed;
    if (each_line && one.process && !one.ignored) each_line(message->line);
  }
  if (received != Received::over && !one.heard.exceeds_limits() && !one.ignored) return changed;
  one.connection.reset();
  if (!one.process || one.process->state == WatchedProcess::State::ended) return changed;
  one.process->state = WatchedProcess::State::gone;
  one.process->since = Clock::now();
  return true;
}

bool DeploymentWatch::take(const std::string& socket, Connected& one, std::optional<ControlLine> line) {
  if (!line) return false;
  const Clock::time_point now = Clock::now();
  if (std::holds_alternative<ControllerHasEnded>(*line)) {
    if (!one.process) return false;
    one.process->state = WatchedProcess::State::ended;
    one.process->since = now;
    return true;
  }
  auto* snapshot = std::get_if<Snapshot>(&*line);
  if (snapshot == nullptr) return false;
  const bool of_another_net = !net_hash_.empty() && snapshot->net_hash != net_hash_;
  if (snapshot->system != system_ || !snapshot->process || of_another_net) {
    of_another_net_ += static_cast<std::size_t>(of_another_net);
    one.ignored = true;
    one.process.reset();
    return false;
  }
  if (!one.process)
    one.process =
        WatchedProcess{.since = now, .heard = now, .socket = socket, .is_local = false, .snapshot = {}};
  if (one.process->state == WatchedProcess::State::silent) one.process->since = now;
  if (one.process->snapshot.pid != snapshot->pid)
    one.process->is_local = one.connection && one.connection->is_process(snapshot->pid);
  if (snapshot->deployment) learn(*snapshot->deployment, one.process->is_local);
  one.process->state = WatchedProcess::State::running;
  one.process->heard = now;
  one.process->snapshot = std::move(*snapshot);
  return true;
}

/// An earlier start of a process is of no interest any more once another has begun.
void DeploymentWatch::replace_older(const std::string& socket) {
  const std::string& name = connected_.at(socket).process->name();
  for (auto& [other, one] : connected_)
    if (other != socket && one.process && !one.process->is_there() && one.process->name() == name) {
      one.process.reset();
      one.ignored = true;
    }
}

bool DeploymentWatch::notice_silence() {
  bool changed = elsewhere_.notice_silence();
  const Clock::time_point now = Clock::now();
  for (auto& [socket, one] : connected_) {
    const bool may_listen = one.connection || one.takes_none;
    if (!one.process && may_listen && !one.ignored && now >= one.made + longest_silence) {
      note_found(socket, one, WatchedProcess::State::silent);
      if (one.process) one.process->heard = one.made;
      changed = true;
    }
    if (!one.process || one.process->state != WatchedProcess::State::running) continue;
    if (now < one.process->heard + longest_silence) continue;
    one.process->state = WatchedProcess::State::silent;
    one.process->since = one.process->heard;
    changed = true;
  }
  return changed;
}

std::vector<const WatchedProcess*> DeploymentWatch::processes() const {
  std::vector<const WatchedProcess*> all;
  for (const auto& [socket, one] : connected_)
    if (one.process && shown_of(&*one.process, elsewhere_.find(one.process->name())) == &*one.process)
      all.push_back(&*one.process);
  for (const auto& [name, one] : elsewhere_.all())
    if (shown_of(find_here(name), &one) == &one) all.push_back(&one);
  std::ranges::stable_sort(
      all, [](const auto* one, const auto* other) { return comes_before(one->name(), other->name()); });
  return all;
}

const WatchedProcess* DeploymentWatch::find_here(std::string_view name) const {
  const WatchedProcess* found = nullptr;
  for (const auto& [socket, one] : connected_)
    if (one.process && one.process->name() == name && (found == nullptr || one.process->is_there()))
      found = &*one.process;
  return found;
}

const WatchedProcess* DeploymentWatch::find(std::string_view name) const {
  return shown_of(find_here(name), elsewhere_.find(name));
}

}  // namespace tessera::project
