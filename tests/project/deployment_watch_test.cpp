#include "project/process/deployment_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "../eventually.hpp"
#include "../schema/judge.hpp"
#include "project/process/waiting_chains.hpp"

namespace tessera::project {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using State = WatchedProcess::State;
using testing::ElementsAre;
using testing::HasSubstr;

/// The control socket of a process, at which the test sends in place of the process.
class Speaker {
 public:
  Speaker(const fs::path& file, std::string name) : file_(file), name_(std::move(name)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, file.c_str(), file.native().size() + 1);
    listening_ = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    EXPECT_EQ(bind(listening_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(listen(listening_, 4), 0);
  }
  ~Speaker() { leave(); }
  Speaker(const Speaker&) = delete;
  Speaker& operator=(const Speaker&) = delete;

  void leave() {
    for (int* one : {&client_, &listening_})
      if (*one >= 0) close(std::exchange(*one, -1));
    fs::remove(file_);
  }
  /// Whether a client has connected.
  [[nodiscard]] bool is_called() const {
    pollfd source{.fd = listening_, .events = POLLIN, .revents = 0};
    return client_ >= 0 || poll(&source, 1, 0) > 0;
  }
  /// Takes the clients that wait, and says nothing to them.
  void take_waiting() const {
    while (is_called()) close(accept4(listening_, nullptr, nullptr, SOCK_CLOEXEC));
  }
  /// Precondition: is_called().
  void say(json line) {
    if (client_ < 0) client_ = accept4(listening_, nullptr, nullptr, SOCK_CLOEXEC);
    if (!line.contains("ended")) schema_test::judge_line(line);
    const std::string text = line.dump() + "\n";
    EXPECT_EQ(send(client_, text.data(), text.size(), MSG_NOSIGNAL), static_cast<ssize_t>(text.size()));
  }
  void say_snapshot(double time_s, json waits = json::array(), json links = json::array(),
                    const std::string& system = "depot") {
    say({{"system", system},
         {"pid", 1},
         {"net_hash", "ab"},
         {"time_s", time_s},
         {"process", name_},
         {"host", "here"},
         {"incarnation", "7"},
         {"links", std::move(links)},
         {"channels", json::array()},
         {"waits", std::move(waits)},
         {"subsystems",
          {{{"path", name_ + ".control"},
            {"behaviour", "work"},
            {"calling", false},
            {"ended", false},
            {"iterations", 1},
            {"firings", 1},
            {"overruns", 0},
            {"errors", 0},
            {"period_s", 0},
            {"called_at_s", 0},
            {"call_s", 0},
            {"longest_call_s", 0}}}}});
  }

 private:
  fs::path file_;
  std::string name_;
  int listening_ = -1, client_ = -1;
};

json wait_of(const std::string& who, const std::string& whom, double since_s, const std::string& process) {
  json wait{{"subsystem", who + ".control"},
            {"waits_for", whom + ".control"},
            {"channel", who + "-" + whom},
            {"what", "value"},
            {"since_s", since_s}};
  if (!process.empty()) wait["process"] = process;
  return wait;
}

class Watching : public testing::Test {
 protected:
  Watching() : folder_(fs::temp_directory_path() / ("tessera.watching." + std::to_string(getpid()))) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~Watching() override { fs::remove_all(folder_); }
  /// number: of a process; that of the test lives.
  [[nodiscard]] fs::path socket_of(const std::string& name, pid_t number = getpid()) const {
    return folder_ / ("depot." + name + "." + std::to_string(number) + ".sock");
  }
  template <class Wanted>
  bool watch_until(Wanted wanted) {
    return eventually([&] {
      static_cast<void>(watch_.poll(std::chrono::milliseconds(20)));
      return wanted();
    });
  }
  void call(const std::vector<const Speaker*>& all) {
    ASSERT_TRUE(watch_until(
        [&] { return std::ranges::all_of(all, [](const Speaker* one) { return one->is_called(); }); }));
  }
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const WatchedProcess* one : watch_.processes()) all.push_back(one->name());
    return all;
  }
  bool sees(const std::string& name, State state) {
    return watch_until([&] {
      const WatchedProcess* one = watch_.find(name);
      return one != nullptr && one->state == state;
    });
  }

