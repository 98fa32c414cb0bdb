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
    // A folder for the parts of the server that run without rights. The system's service would make it.
    if (geteuid() == 0) fs::create_directories("/run/sshd");
    write(robot_ / "sshd.conf",
          "ListenAddress 127.0.0.1\nPidFile none\nUsePAM no\nStrictModes no\n"
          "PasswordAuthentication no\nKbdInteractiveAuthentication no\n"
          "PermitRootLogin prohibit-password\nAuthorizedKeysFile " +
              (robot_ / "user.pub").string() + "\n");
    bool listens = false;
    for (int tries = 0; tries < 5 && !listens; ++tries) {
      ssh_port_ = free_port();
      server_ = std::make_unique<Elsewhere>(
          project::Command{ssh_server, "-D", "-e", "-f", (robot_ / "sshd.conf").string(), "-h",
                           (robot_ / "host").string(), "-p", std::to_string(ssh_port_)});
      // Another program may have taken the port meanwhile: then the server ends, and another port is tried.
      listens = eventually(
          [&] {
            const int made = connect_to(ssh_port_);
            if (made >= 0) close(made);
            return made >= 0;
          },
          [&] { return !server_->runs(); });
    }
    ASSERT_TRUE(listens);
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

  const fs::path robot_ = sockets_ / "robot";  // with a short name: there are sockets in it
  int ssh_port_ = 0;
  std::unique_ptr<Elsewhere> server_;
};

TEST_F(Tunnel, ShowsAControllerOfAnotherMachineAndSaysWhenTheConnectionIsLost) {
  if (!fs::exists(ssh_server)) GTEST_SKIP() << "needs openssh-server (scripts/dependencies test)";
  start_server();
  const fs::path recording = folder_ / "project/.tessera/last/recording.tsr";
  Elsewhere controller({"env", "XDG_RUNTIME_DIR=" + robot_.string(), TESSERA_BINARY_DIR "/tessera", "run",
                        (folder_ / "project").string(), "--world", "--record-limit", "30kBx3"});
  const auto its_socket = [&]() -> fs::path {
    std::error_code not_yet;
    for (const auto& entry : fs::directory_iterator(robot_ / "tessera", not_yet)) return entry.path();
    return {};
  };
  ASSERT_TRUE(eventually([&] { return !its_socket().empty(); }, [&] { return !controller.runs(); }));

  const std::unique_ptr<Elsewhere> ssh = forward(its_socket(), sockets_ / "tessera/robot.sock");
  EXPECT_EQ(await_controller(), "robot.sock");
  const std::string run = start({{"kind", "attach"}, {"socket", "robot.sock"}});
  EXPECT_FALSE(
      events_->next("firings", [](const json& data) { return !data.at("firings").empty(); }).is_null());
  EXPECT_FALSE(
      events_->next("values", [](const json& data) { return !data.at("values").empty(); }).is_null());
  EXPECT_FALSE(events_->next("subsystems").at("subsystems").empty());
  const json seen = await_info(run, [](const json& now) {
    return now.at("values").contains("robot.control.motion") && !now.at("marking").empty() &&
           !now.at("scene").is_null() && !now.at("poses").is_null();
  });
  ASSERT_FALSE(seen.is_null());
  EXPECT_FALSE(events_->next("poses").at("frame").get<std::string>().empty());
  const std::string hash = seen.at("scene").at("hash");
  ASSERT_TRUE(eventually([&] { return get("/api/scenes/" + hash + ".glb").status == 200; },
                         [&] { return !controller.runs(); }))
      << "the scene comes through the tunnel";
  const std::int64_t before = seen.at("t");
  ASSERT_FALSE(
      await_info(run, [&](const json& now) { return now.at("t") > before + 3'000'000'000; }).is_null());

  static_cast<void>(ssh->stop());
  EXPECT_THAT(await_state(run, "failed").at("why").get<std::string>(),
              HasSubstr("connection to the controller is lost"));
  // It has not even noticed.
  const auto written = [&] { return fs::last_write_time(recording); };
  const auto then = written();
  ASSERT_TRUE(eventually([&] { return written() != then; }, [&] { return !controller.runs(); }));
  EXPECT_THAT(controller.stop(), HasSubstr("SIGINT"));
}

}  // namespace tessera::server_test
