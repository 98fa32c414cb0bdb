// A controller as a managed node, ordered about by programs of another implementation of DDS.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "bindings.hpp"
#include "eventually.hpp"
#include "fast_peer.hpp"

extern char** environ;

namespace tessera::ros2 {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr std::uint8_t unconfigured = 1, inactive = 2, active = 3, finalized = 4;
constexpr std::uint8_t configure = 1, cleanup = 2, activate = 3, deactivate = 4, by_label = 0;

/// The messages of lifecycle_msgs, with the header of rmw_cyclonedds_cpp.
struct ChangeRequest {
  static constexpr const char* name = "lifecycle_msgs::srv::dds_::ChangeState_Request_";
  std::uint64_t client = 0;
  std::int64_t sequence = 0;
  std::uint8_t id = 0;
  std::string label;
  template <class Archive>
  void fields(Archive& all) {
    all(client, sequence, id, label);
  }
};
struct ChangeResponse {
  static constexpr const char* name = "lifecycle_msgs::srv::dds_::ChangeState_Response_";
  std::uint64_t client = 0;
  std::int64_t sequence = 0;
  bool success = false;
  template <class Archive>
  void fields(Archive& all) {
    all(client, sequence, success);
  }
};
struct StateRequest {
  static constexpr const char* name = "lifecycle_msgs::srv::dds_::GetState_Request_";
  std::uint64_t client = 0;
  std::int64_t sequence = 0;
  std::uint8_t nothing = 0;
  template <class Archive>
  void fields(Archive& all) {
    all(client, sequence, nothing);
  }
};
struct StateResponse {
  static constexpr const char* name = "lifecycle_msgs::srv::dds_::GetState_Response_";
  std::uint64_t client = 0;
  std::int64_t sequence = 0;
  std::uint8_t id = 0;
  std::string label;
  template <class Archive>
  void fields(Archive& all) {
    all(client, sequence, id, label);
  }
};
struct TransitionEvent {
  static constexpr const char* name = "lifecycle_msgs::msg::dds_::TransitionEvent_";
  std::uint64_t time_ns = 0;
  std::uint8_t id = 0, from = 0, to = 0;
  std::string label, from_label, to_label;
  template <class Archive>
  void fields(Archive& all) {
    all(time_ns, id, label, from, from_label, to, to_label);
  }
};

/// A client of the node. Several have different names.
class Client {
 public:
  Client(fast::Peer& peer, std::uint64_t name)
      : name_(name),
        data_("clientid=01.0f." + std::to_string(name) + ";"),
        changes_(peer.writer<ChangeRequest>("rq/test/change_stateRequest", true, data_)),
        changed_(peer.reader<ChangeResponse>("rr/test/change_stateReply", false, data_)),
        asks_(peer.writer<StateRequest>("rq/test/get_stateRequest", true, data_)),
        states_(peer.reader<StateResponse>("rr/test/get_stateReply", false, data_)) {}

  /// The state of the node; 0: it does not answer. A request is lost if the node has not found the client yet.
  [[nodiscard]] std::uint8_t state() {
    std::uint8_t state = 0;
    static_cast<void>(eventually([&] {
      StateRequest request;
      request.client = name_;
      request.sequence = ++number_;
      asks_->write(&request);
      return got(*states_, 500ms, [&](const StateResponse& one) { state = one.id; });
    }));
    return state;
  }
  void send(std::uint8_t id, const std::string& label = "") {
    ChangeRequest request;
    request.client = name_;
    request.sequence = ++number_;
    request.id = id;
    request.label = label;
    changes_->write(&request);
  }
  /// Whether the order has succeeded; nullopt: it was not answered. Call `state` before.
  [[nodiscard]] std::optional<bool> change(std::uint8_t id, const std::string& label = "") {
    EXPECT_TRUE(
        eventually([&] { return fast::Peer::is_matched(*changes_) && fast::Peer::is_matched(*changed_); }));
    send(id, label);
    return answer();
  }
  [[nodiscard]] std::optional<bool> answer() {
    std::optional<bool> success;
    static_cast<void>(
        got(*changed_, test_patience, [&](const ChangeResponse& one) { success = one.success; }));
    return success;
  }

