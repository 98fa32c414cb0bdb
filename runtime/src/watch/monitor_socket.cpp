#include "watch/monitor_socket.hpp"

#include <fmt/core.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "tessera/monitor.hpp"

namespace tessera {
namespace {

/// The hint for a folder that another user may have made before.
constexpr const char* remedy = "remove it, or set XDG_RUNTIME_DIR to a folder of your own";

/// The folder must belong to us alone: that of another user could be a trap. nullopt: it does, or there is none.
[[nodiscard]] std::optional<Problem> wrong_with(const std::string& folder) {
  struct stat status {};
  if (lstat(folder.c_str(), &status) != 0) {
    if (errno == ENOENT) return std::nullopt;
    return Problem{fmt::format("cannot look at '{}': {}", folder, std::strerror(errno))};
  }
  const auto because = [&](const std::string& what) {
    return Problem{fmt::format("'{}' {}: {}", folder, what, remedy)};
  };
  if (S_ISLNK(status.st_mode)) return because("is a link");
  if (!S_ISDIR(status.st_mode)) return because("is no folder");
  if (status.st_uid != geteuid())
    return because(fmt::format("belongs to another user (number {})", status.st_uid));
  if ((status.st_mode & 077U) != 0) return because("may be entered by other users");
  return std::nullopt;
}

[[nodiscard]] std::optional<Problem> make_own_folder(const std::string& folder) {
  if (mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST)
    return Problem{fmt::format("cannot make '{}': {}; set XDG_RUNTIME_DIR to a folder of your own", folder,
                               std::strerror(errno))};
  return wrong_with(folder);
}

[[nodiscard]] bool is_owner(int client) {
  ucred peer{};
  socklen_t size = sizeof peer;
  return getsockopt(client, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 &&
         (peer.uid == geteuid() || peer.uid == 0);
}

/// Whether the process that made the socket was killed: it is gone, and no other program (through a tunnel,
/// from a container) listens.
[[nodiscard]] bool is_left_behind(const std::filesystem::path& file) {
  const std::string name = file.stem().string();  // NAME.PID
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

namespace {

/// Clients that come and go while the process is stopped fill the queue. It must have room for a command then.
constexpr int longest_queue = 128;
constexpr std::size_t longest_path = sizeof(sockaddr_un::sun_path) - 1;

/// FNV-1a.
std::string hash_of(std::string_view name) {
  std::uint32_t hash = 0x811c9dc5U;
  for (const char letter : name) hash = (hash ^ static_cast<unsigned char>(letter)) * 0x01000193U;
  return fmt::format("{:08x}", hash);
}

}  // namespace

std::string monitor_folder() {
  // The shortest file: four letters, the hash, the number of a process, ".sock".
  constexpr std::size_t least_room = sizeof "/abcd~01234567.4194304.sock" - 1;
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  if (runtime != nullptr && *runtime != '\0')
    if (std::string folder = std::string(runtime) + "/tessera"; folder.size() + least_room <= longest_path)
      return folder;
  return fmt::format("/tmp/tessera-{}", geteuid());
}

std::optional<Problem> wrong_with_monitor_folder() {
  const std::string folder = monitor_folder();
  if (std::optional<Problem> wrong = wrong_with(folder)) return wrong;
  const std::string above = folder.substr(0, folder.rfind('/'));
  if (access(folder.c_str(), R_OK | X_OK) == 0 || access(above.c_str(), W_OK | X_OK) == 0)
    return std::nullopt;
  return Problem{fmt::format("'{}' cannot be made: {}; set XDG_RUNTIME_DIR to a folder of your own", folder,
                             std::strerror(errno))};
}

std::string monitor_file(std::string_view name, std::int64_t process) {
  const std::string begin = monitor_folder() + "/", end = fmt::format(".{}.sock", process);
  const std::size_t room = longest_path - begin.size() - end.size();
  if (name.size() <= room) return begin + std::string(name) + end;
  const std::string hash = cut_off_name + hash_of(name);
  return begin + std::string(name.substr(0, room - hash.size())) + hash + end;
}

MonitorSocket::MonitorSocket(std::string_view name) { listen(name); }

MonitorSocket::~MonitorSocket() {
  if (descriptor_ < 0) return;
  close(descriptor_);
  unlink(file_.c_str());
}

void MonitorSocket::listen(std::string_view name) {
  const std::string folder = monitor_folder();
  failure_ = make_own_folder(folder);
  if (failure_) return;
  remove_left_behind(folder);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string file = monitor_file(name, getpid());
  std::memcpy(address.sun_path, file.c_str(), file.size() + 1);
  unlink(file.c_str());  // left by an earlier process with our number
  const int descriptor = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const auto* own = reinterpret_cast<const sockaddr*>(&address);
  if (descriptor < 0 || bind(descriptor, own, sizeof address) != 0 ||
      ::listen(descriptor, longest_queue) != 0) {
    failure_ = Problem{fmt::format("cannot listen at '{}': {}", file, std::strerror(errno))};
    if (descriptor >= 0) close(descriptor);
    return;
  }
  chmod(file.c_str(), 0600);
  file_ = file;
  descriptor_ = descriptor;
}

MonitorSocket::Accepted MonitorSocket::accept() const {
  const int client = accept4(descriptor_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (client < 0) return {-1, errno != EAGAIN && errno != EINTR && errno != ECONNABORTED};
  if (is_owner(client)) return {client, false};
  close(client);
  return {};
}

}  // namespace tessera
