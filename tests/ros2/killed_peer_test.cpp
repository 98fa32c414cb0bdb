// The other side is a process that was killed: DDS takes it for alive for some seconds.
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "eventually.hpp"
#include "ros2/dds/endpoint.hpp"

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

/// Cyclone DDS by itself waits up to 1 s for each writer whose subscriber has not confirmed everything.
TEST(KilledPeer, DoesNotHoldTheEndOfARun) {
  const std::uint32_t domain = 60 + static_cast<std::uint32_t>(getpid() + 40) % 150;
  std::array<std::string, 3> words{"/proc/self/exe", "--gtest_also_run_disabled_tests",
                                   "--gtest_filter=KilledPeer.DISABLED_Subscribes"};
  std::array<char*, 4> arguments{words[0].data(), words[1].data(), words[2].data(), nullptr};
  ASSERT_EQ(setenv(domain_variable, std::to_string(domain).c_str(), 1), 0);
  pid_t subscriber = 0;
  ASSERT_EQ(posix_spawn(&subscriber, arguments[0], nullptr, nullptr, arguments.data(), environ), 0);
  auto writers = endpoints(domain, /*write=*/true);
  const bool found = eventually(
      [&] { return std::ranges::all_of(writers, [](const auto& one) { return one->has_other_side(); }); });
  kill(subscriber, SIGKILL);
  waitpid(subscriber, nullptr, 0);
  ASSERT_TRUE(found);
  for (const auto& one : writers) EXPECT_TRUE(one->write(message));
  const auto begin = std::chrono::steady_clock::now();
  writers.clear();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(topics / 2));
}

}  // namespace
}  // namespace tessera::ros2