 private:
  /// Waits for the reply to the newest request.
  template <class Reader, class Time, class Use>
  bool got(Reader& reader, Time time, Use use) {
    using Message =
        std::conditional_t<std::is_invocable_v<Use, const StateResponse&>, StateResponse, ChangeResponse>;
    const auto until = std::chrono::steady_clock::now() + time;
    while (std::chrono::steady_clock::now() < until) {
      while (const auto reply = fast::Peer::take<Message>(reader))
        if (reply->client == name_ && reply->sequence == number_) return use(*reply), true;
      std::this_thread::sleep_for(2ms);
    }
    return false;
  }

  std::uint64_t name_;
  std::string data_;
  std::int64_t number_ = 0;
  eprosima::fastdds::dds::DataWriter* changes_;
  eprosima::fastdds::dds::DataReader* changed_;
  eprosima::fastdds::dds::DataWriter* asks_;
  eprosima::fastdds::dds::DataReader* states_;
};

/// The controller in a process of its own.
class ManagedController : public testing::Test {
 protected:
  ManagedController() {
    std::ofstream(commands_file(), std::ios::binary) << std::string(2 * sizeof(std::uint64_t), '\0');
    const int file = open(commands_file().c_str(), O_RDWR | O_CLOEXEC);
    commands_ = static_cast<std::atomic<std::uint64_t>*>(
        mmap(nullptr, 2 * sizeof(std::uint64_t), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0));
    close(file);
    setenv("TESSERA_TEST_COMMANDS", commands_file().c_str(), 1);
    setenv("TESSERA_TEST_BROKEN", broken_file().c_str(), 1);
    setenv("ROS_DOMAIN_ID", std::to_string(test_domain()).c_str(), 1);
    std::vector<std::string> words{TESSERA_MANAGED_ROBOT, "run", "--managed", "--record", recording(),
                                   "--record-limit",      "1GB"};
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    EXPECT_EQ(posix_spawn(&process_, arguments[0], nullptr, nullptr, arguments.data(), environ), 0);
  }
  ~ManagedController() override {
    if (process_ > 0) {
      kill(process_, SIGKILL);
      waitpid(process_, nullptr, 0);
    }
    munmap(commands_, 2 * sizeof(std::uint64_t));
    fs::remove_all(folder_);
  }
  [[nodiscard]] std::string commands_file() const { return folder_ / "commands"; }
  [[nodiscard]] std::string broken_file() const { return folder_ / "broken"; }
  [[nodiscard]] std::string recording() const { return folder_ / "run.tsr"; }

