#include "project/process/control_connection.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tessera::project {
namespace {

namespace fs = std::filesystem;
using Received = ControlConnection::Received;

/// A folder with the socket of a controller.
class Connection : public testing::Test {
 protected:
  Connection() : folder_(fs::temp_directory_path() / ("tessera.connection." + std::to_string(getpid()))) {
    fs::create_directories(folder_);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, file().c_str(), file().native().size() + 1);
    listening_ = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    EXPECT_EQ(bind(listening_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(listen(listening_, 1), 0);
  }
  ~Connection() override {
    close(listening_);
    fs::remove_all(folder_);
  }
  [[nodiscard]] fs::path file() const { return folder_ / "robot.1.sock"; }

  fs::path folder_;
  int listening_ = -1;
};

TEST_F(Connection, CarriesWhatBothSay) {
  const std::optional<ControlConnection> client = ControlConnection::to(file());
  ASSERT_TRUE(client);
  const int controller = accept(listening_, nullptr, nullptr);
  ControlReader heard;
  EXPECT_EQ(client->receive_at_once(heard), Received::nothing);
  client->limit_waits(std::chrono::milliseconds(10));
  EXPECT_EQ(client->receive(heard), Received::nothing) << "the wait has a limit";

  EXPECT_EQ(send(controller, "{}\n", 3, 0), 3);
  EXPECT_EQ(client->receive(heard), Received::bytes);
  EXPECT_EQ(send(controller, "[]\n", 3, 0), 3);
  client->wait(std::chrono::seconds(10));
  EXPECT_EQ(client->receive_at_once(heard), Received::bytes);
  EXPECT_EQ(heard.next().value().line, "{}");
  EXPECT_EQ(heard.next().value().line, "[]");
  EXPECT_FALSE(heard.next());

  EXPECT_TRUE(client->send("reset\n"));
  std::array<char, 16> asked{};
  EXPECT_EQ(recv(controller, asked.data(), asked.size(), 0), 6);
  EXPECT_TRUE(client->is_process(getpid()));
  EXPECT_FALSE(client->is_process(1));

  close(controller);
  EXPECT_EQ(client->receive(heard), Received::over);
  EXPECT_EQ(client->receive_at_once(heard), Received::over);
  EXPECT_FALSE(client->send("reset\n"));
}

TEST_F(Connection, GivesUpOnAControllerThatTakesNothing) {
  const std::optional<ControlConnection> client = ControlConnection::to(file());
  ASSERT_TRUE(client);
  client->limit_waits(std::chrono::milliseconds(10));
  EXPECT_FALSE(client->send(std::string(std::size_t{16} << 20U, ' ')));
}

TEST_F(Connection, NeedsAProcessThatListens) {
  std::ofstream(folder_ / "a.2.sock") << "no socket";
  std::ofstream(folder_ / "b.txt") << "something else";
  EXPECT_EQ(control_sockets(folder_), (std::vector<fs::path>{folder_ / "a.2.sock", file()}));
  EXPECT_TRUE(control_sockets(folder_ / "nowhere").empty());
  EXPECT_FALSE(ControlConnection::to(folder_ / "a.2.sock"));
  EXPECT_FALSE(ControlConnection::to(folder_ / "missing.sock"));
  EXPECT_FALSE(ControlConnection::to(folder_ / std::string(200, 'x')));
  EXPECT_TRUE(ControlConnection::to(file()));
  close(std::exchange(listening_, -1));
  EXPECT_FALSE(ControlConnection::to(file())) << "left behind";
}

TEST_F(Connection, KnowsAProcessThatTakesNoConnectionFromOneThatIsGone) {
  std::vector<ControlConnection> taken;
  for (;;) {
    ControlConnection::Attempt made = ControlConnection::attempt(file());
    EXPECT_TRUE(made.may_listen);
    if (!made.connection) break;  // the queue is full: as of a process that is stopped
    taken.push_back(std::move(*made.connection));
    ASSERT_LT(taken.size(), 10U);
  }
  close(std::exchange(listening_, -1));
  EXPECT_FALSE(ControlConnection::attempt(file()).may_listen);
  EXPECT_FALSE(ControlConnection::attempt(folder_ / "missing.sock").may_listen);
}

}  // namespace
}  // namespace tessera::project
