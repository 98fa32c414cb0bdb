#include "served.hpp"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <fstream>

#include "../schema/judge.hpp"
#include "../scratch.hpp"

namespace tessera::server_test {

namespace {

constexpr int patience_ms = 60'000;
constexpr std::chrono::minutes longest_wait{4};  // in it a controller is built, on a busy machine

/// The next part; empty: there is none.
std::string receive_some(int socket) {
  pollfd source{.fd = socket, .events = POLLIN, .revents = 0};
  if (poll(&source, 1, patience_ms) <= 0) return {};
  std::array<char, 65536> bytes{};
  const ssize_t count = recv(socket, bytes.data(), bytes.size(), 0);
  return count <= 0 ? std::string() : std::string(bytes.data(), static_cast<std::size_t>(count));
}

}  // namespace

void write(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
}

int connect_to(int port) {
  const int made = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connect(made, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return made;
  close(made);
  return -1;
}

bool send_all(int socket, const std::string& bytes) {
  for (std::size_t sent = 0; sent < bytes.size();) {
    const ssize_t count = send(socket, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (count <= 0) return false;
    sent += static_cast<std::size_t>(count);
  }
  return true;
}

std::string receive_all(int socket) {
  std::string all;
  for (std::string some = receive_some(socket); !some.empty(); some = receive_some(socket)) all += some;
  return all;
}

EventStream::EventStream(int port, const std::string& token) : socket_(connect_to(port)) {
  send_all(socket_, "GET /api/events?token=" + token +
                        " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) + "\r\n\r\n");
}

EventStream::~EventStream() { close(socket_); }

std::optional<std::string> EventStream::line() {
  for (;;) {
    if (const std::size_t end = bytes_.find('\n'); end != std::string::npos) {
      std::string one = bytes_.substr(0, end);
      bytes_.erase(0, end + 1);
      return one;
    }
    const std::string some = receive_some(socket_);
    if (some.empty()) return std::nullopt;
    bytes_ += some;
  }
}

nlohmann::json EventStream::next(const std::string& name,
                                 const std::function<bool(const nlohmann::json&)>& wanted) {
  std::string named;
  const auto end = std::chrono::steady_clock::now() + longest_wait;
  while (const std::optional<std::string> one = line()) {
    if (std::chrono::steady_clock::now() > end) break;
    if (one->starts_with("event: ")) named = one->substr(7);
    if (!one->starts_with("data: ")) continue;
    nlohmann::json data = nlohmann::json::parse(one->substr(6), nullptr, false);
    schema_test::judge_event(named, data);
    if (named == name && (!wanted || wanted(data))) return data;
  }
  return nullptr;
}

void mirror(const fs::path& from, const fs::path& to) {
  const auto is_ours = [](const fs::path& path) { return path.filename() == ".tessera"; };
  fs::create_directories(to);
  for (const auto& entry : fs::directory_iterator(to))
    if (!is_ours(entry.path()) && !fs::exists(from / entry.path().filename())) fs::remove_all(entry.path());
  for (const auto& entry : fs::directory_iterator(from)) {
    const fs::path copy = to / entry.path().filename();
    if (is_ours(copy)) continue;
    if (entry.is_directory())
      mirror(entry.path(), copy);
    else if (const std::string text = content_of(entry.path()); !fs::exists(copy) || content_of(copy) != text)
      write(copy, text);
  }
}

Served::Served(fs::path folder) : folder_(std::move(folder)) {
  mirror(fs::path(TESSERA_SOURCE_DIR) / "examples/01_line_follower", folder_ / "project");
  options_.spec = fs::canonical(spec());
  options_.port = 0;
  options_.page = folder_ / "page";
  options_.share = fs::path(TESSERA_SOURCE_DIR) / "share/tessera";
  options_.version = "test";
  options_.command = TESSERA_BINARY_DIR "/tessera";
  // A test has nothing to do with what Tessera keeps for the user who runs it.
  setenv("XDG_STATE_HOME", (folder_ / "user").c_str(), 1);
}

Served::~Served() {
  studio_.reset();
  if (!keep_) remove_scratch(folder_);
}

void Served::serve() {
  studio_ = std::make_unique<server::Studio>(options_);
  port_ = studio_->port();
  token_ = studio_->token();
}

Reply Served::ask(const std::string& method, const std::string& path, const std::string& body) const {
  return ask_with(own_headers(), method, path, body);
}

Reply Served::ask_with(const Headers& headers, const std::string& method, const std::string& path,
                       const std::string& body) const {
  std::string request = method + " " + path + " HTTP/1.1\r\n";
  for (const auto& [name, value] : headers) request += name + ": " + value + "\r\n";
  if (!body.empty()) request += "Content-Length: " + std::to_string(body.size()) + "\r\n";
  const int socket = connect_to(port_);
  send_all(socket, request + "\r\n" + body);
  const std::string all = receive_all(socket);
  close(socket);
  Reply reply;
  const std::size_t end = all.find("\r\n\r\n");
  if (!all.starts_with("HTTP/1.1 ") || end == std::string::npos) return reply;
  reply.status = std::stoi(all.substr(9, 3));
  reply.body = all.substr(end + 4);
  for (std::size_t at = all.find("\r\n") + 2; at < end;) {
    const std::size_t colon = all.find(':', at), next = all.find("\r\n", at);
    reply.headers.emplace(all.substr(at, colon - at), all.substr(colon + 2, next - colon - 2));
    at = next + 2;
  }
  // A packed answer has the words of the one that is not.
  if (path.starts_with("/api/") && !reply.headers.contains("Content-Encoding"))
    schema_test::judge_exchange(method, path, body, reply.status, reply.body);
  return reply;
}

}  // namespace tessera::server_test