  [[nodiscard]] std::uint64_t moves() const { return commands_[0]; }
  [[nodiscard]] std::uint64_t stops() const { return commands_[1]; }
  [[nodiscard]] bool comes_to_move() const {
    const std::uint64_t before = moves();
    return eventually([&] { return moves() > before + 3; });
  }
  [[nodiscard]] bool stands() const {
    const std::uint64_t before = moves();
    std::this_thread::sleep_for(30ms);
    return moves() == before;
  }
  [[nodiscard]] int exit_code() {
    int status = 0;
    waitpid(std::exchange(process_, 0), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  }

  const fs::path folder_ = [] {
    std::string name = (fs::temp_directory_path() / "tessera_managed_XXXXXX").string();
    return fs::path(mkdtemp(name.data()));
  }();
  std::atomic<std::uint64_t>* commands_ = nullptr;
  pid_t process_ = 0;
  fast::Peer peer{test_domain()};
  Client client{peer, 5};
};

TEST_F(ManagedController, MovesItsDeviceOnlyWhileItIsActive) {
  auto* const events = peer.reader<TransitionEvent>("rt/test/transition_event");
  ASSERT_EQ(client.state(), unconfigured);
  ASSERT_TRUE(eventually([&] { return fast::Peer::is_matched(*events); }));
  EXPECT_EQ(client.change(activate), false) << "does not fit";
  EXPECT_EQ(moves() + stops(), 0U) << "no device is open";
  ASSERT_EQ(client.change(configure), true);
  EXPECT_EQ(client.state(), inactive);
  EXPECT_GT(stops(), 0U) << "the safe command";
  EXPECT_TRUE(stands());
  EXPECT_EQ(moves(), 0U);
  ASSERT_EQ(client.change(by_label, "activate"), true);
  EXPECT_TRUE(comes_to_move());
  ASSERT_EQ(client.change(deactivate), true);
  EXPECT_TRUE(stands());
  ASSERT_EQ(client.change(activate), true);
  EXPECT_TRUE(comes_to_move());
  EXPECT_EQ(client.change(cleanup), false) << "does not fit";
  EXPECT_EQ(client.state(), active);
  ASSERT_EQ(client.change(deactivate), true);
  ASSERT_EQ(client.change(cleanup), true);
  EXPECT_TRUE(stands());
  const std::uint64_t safe = stops();
  EXPECT_EQ(client.state(), unconfigured);
  EXPECT_EQ(stops(), safe);
  ASSERT_EQ(client.change(configure), true) << "a second run";
  ASSERT_EQ(client.change(activate), true);
  EXPECT_TRUE(comes_to_move());
  ASSERT_EQ(client.change(by_label, "shutdown"), true);
  EXPECT_EQ(exit_code(), 0);
  EXPECT_TRUE(stands());
  EXPECT_TRUE(fs::exists(recording()));
  EXPECT_TRUE(fs::exists(folder_ / "run-2.tsr"));
  std::vector<int> reached;
  while (const auto event = fast::Peer::take<TransitionEvent>(*events)) reached.push_back(event->to);
  EXPECT_EQ(reached, (std::vector<int>{10, inactive, 13, active, 14, inactive, 13, active, 14, inactive, 11,
                                       unconfigured, 10, inactive, 13, active, 12, finalized}));
}

TEST_F(ManagedController, IsUnconfiguredIfADeviceDoesNotTakeItsSafeCommand) {
  ASSERT_EQ(client.state(), unconfigured);
  std::ofstream(broken_file()) << "x";
  EXPECT_EQ(client.change(configure), false);
  EXPECT_EQ(client.state(), unconfigured);
  kill(process_, SIGTERM);
  EXPECT_EQ(exit_code(), 128 + SIGTERM);
  EXPECT_EQ(moves(), 0U);
}

TEST_F(ManagedController, TellsOfAFailedRunAndCanBeConfiguredAgain) {
  ASSERT_EQ(client.state(), unconfigured);
  ASSERT_EQ(client.change(configure), true);
  ASSERT_EQ(client.change(activate), true);
  EXPECT_TRUE(comes_to_move());
  std::ofstream(broken_file()) << "x";
  EXPECT_TRUE(eventually([&] { return client.state() == unconfigured; }));
  fs::remove(broken_file());
  ASSERT_EQ(client.change(configure), true);
  EXPECT_EQ(client.state(), inactive);
  kill(process_, SIGTERM);
  EXPECT_EQ(exit_code(), 128 + SIGTERM);
}

TEST_F(ManagedController, HasTwoClientsAtOnceAndOneThatDies) {
  Client other(peer, 6);
  ASSERT_EQ(client.state(), unconfigured);
  ASSERT_EQ(other.state(), unconfigured);
  ASSERT_EQ(other.change(by_label, "nothing"), false) << "so both are found";
  client.send(configure);
  other.send(configure);
  const std::optional<bool> first = client.answer(), second = other.answer();
  ASSERT_TRUE(first && second);
  EXPECT_NE(*first, *second) << "one of them does not fit";
  EXPECT_EQ(client.state(), inactive);
  {
    fast::Peer leaving_peer(test_domain());
    Client leaving(leaving_peer, 7);
    ASSERT_EQ(leaving.state(), inactive);
    ASSERT_EQ(leaving.change(by_label, "nothing"), false);
    leaving.send(activate);
    ASSERT_TRUE(eventually([&] { return moves() > 0; }));
  }
  EXPECT_EQ(client.change(deactivate), true);
  EXPECT_TRUE(stands());
  kill(process_, SIGKILL);  // its run ends safely by itself
  EXPECT_EQ(exit_code(), 1000 + SIGKILL);
  EXPECT_TRUE(stands());
}

}  // namespace
}  // namespace tessera::ros2
