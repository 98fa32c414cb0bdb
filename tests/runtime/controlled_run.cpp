#include "controlled_run.hpp"

#include <fcntl.h>
#include <linux/sockios.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>

#include "../eventually.hpp"
#include "../schema/judge.hpp"
#include "nets.hpp"
#include "run/summary_text.hpp"
#include "tessera/monitor.hpp"
#include "tessera/recording.hpp"

namespace tessera::testing {

using nlohmann::json;

std::size_t firings_in(const std::string& file) {
  std::string error;
  const std::optional<Recording> recording = read_recording(file, error);
  std::size_t count = 0;
  if (recording)
    for (const Recording::Entry& entry : recording->entries)
      count += entry.event.kind() == Event::Kind::firing ? 1U : 0U;
  return count;
}

Controlled::Controlled() {
  // Not scratch_file: its names are too long for a socket.
  folder_ = std::filesystem::temp_directory_path() / ("tessera." + std::to_string(getpid()));
  std::filesystem::remove_all(folder_);
  std::filesystem::create_directories(folder_);
  setenv("XDG_RUNTIME_DIR", folder_.c_str(), 1);
  options_.duration = std::chrono::seconds(1);
  options_.monitor = true;
  options_.paused = true;
  options_.speed = 0;
  options_.recording = scratch_file("controlled");
}

Controlled::~Controlled() {
  if (socket_ >= 0) close(socket_);
  if (running_.joinable()) running_.join();
  std::filesystem::remove_all(folder_);
}

void Controlled::build(TestSystem& system) {
  const std::uint32_t a = system.add("robot.a", nets::async_sender, {}, std::chrono::milliseconds(10));
  const std::uint32_t b = system.add("robot.b", nets::async_receiver, {}, std::chrono::milliseconds(20));
  system.connect(a, "x", b, "x", asynchronous);
}

void Controlled::start() {
  build_(system_);
  made_ = &system_.system();
  running_ = std::thread([this] {
    std::string error;
    summary_ = execute(*made_, options_, error).value_or(RunSummary{});
    over_ = true;
  });
  const auto connected = [&] { return (socket_ = connect_another()) >= 0; };
  ASSERT_TRUE(eventually(connected, [&] { return over_.load(); })) << summary_.ended;
  fcntl(socket_, F_SETFL, 0);  // blocking
}

int Controlled::connect_another() const {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string file = monitor_file(made_->name, getpid());
  std::memcpy(address.sun_path, file.c_str(), file.size() + 1);
  const int client = socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0);
  if (connect(client, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return client;
  close(client);
  return -1;
}

void Controlled::send_line(const std::string& line) const {
  const std::string whole = line + "\n";
  send(socket_, whole.data(), whole.size(), MSG_NOSIGNAL);
}

bool Controlled::has_read_all() const {
  int unread = -1;
  return ioctl(socket_, SIOCOUTQ, &unread) == 0 && unread == 0;
}

bool Controlled::receive() {
  char bytes[65536];
  const ssize_t count = recv(socket_, bytes, sizeof bytes, 0);
  if (count > 0) received_.append(bytes, static_cast<std::size_t>(count));
  return count > 0;
}

json Controlled::await(const std::function<bool(const json&)>& wanted) {
  for (;;) {
    const std::size_t end = received_.find('\n');
    if (end == std::string::npos) {
      if (!receive()) return nullptr;
      continue;
    }
    const json line = json::parse(received_.substr(0, end), nullptr, false);
    received_.erase(0, end + 1);
    schema_test::judge_line(line);
    if (wanted(line)) return line;
  }
}

/// The bytes of the recording that come next.
std::string Controlled::next_piece() {
  const json head = await([](const json& line) { return line.contains("recording_bytes"); });
  if (head.is_null()) return "";
  more_ = head.at("more");
  const std::size_t size = head.at("recording_bytes");
  EXPECT_LE(size, longest_piece);
  while (received_.size() < size && receive()) continue;
  std::string bytes = received_.substr(0, size);
  received_.erase(0, size);
  return bytes;
}

std::string Controlled::piece() {
  send_line("{\"command\":\"recording\"}");
  return next_piece();
}

std::string Controlled::what_comes_at_the_end() {
  EXPECT_FALSE(await([](const json& line) { return line.contains("ended"); }).is_null());
  std::string bytes;
  for (std::string some = next_piece(); !some.empty(); some = next_piece()) bytes += some;
  return bytes;
}

std::string Controlled::command(json what) {
  what["id"] = ++last_;
  send_line(what.dump());
  std::string wrong =
      await([&](const json& answer) { return answer.value("answer", 0) == last_; }).value("error", "none");
  if (wrong.empty()) schema_test::judge_command(what);
  return wrong;
}

json Controlled::rest(std::uint64_t pauses) {
  return await(
      [&](const json& line) { return line.value("paused", false) && line.value("pauses", 0U) >= pauses; });
}

void Controlled::finish() {
  EXPECT_EQ(command({{"command", "resume"}}), "");
  running_.join();
  schema_test::judge_summary(json::parse(summary_json(summary_, options_)));
}

}  // namespace tessera::testing
