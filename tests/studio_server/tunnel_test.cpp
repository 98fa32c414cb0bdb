#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include "running.hpp"

namespace tessera::server_test {

namespace {

constexpr const char* ssh_server = "/usr/sbin/sshd";

int free_port() {
  const int made = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* name = reinterpret_cast<sockaddr*>(&address);
  EXPECT_EQ(bind(made, name, size), 0);
  EXPECT_EQ(getsockname(made, name, &size), 0);
  close(made);
  return ntohs(address.sin_port);
}

}  // namespace

/// A robot that can be reached by SSH only: a server of our own, which lets in one key that is made for it.
class Tunnel : public RunOfTheStudio {
 protected:
  void make_key(const std::string& name) {
    const std::atomic<bool> never{false};
    const project::Exit exit = project::capture_apart(
        {"ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", (robot_ / name).string()}, never);
    ASSERT_EQ(exit.code, 0) << exit.text;
  }
  void start_server() {
    fs::create_directories(robot_);
    make_key("host");
    make_key("user");
    // Where the parts of the server that need no rights live. The system's service would make it.
    if (geteuid() == 0) fs::create_directories("/run/sshd");
    write(robot_ / "sshd.conf",
          "ListenAddress 127.0.0.1\nPidFile none\nUsePAM no\nStrictModes no\n"
          "PasswordAuthentication no\nKbdInteractiveAuthentication no\n"
          "PermitRootLogin prohibit-password\nAuthorizedKeysFile " +
              (robot_ / "user.pub").string() + "\n");
    for (bool listens = false; !listens;) {
      ssh_port_ = free_port();
      server_ = std::make_unique<Elsewhere>(
          project::Command{ssh_server, "-D", "-e", "-f", (robot_ / "sshd.conf").string(), "-h",
                           (robot_ / "host").string(), "-p", std::to_string(ssh_port_)});
      while (server_->runs() && !listens) {
        const int made = connect_to(ssh_port_);
        listens = made >= 0;
        if (listens) close(made);
      }
    }
  }
  [[nodiscard]] std::unique_ptr<Elsewhere> forward(const fs::path& from, const fs::path& to) const {
    return std::make_unique<Elsewhere>(project::Command{"ssh",
                                                        "-F",
                                                        "none",
                                                        "-i",
                                                        (robot_ / "user").string(),
                                                        "-p",
                                                        std::to_string(ssh_port_),
                                                        "-o",
                                                        "BatchMode=yes",
                                                        "-o",
                                                        "IdentitiesOnly=yes",
                                                        "-o",
                                                        "StrictHostKeyChecking=no",
                                                        "-o",
                                                        "UserKnownHostsFile=/dev/null",
                                                        "-o",
                                                        "ExitOnForwardFailure=yes",
                                                        "-NL",
                                                        to.string() + ":" + from.string(),
                                                        "127.0.0.1"});
  }

  const fs::path robot_ = folder_ / "robot";
  int ssh_port_ = 0;
  std::unique_ptr<Elsewhere> server_;
};

TEST_F(Tunnel, ShowsAControllerOfAnotherMachineAndSaysWhenTheConnectionIsLost) {
  if (!fs::exists(ssh_server)) GTEST_SKIP() << "needs openssh-server (scripts/dependencies test)";
  start_server();
  fs::copy(folder_ / "project", robot_ / "project", fs::copy_options::recursive);
  const fs::path recording = robot_ / "project/.tessera/last/recording.tsr";
  Elsewhere controller({"env", "XDG_RUNTIME_DIR=" + robot_.string(), TESSERA_BINARY_DIR "/tessera", "run",
                        (robot_ / "project").string(), "--world", "--record-limit", "30kBx3"});
  const auto its_socket = [&]() -> fs::path {
    std::error_code not_yet;
    for (const auto& entry : fs::directory_iterator(robot_ / "tessera", not_yet)) return entry.path();
    return {};
  };
  while (its_socket().empty()) ASSERT_TRUE(controller.runs());

  fs::create_directories(folder_ / "tessera");
  fs::permissions(folder_ / "tessera", fs::perms::owner_all);
  const std::unique_ptr<Elsewhere> ssh = forward(its_socket(), folder_ / "tessera/robot.sock");
  EXPECT_EQ(await_controller(), "robot.sock");
  const std::string run = start({{"kind", "attach"}, {"socket", "robot.sock"}});
  EXPECT_FALSE(events_->next("firings").at("firings").empty());
  EXPECT_FALSE(events_->next("values").at("values").empty());
  EXPECT_FALSE(events_->next("subsystems").at("subsystems").empty());
  while (!info(run).at("values").contains("robot.control.motion"))
    ASSERT_EQ(info(run).at("state"), "running");
  EXPECT_FALSE(info(run).at("marking").empty());
  const std::int64_t before = info(run).at("t");
  while (info(run).at("t") < before + 3'000'000'000) ASSERT_EQ(info(run).at("state"), "running");

  static_cast<void>(ssh->stop());
  EXPECT_THAT(await_state(run, "failed").at("why").get<std::string>(),
              HasSubstr("connection to the controller is lost"));
  // It has not even noticed.
  const auto written = [&] { return fs::last_write_time(recording); };
  const auto then = written();
  while (written() == then) ASSERT_TRUE(controller.runs());
  EXPECT_THAT(controller.stop(), HasSubstr("SIGINT"));
}

}  // namespace tessera::server_test
