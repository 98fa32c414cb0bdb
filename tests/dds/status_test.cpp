#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <map>
#include <optional>
#include <set>

#include "network/dds/carrier.hpp"
#include "network/dds/status/status_reader.hpp"
#include "network/dds/status/status_topic.hpp"
#include "tests/dds/crossing.hpp"
#include "tests/dds/heard.hpp"

/// The status of processes over real DDS.
namespace tessera::test {
namespace {

using dds::DdsCarrier;
using dds::DdsStatusReader;
using network::StatusPart;

struct Watcher final : network::StatusReader::Listener {
  explicit Watcher(const Crossing& crossing) {
    network::StatusReaderSetup setup;
    setup.system = crossing.system;
    setup.domain = crossing.domain;
    reader.emplace(setup);
  }
  void heard(const network::StatusSource& source, StatusPart part, std::string_view text) override {
    texts[{source, part}] = text;
  }
  void left(const network::StatusSource& source) override { gone.insert(source); }
  void complaint(std::string_view text) override { complaints.emplace_back(text); }
  void receive() { reader->receive(*this, std::chrono::milliseconds(2)); }
  [[nodiscard]] std::string said(network::StatusSource source, StatusPart part) const {
    const auto found = texts.find({source, part});
    return found == texts.end() ? "" : found->second;
  }
  std::optional<DdsStatusReader> reader;
  std::map<std::pair<network::StatusSource, StatusPart>, std::string> texts;
  std::set<network::StatusSource> gone;
  std::vector<std::string> complaints;
};

TEST(Status, IsHeardByThoseWhoWatchAndTellsWhoLeaves) {
  const Crossing crossing;
  std::optional<DdsCarrier> office(std::in_place, crossing.setup(Crossing::office, 10));
  DdsCarrier cart(crossing.setup(Crossing::cart, 20));
  EXPECT_EQ(office->watchers(), 0U);
  Watcher watcher(crossing);
  const std::string large(network::longest_status_bytes, 'x');
  ASSERT_TRUE(receive_until(
      [&] {
        office->send_status(StatusPart::brief, "here");
        office->send_status(StatusPart::whole, large);
        cart.send_status(StatusPart::brief, "there");
        return watcher.said({Crossing::office, 10}, StatusPart::whole) == large &&
               watcher.said({Crossing::office, 10}, StatusPart::brief) == "here" &&
               watcher.said({Crossing::cart, 20}, StatusPart::brief) == "there";
      },
      watcher));
  EXPECT_EQ(office->watchers(), 1U);
  office->send_status(StatusPart::brief, large + "x");
  office.reset();
  EXPECT_TRUE(receive_until([&] { return watcher.gone.contains({Crossing::office, 10}); }, watcher));
  EXPECT_EQ(watcher.said({Crossing::office, 10}, StatusPart::brief), "here")
      << "one that is too long was sent";
}

TEST(Status, SomebodyWhoWatchesIsNoProcessForTheOthers) {
  const Crossing crossing;
  DdsCarrier first(crossing.setup(Crossing::office, 10)), second(crossing.setup(Crossing::cart, 20));
  Station office(first), cart(second);
  std::optional<Watcher> watcher(std::in_place, crossing);
  ASSERT_TRUE(receive_until(
      [&] { return office.heard.sees(Crossing::cart) && first.watchers() == 1 && second.watchers() == 1; },
      office, cart));
  watcher.reset();
  ASSERT_TRUE(receive_until([&] { return first.watchers() == 0 && second.watchers() == 0; }, office, cart));
  EXPECT_TRUE(office.heard.complaints.empty() && cart.heard.complaints.empty());
  EXPECT_EQ(office.heard.changes.size(), 1U);
}

/// How often it has given its processor away because it waited.
[[nodiscard]] long waits_of_this_thread() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_nvcsw;
}

TEST(Status, AStoppedReaderHoldsUpNoProcess) {
  const Crossing crossing;
  const pid_t child = fork();  // before this process has threads of the middleware
  if (child == 0) {
    Watcher watcher(crossing);
    for (;;) watcher.receive();
  }
  ASSERT_GT(child, 0);
  DdsCarrier carrier(crossing.setup(Crossing::office, 10));
  ASSERT_TRUE(eventually([&] { return carrier.watchers() == 1; }));
  kill(child, SIGSTOP);
  const std::string large(network::longest_status_bytes, 'x');
  const int messages = 200;
  const long waits_before = waits_of_this_thread();
  for (int count = 0; count < messages; ++count) {
    carrier.send_status(StatusPart::whole, large);
    carrier.wake();
  }
  EXPECT_LT(waits_of_this_thread() - waits_before, messages / 2);
  kill(child, SIGKILL);
  ASSERT_EQ(waitpid(child, nullptr, 0), child);
  // Its lease ends: nothing is sent to it any more.
  EXPECT_TRUE(eventually([&] { return carrier.watchers() == 0; }));
}

TEST(Status, OfOtherSystemsIsNotHeard) {
  Crossing crossing;
  DdsCarrier office(crossing.setup(Crossing::office, 10));
  Watcher watcher(crossing);
  crossing.system = "other";
  DdsCarrier other(crossing.setup(Crossing::cart, 20));
  ASSERT_TRUE(receive_until(
      [&] {
        other.send_status(StatusPart::brief, "other");
        office.send_status(StatusPart::brief, "here");
        return !watcher.texts.empty();
      },
      watcher));
  EXPECT_EQ(other.watchers(), 0U);
  EXPECT_EQ(watcher.said({Crossing::cart, 20}, StatusPart::brief), "");
}

}  // namespace
}  // namespace tessera::test
