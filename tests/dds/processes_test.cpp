#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <spawn.h>
#include <sys/wait.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <thread>

#include "network/dds/carrier.hpp"
#include "tests/dds/crossing.hpp"
#include "tests/dds/heard.hpp"

/// Carriers in processes of their own.
namespace tessera::test {
namespace {

using dds::DdsCarrier;

/// A program that is killed with its object, unless it has ended.
class Child {
 public:
  explicit Child(const std::vector<std::string>& command) {
    std::vector<char*> arguments;
    for (const std::string& one : command) arguments.push_back(const_cast<char*>(one.c_str()));
    arguments.push_back(nullptr);
    if (posix_spawnp(&process_, arguments[0], nullptr, nullptr, arguments.data(), environ) != 0) process_ = 0;
  }
  ~Child() { kill(); }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  void kill() {
    if (process_ == 0) return;
    ::kill(process_, SIGKILL);
    (void)exit_code();
  }
  void signal(int number) const { ::kill(process_, number); }
  [[nodiscard]] int exit_code() {
    int status = -1;
    if (process_ != 0) waitpid(process_, &status, 0);
    process_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t process_ = 0;
};

std::vector<std::string> station(const std::string& role, const Crossing& crossing, int incarnation,
                                 const std::string& interface = "lo",
                                 const std::vector<std::string>& peers = {}) {
  std::vector<std::string> command{TESSERA_DDS_STATION, role, std::to_string(crossing.domain),
                                   std::to_string(incarnation), interface};
  command.insert(command.end(), peers.begin(), peers.end());
  return command;
}

TEST(Processes, AKilledOrStoppedProcessIsNotReachableAndItsNextIncarnationIs) {
  const Crossing crossing;
  DdsCarrier carrier(crossing.setup(Crossing::office, 10));
  Station office(carrier);
  Child first(station("stay", crossing, 20));
  ASSERT_TRUE(receive_until([&] { return office.heard.sees(Crossing::cart); }, office));
  first.kill();
  const auto killed = std::chrono::steady_clock::now();
  ASSERT_TRUE(receive_until([&] { return !office.heard.sees(Crossing::cart); }, office));
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - killed;
  std::printf("not reachable %.3f s after it was killed\n", time.count());
  Child second(station("stay", crossing, 21));
  ASSERT_TRUE(receive_until([&] { return office.heard.sees(Crossing::cart); }, office));
  second.signal(SIGSTOP);
  ASSERT_TRUE(receive_until([&] { return !office.heard.sees(Crossing::cart); }, office));
  second.signal(SIGCONT);
  ASSERT_TRUE(receive_until([&] { return office.heard.sees(Crossing::cart); }, office));
  second.kill();
  ASSERT_TRUE(receive_until([&] { return !office.heard.sees(Crossing::cart); }, office));
  EXPECT_TRUE(office.heard.complaints.empty());
  Child older(station("stay", crossing, 19));
  EXPECT_TRUE(receive_until([&] { return office.heard.has_complaint("its clock was set back"); }, office));
  EXPECT_FALSE(office.heard.sees(Crossing::cart));
}

/// Two networks with one cable between them. Every tenth packet that arrives is lost.
class Networks : public testing::Test {
 protected:
  void SetUp() override {
    const std::string name = "tessera" + std::to_string(getpid());
    a_ = name + "a";
    b_ = name + "b";
    if (geteuid() != 0) GTEST_SKIP() << "only root may make network namespaces";
    if (!run("ip netns add " + a_ + " && ip netns add " + b_))
      GTEST_SKIP() << "network namespaces cannot be made here (package iproute2, a kernel that has them)";
    ASSERT_TRUE(run("ip -n " + a_ + " link add cable type veth peer name cable netns " + b_));
    for (const auto& [space, address] : {std::pair(a_, "10.77.0.1/24"), std::pair(b_, "10.77.0.2/24")}) {
      ASSERT_TRUE(run("ip -n " + space + " addr add " + address + " dev cable && ip -n " + space +
                      " link set cable up && ip -n " + space + " link set lo up"));
    }
  }
  void TearDown() override {
    if (geteuid() == 0) (void)run("ip netns del " + a_ + "; ip netns del " + b_);
  }
  [[nodiscard]] bool lose_every_tenth_packet() const {
    for (const std::string& space : {a_, b_})
      if (!run("ip netns exec " + space +
               " nft 'add table ip t; add chain ip t in { type filter hook prerouting priority 0; }; "
               "add rule ip t in iifname cable numgen random mod 100 < 10 counter drop'"))
        return false;
    return true;
  }
  [[nodiscard]] static bool run(const std::string& command) {
    return std::system(("{ " + command + "; } >/dev/null 2>&1").c_str()) == 0;
  }
  [[nodiscard]] static std::vector<std::string> in(const std::string& space,
                                                   const std::vector<std::string>& command) {
    std::vector<std::string> whole{"ip", "netns", "exec", space};
    whole.insert(whole.end(), command.begin(), command.end());
    return whole;
  }
  std::string a_, b_;
  Crossing crossing_;
};

TEST_F(Networks, BlockingTransfersSurviveLoss) {
  if (!lose_every_tenth_packet()) GTEST_SKIP() << "packets cannot be lost here (package nftables)";
  Child reader(in(b_, station("read", crossing_, 20, "cable", {"10.77.0.1"})));
  Child sender(in(a_, station("send", crossing_, 10, "10.77.0.1", {"10.77.0.2"})));
  EXPECT_EQ(sender.exit_code(), 0);
  EXPECT_EQ(reader.exit_code(), 0);
}

/// Runs it in a network namespace; its threads stay there.
void in_namespace(const std::string& name, const std::function<void()>& what) {
  std::thread([&] {
    const int space = open(("/var/run/netns/" + name).c_str(), O_RDONLY | O_CLOEXEC);
    if (space >= 0 && setns(space, CLONE_NEWNET) == 0) what();
    close(space);
  }).join();
}

TEST_F(Networks, APeerWithoutAnAddressIsFoundWhenItHasOne) {
  const auto known = std::make_shared<std::atomic<bool>>(false);
  const dds::AddressOf name_service = [known](const std::string& host, std::string& why) {
    if (host != "late.local") return std::optional(host);
    why = "not known yet";
    return *known ? std::optional<std::string>("10.77.0.2") : std::nullopt;
  };
  Crossing there = crossing_;
  crossing_.interface = there.interface = "cable";
  crossing_.peers = {"late.local"};
  there.peers = {"10.77.0.9"};  // it does not look for the first
  std::unique_ptr<dds::DdsCarrier> one, other;
  in_namespace(a_, [&] {
    one = std::make_unique<dds::DdsCarrier>(crossing_.setup(Crossing::office, 10), name_service,
                                            std::chrono::milliseconds(20));
  });
  in_namespace(b_, [&] { other = std::make_unique<dds::DdsCarrier>(there.setup(Crossing::cart, 20)); });
  ASSERT_TRUE(one && other);
  Station office(*one), cart(*other);
  EXPECT_TRUE(receive_until(
      [&] { return office.heard.has_complaint("peer late.local has no IPv4 address (not known yet)"); },
      office, cart));
  EXPECT_FALSE(office.heard.sees(Crossing::cart));
  *known = true;
  // The thread that makes the wider domain is to be in that network.
  in_namespace(a_, [&] {
    EXPECT_TRUE(
        receive_until([&] { return office.heard.sees(Crossing::cart) && cart.heard.sees(Crossing::office); },
                      office, cart));
  });
  EXPECT_TRUE(office.heard.has_complaint("peer late.local has an address now: 10.77.0.2"));
}

TEST_F(Networks, ACarrierOnLoopbackHearsNobodyElse) {
  // In b, a cart that looks for the office in a. There, one office hears loopback only, and one hears the cable.
  Child cart(in(b_, station("stay", crossing_, 20, "cable", {"10.77.0.1"})));
  std::string outputs;
  for (const char* interface : {"lo", "cable"}) {
    const std::vector<std::string> command =
        in(a_, station("listen", crossing_, 10, interface,
                       interface == std::string("lo") ? std::vector<std::string>{}
                                                      : std::vector<std::string>{"10.77.0.2"}));
    std::string line;
    for (const std::string& word : command) line += word + " ";
    std::FILE* pipe = popen(line.c_str(), "r");
    ASSERT_NE(pipe, nullptr);
    std::string text(64, '\0');
    text.resize(std::fread(text.data(), 1, text.size(), pipe));
    pclose(pipe);
    outputs += text;
  }
  EXPECT_EQ(outputs, "silence\nheard\n");
}

}  // namespace
}  // namespace tessera::test