  const fs::path folder_;
  DeploymentWatch watch_{folder_, "depot"};
};

TEST_F(Watching, ProcessesAreFoundByThemselvesInTheOrderOfTheirNumbers) {
  Speaker ten(socket_of("cart[10]"), "cart[10]"), two(socket_of("cart[2]"), "cart[2]");
  call({&ten, &two});
  ten.say_snapshot(1);
  two.say_snapshot(1);
  EXPECT_TRUE(watch_until([&] { return names().size() == 2; }));
  EXPECT_THAT(names(), ElementsAre("cart[2]", "cart[10]"));
  Speaker late(socket_of("office"), "office"), other(folder_ / "depot.other.1.sock", "other");
  call({&late, &other});
  late.say_snapshot(2);
  other.say_snapshot(2, json::array(), json::array(), "depot.b");
  EXPECT_TRUE(watch_until([&] { return names().size() == 3; }));
  EXPECT_THAT(names(), ElementsAre("cart[2]", "cart[10]", "office"));
}

TEST_F(Watching, AProcessWhoseNameIsTooLongForASocketTellsItItself) {
  const std::string number = std::to_string(getpid());
  Speaker cart(folder_ / ("dep~0a1b2c3d." + number + ".sock"), "a_cart_with_a_long_name");
  Speaker other(folder_ / ("barn_of_~0a1b2c3d." + number + ".sock"), "of_another");
  call({&cart, &other});
  cart.say_snapshot(1);
  other.say_snapshot(1, json::array(), json::array(), "barn_of_depot");
  EXPECT_TRUE(watch_until([&] { return names().size() == 1; }));
  EXPECT_THAT(names(), ElementsAre("a_cart_with_a_long_name"));
}

TEST_F(Watching, OneThatDiesIsGoneOneThatEndsHasEndedAndItsNextStartTakesItsPlace) {
  Speaker cart(socket_of("cart"), "cart"), office(socket_of("office"), "office");
  call({&cart, &office});
  cart.say_snapshot(1);
  office.say_snapshot(1);
  ASSERT_TRUE(sees("cart", State::running) && sees("office", State::running));
  cart.leave();
  office.say({{"ended", true}});
  office.leave();
  EXPECT_TRUE(sees("cart", State::gone) && sees("office", State::ended));
  Speaker again(socket_of("cart", getppid()), "cart");
  call({&again});
  again.say_snapshot(0.5);
  EXPECT_TRUE(sees("cart", State::running));
  EXPECT_THAT(names(), ElementsAre("cart", "office"));
}

TEST_F(Watching, OneThatSaysNothingIsSilentEvenIfItNeverDid) {
  Speaker cart(socket_of("cart"), "cart"), office(socket_of("office"), "office");
  call({&cart, &office});
  office.say_snapshot(1);
  EXPECT_TRUE(sees("cart", State::silent) && sees("office", State::silent));
  EXPECT_EQ(watch_.find("cart")->snapshot.pid, getpid());
  cart.say_snapshot(3);
  EXPECT_TRUE(sees("cart", State::running));
}

TEST_F(Watching, OneThatTakesNoConnectionIsSilentUntilItGoesOn) {
  std::vector<ControlConnection> full;
  Speaker cart(socket_of("cart"), "cart");
  for (;;) {  // as if it was stopped
    ControlConnection::Attempt made = ControlConnection::attempt(socket_of("cart"));
    if (!made.connection) break;
    full.push_back(std::move(*made.connection));
    ASSERT_LT(full.size(), 1000U);
  }
  EXPECT_TRUE(sees("cart", State::silent));
  cart.take_waiting();
  call({&cart});
  cart.say_snapshot(1);
  EXPECT_TRUE(sees("cart", State::running));
}

