// The other side is a process that was killed: DDS takes it for alive for some seconds.
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "eventually.hpp"
#include "fast_peer.hpp"
#include "ros2/dds/endpoint.hpp"
#include "service_sides.hpp"

extern char** environ;

namespace tessera::ros2 {
namespace {

constexpr const char* domain_variable = "TESSERA_TEST_KILLED_PEER";
constexpr std::size_t topics = 12;
constexpr std::array<std::byte, 12> message{std::byte{0}, std::byte{1}};  // a float64 in XCDR1

std::vector<std::unique_ptr<Endpoint>> endpoints(std::uint32_t domain, bool write) {
  std::vector<std::unique_ptr<Endpoint>> made;
  for (std::size_t index = 0; index < topics; ++index) {
    EndpointSetup setup;
    setup.path = "robot.base.speed";
    setup.topic = "/speed" + std::to_string(index);
    setup.dds_topic = "rt" + setup.topic;
    setup.dds_type = "std_msgs::msg::dds_::Float64_";
    setup.node = "robot";
    setup.network = {.domain = domain, .interface = "lo"};
    made.push_back(std::make_unique<Endpoint>(setup, write));
  }
  return made;
}

TEST(KilledPeer, DISABLED_Subscribes) {
  const char* const domain = std::getenv(domain_variable);
  ASSERT_NE(domain, nullptr);
  const auto readers = endpoints(static_cast<std::uint32_t>(std::stoul(domain)), /*write=*/false);
  for (;;) pause();
}

TEST(KilledPeer, DISABLED_Serves) {
  const char* const domain = std::getenv(domain_variable);
  ASSERT_NE(domain, nullptr);
  fast::Peer peer(static_cast<std::uint32_t>(std::stoul(domain)));
  const char* const identity = "serviceid=01.0f.7;";
  ASSERT_NE(peer.reader<fast::SetBoolRequest>("rq/enableRequest", false, identity), nullptr);
  ASSERT_NE(peer.writer<fast::SetBoolResponse>("rr/enableReply", true, identity), nullptr);
  for (;;) pause();
}

/// A process that runs one of the tests above, until it is killed.
class Peer {
 public:
  Peer(std::string test, std::uint32_t domain) {
    std::array<std::string, 3> words{"/proc/self/exe", "--gtest_also_run_disabled_tests",
                                     "--gtest_filter=KilledPeer.DISABLED_" + std::move(test)};
    std::array<char*, 4> arguments{words[0].data(), words[1].data(), words[2].data(), nullptr};
    EXPECT_EQ(setenv(domain_variable, std::to_string(domain).c_str(), 1), 0);
    EXPECT_EQ(posix_spawn(&process_, arguments[0], nullptr, nullptr, arguments.data(), environ), 0);
  }
  ~Peer() { die(); }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;
  void die() {
    if (process_ <= 0) return;
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
    process_ = 0;
  }

 private:
  pid_t process_ = 0;
};

/// Cyclone DDS by itself waits up to 1 s for each writer whose subscriber has not confirmed everything.
TEST(KilledPeer, DoesNotHoldTheEndOfARun) {
  const std::uint32_t domain = 60 + static_cast<std::uint32_t>(getpid() + 40) % 150;
  Peer subscriber("Subscribes", domain);
  auto writers = endpoints(domain, /*write=*/true);
  const bool found = eventually(
      [&] { return std::ranges::all_of(writers, [](const auto& one) { return one->has_other_side(); }); });
  subscriber.die();
  ASSERT_TRUE(found);
  for (const auto& one : writers) EXPECT_TRUE(one->write(message));
  const auto begin = std::chrono::steady_clock::now();
  writers.clear();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(topics / 2));
}

/// DDS repeats what a server that was killed has not confirmed, to the server that takes its place.
TEST(KilledPeer, LeavesNoOldRequestToTheNextServer) {
  Peer killed("Serves", service_domain());
  Client client(std::chrono::milliseconds(200));
  std::uint32_t number = 0;
  std::int64_t sent = 0;  // calls that find no server have no request
  const auto outcome_of_next_call = [&] {
    EXPECT_TRUE(client.call(++number, true));
    EXPECT_TRUE(eventually([&] { return client.read(); }));
    if (client.reply.outcome != no_server) ++sent;
    return client.reply.outcome;
  };
  ASSERT_TRUE(eventually([&] { return outcome_of_next_call() == no_reply; }));
  killed.die();
  EXPECT_EQ(outcome_of_next_call(), no_reply) << "it still counts as alive";

  fast::Peer next(service_domain());
  const char* const identity = "serviceid=01.0f.8;";
  auto* const requests = next.reader<fast::SetBoolRequest>("rq/enableRequest", false, identity);
  auto* const replies = next.writer<fast::SetBoolResponse>("rr/enableReply", true, identity);
  ASSERT_TRUE(
      eventually([&] { return fast::Peer::is_matched(*requests) && fast::Peer::is_matched(*replies); }));
  const std::int64_t before = sent;
  std::optional<fast::SetBoolRequest> got;
  ASSERT_TRUE(eventually([&] {
    EXPECT_EQ(outcome_of_next_call(), no_reply);
    return (got = fast::Peer::take<fast::SetBoolRequest>(*requests)).has_value();
  }));
  EXPECT_GT(got->sequence, before) << "an old request";
}

}  // namespace
}  // namespace tessera::ros2
