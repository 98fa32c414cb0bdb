#include "watch/monitor.hpp"

#include <cxxabi.h>
#include <fmt/core.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "system/console.hpp"
#include "tessera/monitor.hpp"

namespace tessera {
namespace {

constexpr int send_period_ms = 200, controlled_period_ms = 40;
constexpr std::size_t most_clients = 32, longest_command = std::size_t{1} << 20U,
                      most_waiting = std::size_t{16} << 20U;
constexpr std::int64_t client_patience_ns = 5'000'000'000;
/// Of a large system a line takes long to write; the thread may take this part of a processor.
constexpr std::int64_t rest_per_work = 50;

[[nodiscard]] double seconds_of(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

/// The folder, which must be ours alone: somebody else's could be a trap.
[[nodiscard]] bool own_folder(const std::string& folder, std::string& failure) {
  struct stat status {};
  if (mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST)
    failure = fmt::format("cannot make '{}': {}", folder, std::strerror(errno));
  else if (lstat(folder.c_str(), &status) != 0)
    failure = fmt::format("cannot look at '{}': {}", folder, std::strerror(errno));
  else if (!S_ISDIR(status.st_mode) || status.st_uid != geteuid() || (status.st_mode & 077U) != 0)
    failure = fmt::format("'{}' is not a folder that only its owner may enter", folder);
  return failure.empty();
}

[[nodiscard]] bool is_owner(int client) {
  ucred peer{};
  socklen_t size = sizeof peer;
  return getsockopt(client, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 &&
         (peer.uid == geteuid() || peer.uid == 0);
}

/// What is no UTF-8 (a path may be anything) is replaced.
[[nodiscard]] std::string text_of(const nlohmann::json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// As it is where that cannot be found out: the folder may have gone.
[[nodiscard]] std::string absolute(const std::string& path) {
  if (path.empty()) return path;
  std::error_code problem;
  const std::filesystem::path whole = std::filesystem::absolute(path, problem);
  return problem ? path : whole.string();
}

}  // namespace

std::string monitor_folder() {
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  if (runtime != nullptr && *runtime != '\0') return std::string(runtime) + "/tessera";
  return fmt::format("/tmp/tessera-{}", geteuid());
}

Monitor::Monitor(Assembly& assembly, const Clock& clock, RemoteControl* remote)
    : assembly_(assembly),
      clock_(clock),
      recording_path_(absolute(assembly.options.recording)),
      remote_(remote) {
  if (!listen_in(monitor_folder())) return;
  ending_ = eventfd(0, EFD_CLOEXEC);
  try {
    thread_ = std::thread([this] { serve(); });
  } catch (const std::system_error& error) {
    failure_ = error.what();
  }
}

Monitor::~Monitor() {
  if (thread_.joinable()) {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = write(ending_, &one, sizeof one);
    thread_.join();
  }
  for (Client& client : clients_) {
    try {
      say_goodbye(client);
    } catch (const std::exception&) {  // it has seen less than it could have
    }
    close(client.socket);
  }
  if (ending_ >= 0) close(ending_);
  if (listening_ < 0) return;
  close(listening_);
  unlink(socket_file_.c_str());
}

namespace {

/// Of a process that was killed: it is gone, and nobody else (through a tunnel, from a container) listens.
bool is_left_behind(const std::filesystem::path& file) {
  const std::string name = file.stem().string();  // SYSTEM.PID
  const std::size_t dot = name.rfind('.');
  if (file.extension() != ".sock" || dot == std::string::npos ||
      file.native().size() >= sizeof(sockaddr_un::sun_path))
    return false;
  pid_t process = 0;
  const auto [end, problem] = std::from_chars(name.data() + dot + 1, name.data() + name.size(), process);
  if (problem != std::errc{} || end != name.data() + name.size() || process <= 0) return false;
  if (kill(process, 0) == 0 || errno != ESRCH) return false;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, file.c_str(), file.native().size() + 1);
  const int made = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (made < 0) return false;
  const bool refused = connect(made, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 &&
                       errno == ECONNREFUSED;
  close(made);
  return refused;
}

void remove_left_behind(const std::string& folder) {
  std::error_code problem;
  for (std::filesystem::directory_iterator entry(folder, problem), end; !problem && entry != end;
       entry.increment(problem))
    if (is_left_behind(entry->path())) unlink(entry->path().c_str());
}

}  // namespace

bool Monitor::listen_in(const std::string& folder) {
  if (!own_folder(folder, failure_)) return false;
  remove_left_behind(folder);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string file = fmt::format("{}/{}.{}.sock", folder, assembly_.system.name, getpid());
  if (file.size() >= sizeof address.sun_path) {
    failure_ = fmt::format("the path '{}' is too long for a socket", file);
    return false;
  }
  std::memcpy(address.sun_path, file.c_str(), file.size() + 1);
  unlink(file.c_str());  // of an earlier process with our number
  const int descriptor = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const auto* name = reinterpret_cast<const sockaddr*>(&address);
  if (descriptor < 0 || bind(descriptor, name, sizeof address) != 0 || listen(descriptor, 4) != 0) {
    failure_ = fmt::format("cannot listen at '{}': {}", file, std::strerror(errno));
    if (descriptor >= 0) close(descriptor);
    return false;
  }
  chmod(file.c_str(), 0600);
  socket_file_ = file;
  listening_ = descriptor;
  return true;
}

void Monitor::complain_of_failure(Time now) const {
  if (!failure_.empty())
    console::print(LogLevel::warning, now, "tessera",
                   fmt::format("`tessera top` cannot look at this run: {}", failure_));
}

/// Whatever goes wrong with those who watch ends the watching and not the run.
void Monitor::serve() {
  std::string_view what = "an exception that is no std::exception";
  std::string text;
  try {
    return serve_until_ended();
  } catch (const abi::__forced_unwind&) {
    throw;
  } catch (const std::exception& exception) {
    try {
      text = fmt::format("`tessera top` cannot look at this run any more: {}", exception.what());
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
        pollfd{.fd = cannot_accept_ ? -1 : listening_, .events = POLLIN, .revents = 0}};
    for (const Client& client : clients_) {
      const int wanted = POLLIN | (client.waiting.empty() ? 0 : POLLOUT);
      sources.push_back({.fd = client.socket, .events = static_cast<short>(wanted), .revents = 0});
    }
    const std::int64_t left_ms = (due_ns - monotonic_ns()) / 1'000'000 + 1;
    // Nobody watches: no work at all.
    poll(sources.data(), sources.size(),
         clients_.empty() && !cannot_accept_ ? -1 : static_cast<int>(std::max<std::int64_t>(left_ms, 0)));
    if ((sources[0].revents & POLLIN) != 0) return;
    for (std::size_t client = 0; client + 2 < sources.size(); ++client) {
      const int ready = sources[client + 2].revents;
      if ((ready & POLLOUT) != 0) deliver(clients_[client]);
      if ((ready & ~POLLOUT) != 0) hear(clients_[client]);
    }
    drop_the_gone();
    if ((sources[1].revents & POLLIN) != 0) admit();
    const std::int64_t begin_ns = monotonic_ns();
    if (begin_ns < due_ns) continue;
    cannot_accept_ = false;
    send_to_all();
    const std::int64_t end_ns = monotonic_ns(),
                       period_ms = remote_ == nullptr ? send_period_ms : controlled_period_ms;
    due_ns = end_ns + std::max(period_ms * 1'000'000, (end_ns - begin_ns) * rest_per_work);
  }
}

void Monitor::admit() {
  const int client = accept4(listening_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (client < 0) {
    cannot_accept_ = errno != EAGAIN && errno != EINTR && errno != ECONNABORTED;  // later, maybe
    return;
  }
  if (clients_.size() >= most_clients || !is_owner(client)) {
    close(client);
    return;
  }
  clients_.push_back({.socket = client, .said = {}, .waiting = {}, .recording = nullptr});
  send_to_all();
}

void Monitor::hear(Client& client) {
  std::array<char, 4096> bytes{};
  const ssize_t count = recv(client.socket, bytes.data(), bytes.size(), MSG_DONTWAIT);
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return;
  client.gone = count <= 0;
  if (client.gone) return;
  obey_all(client, {bytes.data(), static_cast<std::size_t>(count)});
  client.gone = client.gone || client.said.size() > longest_command || client.waiting.size() > most_waiting;
}

/// Who asks and goes without waiting for the answer is obeyed: it may be an emergency stop, sent while this
/// process did not get on.
void Monitor::hear_the_rest(Client& client) {
  std::array<char, 4096> bytes{};
  ssize_t count = 0;
  for (std::size_t heard = 0; heard < longest_command; heard += static_cast<std::size_t>(count)) {
    count = recv(client.socket, bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (count <= 0) return;
    obey_all(client, {bytes.data(), static_cast<std::size_t>(count)});
  }
}

void Monitor::obey_all(Client& client, std::string_view heard) {
  client.said.append(heard);
  for (std::size_t end = 0; (end = client.said.find('\n')) != std::string::npos;
       client.said.erase(0, end + 1))
    obey(client, client.said.substr(0, end));
}

void Monitor::obey(Client& client, const std::string& line) {
  const nlohmann::json command = nlohmann::json::parse(line, nullptr, /*allow_exceptions=*/false);
  const bool named = command.is_object() && command.contains("command");
  if (named && command["command"] == "own") {
    client.owner = true;
    return;
  }
  if (client.gone) {  // nobody takes an answer, and a recording least of all
    static_cast<void>(answer_to(command));
    return;
  }
  if (client.waiting.empty()) client.took_ns = monotonic_ns();
  if (named && command["command"] == "recording") {
    // Who always has a piece on the way would never get a line.
    if (std::exchange(client.missed_a_line, false)) client.waiting += snapshot() + '\n';
    add_piece(client);
  } else {
    client.waiting += answer_to(command);
  }
  deliver(client);
}

/// What is wrong with it; empty: nothing. Throws what a member of another type makes nlohmann::json throw.
std::string Monitor::carry_out(const nlohmann::json& command) {
  const std::string what = command.value("command", "");
  if (what == "set") return assembly_.changes->ask(command.at("path"), command.at("value"));
  if (what == "emergency_stop") {
    assembly_.control.begin_emergency(command.value("why", "an operator asks for it"));
    return "";
  }
  if (what == "reset")
    return assembly_.control.end_emergency(clock_.now() + Duration(1)) ? "" : "there is no emergency stop";
  return remote_ == nullptr ? "a controller in real time cannot be paused" : remote_->command(command);
}

std::string Monitor::answer_to(const nlohmann::json& command) {
  std::string wrong = "this is no command";
  std::int64_t id = 0;
  try {
    id = command.value("id", id);
    wrong = carry_out(command);
  } catch (const nlohmann::json::exception&) {  // members of another type
  }
  return text_of({{"answer", id}, {"error", wrong}}) + '\n';
}

/// false: there was nothing new.
bool Monitor::add_piece(Client& client) {
  if (client.recording == nullptr)
    client.recording =
        std::make_unique<GrowingRecording>(assembly_.options.recording, GrowingRecording::From::newest);
  const GrowingRecording::Piece piece = client.recording->next(longest_piece);
  const nlohmann::json head{
      {"recording_bytes", piece.bytes.size()}, {"begins", piece.begins}, {"more", piece.more}};
  client.waiting += text_of(head) + '\n' + piece.bytes;
  return !piece.bytes.empty();
}

/// The end, and what it has not seen of the recording.
void Monitor::say_goodbye(Client& client) {
  client.waiting += "{\"ended\":true}\n";
  deliver(client);
  bool more = client.recording != nullptr;
  while (more && client.waiting.empty() && !client.gone) {
    more = add_piece(client);
    deliver(client);
  }
}

void Monitor::drop_the_gone() {
  std::erase_if(clients_, [&](Client& client) {
    if (!client.gone) return false;
    hear_the_rest(client);
    if (client.owner && remote_ != nullptr) remote_->abandon();
    close(client.socket);
    return true;
  });
}

/// As much as there is room for.
void Monitor::deliver(Client& client) {
  const ssize_t count =
      send(client.socket, client.waiting.data(), client.waiting.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  client.gone = client.gone || (count < 0 && errno != EAGAIN && errno != EINTR);
  if (count <= 0) return;
  client.waiting.erase(0, static_cast<std::size_t>(count));
  client.took_ns = monotonic_ns();
}

/// Who has not taken the last line yet goes without this one, and who takes nothing at all is dropped.
void Monitor::send_to_all() {
  std::string line;
  if (remote_ != nullptr && !clients_.empty()) remote_->show_recording();
  for (Client& client : clients_) {
    if (!client.waiting.empty()) {
      client.gone = client.gone || monotonic_ns() - client.took_ns > client_patience_ns;
      client.missed_a_line = true;
      continue;
    }
    if (line.empty()) line = snapshot() + '\n';
    client.waiting = line;
    client.took_ns = monotonic_ns();
    deliver(client);
  }
  drop_the_gone();
}

std::string Monitor::snapshot() const {
  using nlohmann::json;
  json subsystems = json::array(), channels = json::array();
  for (std::uint32_t instance = 0; instance < assembly_.executors.size(); ++instance) {
    const SubsystemExecutor& executor = *assembly_.executors[instance];
    const Gauges& gauges = executor.gauges();
    const Instance& tables = assembly_.system.instances[instance];
    const auto load = [](const auto& value) { return value.load(std::memory_order_relaxed); };
    const bool called = load(gauges.called_at_ns) >= 0;
    json one{{"path", executor.path()},
             {"behaviour", nullptr},
             {"calling", load(gauges.calling)},
             {"ended", assembly_.control.has_ended(instance)},
             {"iterations", load(gauges.iterations)},
             {"firings", load(gauges.firings)},
             {"overruns", load(gauges.overruns)},
             {"errors", load(gauges.errors)},
             {"period_s", seconds_of(tables.period.count())},
             {"called_at_s", seconds_of(load(gauges.called_at_ns))},
             {"call_s", seconds_of(load(gauges.call_ns))},
             {"longest_call_s", seconds_of(load(gauges.longest_call_ns))}};
    if (called) one["behaviour"] = tables.net->behaviours[load(gauges.behaviour)].name;
    subsystems.push_back(std::move(one));
  }
  for (std::size_t index = 0; index < assembly_.channels.size(); ++index) {
    const Channel& channel = assembly_.system.channels[index];
    json marked = json::array();
    const std::uint16_t marking = assembly_.channels[index]->marking();
    for (std::size_t place = 0; place < channel.places.size(); ++place)
      if ((marking >> place & 1U) != 0) marked.push_back(channel.places[place].name);
    channels.push_back({{"name", channel.name}, {"marked", std::move(marked)}});
  }
  json all{{"system", assembly_.system.name},
           {"pid", getpid()},
           {"net_hash", assembly_.system.net_hash},
           {"time_s", seconds_of(clock_.now().time_since_epoch().count())},
           {"subsystems", std::move(subsystems)},
           {"channels", std::move(channels)}};
  if (assembly_.control.emergency()) all["emergency"] = assembly_.control.emergency_reason();
  if (!recording_path_.empty()) all["recording"] = recording_path_;
  if (remote_ == nullptr) return text_of(all);
  const RemoteControl::Shown shown = remote_->shown();
  all["paused"] = shown.paused;
  all["pauses"] = shown.pauses;
  all["speed"] = shown.speed;
  all["broke_at"] = shown.broke_at;
  return text_of(all);
}

}  // namespace tessera