TEST_F(Watching, OneThatWasKilledBeforeIsGone) {
  const pid_t child = fork();
  if (child == 0) _exit(0);
  ASSERT_EQ(waitpid(child, nullptr, 0), child);
  {
    // The file stays, as after SIGKILL.
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, socket_of("cart", child).c_str(),
                socket_of("cart", child).native().size() + 1);
    const int left_behind = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    ASSERT_EQ(bind(left_behind, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    close(left_behind);
  }
  EXPECT_TRUE(sees("cart", State::gone));
  EXPECT_FALSE(watch_.find("cart")->since) << "nobody saw when";
}

TEST_F(Watching, ChainsOfWaitsGoAcrossProcessesAndEndWithTheReason) {
  Speaker a(socket_of("a"), "a"), b(socket_of("b"), "b"), c(socket_of("c"), "c");
  call({&a, &b, &c});
  a.say_snapshot(10, json::array({wait_of("a", "b", 4, "b")}));
  b.say_snapshot(20, json::array({wait_of("b", "c", 17.5, "c"), wait_of("b", "a", 19.9, "a")}));
  c.say_snapshot(5);
  ASSERT_TRUE(watch_until([&] { return names().size() == 3; }));
  std::vector<WaitingChain> chains = waiting_chains(watch_);
  ASSERT_EQ(chains.size(), 1U);
  ASSERT_EQ(chains[0].steps.size(), 2U);
  EXPECT_EQ(chains[0].steps[0].text(), "a.control waits for b.control: no value for 6.0 s");
  EXPECT_EQ(chains[0].steps[1].text(), "b.control waits for c.control: no value for 2.5 s");
  EXPECT_EQ(chains[0].end, "c.control is in work");

  c.leave();
  ASSERT_TRUE(sees("c", State::gone));
  chains = waiting_chains(watch_);
  ASSERT_EQ(chains.size(), 1U);
  EXPECT_THAT(chains[0].end, HasSubstr("process c is gone for "));
}

TEST_F(Watching, ACircleOfWaitsIsNamed) {
  Speaker a(socket_of("a"), "a"), b(socket_of("b"), "b");
  call({&a, &b});
  a.say_snapshot(10, json::array({wait_of("a", "b", 4, "b")}));
  b.say_snapshot(10, json::array({wait_of("b", "a", 4, "a")}));
  ASSERT_TRUE(watch_until([&] { return names().size() == 2; }));
  const std::vector<WaitingChain> chains = waiting_chains(watch_);
  ASSERT_EQ(chains.size(), 1U);
  EXPECT_EQ(chains[0].end, "they wait for each other in a circle");
}

TEST_F(Watching, OneOnAnotherMachineIsKnownByItsLinks) {
  Speaker a(socket_of("a"), "a");
  call({&a});
  a.say_snapshot(10, json::array({wait_of("a", "far", 4, "far")}),
                 {{{"process", "far"},
                   {"reachable", false},
                   {"since_s", 3},
                   {"sent", 0},
                   {"repeated", 0},
                   {"received", 0},
                   {"duplicates", 0},
                   {"signs", 0},
                   {"signs_lost", 0}}});
  ASSERT_TRUE(sees("a", State::running));
  EXPECT_EQ(waiting_chains(watch_).at(0).end,
            "process far cannot be reached from a, and is not on this machine");
}

TEST_F(Watching, ProcessesOfOtherSystemsAndNetsAreNotShown) {
  DeploymentWatch of_net(folder_, "depot", "cd");
  Speaker a(socket_of("a"), "a");
  ASSERT_TRUE(eventually([&] {
    static_cast<void>(of_net.poll(std::chrono::milliseconds(20)));
    return a.is_called();
  }));
  a.say_snapshot(1);
  EXPECT_TRUE(eventually([&] {
    static_cast<void>(of_net.poll(std::chrono::milliseconds(20)));
    return of_net.of_another_net() == 1;
  }));
  EXPECT_TRUE(of_net.processes().empty());
}

}  // namespace
}  // namespace tessera::project
