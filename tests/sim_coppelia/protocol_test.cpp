// The bytes are those that were recorded with CoppeliaSim 4.9.0.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <deque>
#include <mutex>
#include <nlohmann/json.hpp>

#include "reply_server.hpp"
#include "sim/coppelia/client.hpp"
#include "sim/coppelia/link_error.hpp"

using namespace std::chrono_literals;

namespace tessera::coppelia {
namespace {

using nlohmann::json;
using testing::Bytes;

Bytes bytes_of(std::string_view text) { return {text.begin(), text.end()}; }

/// Answers with recorded replies, one after the other, and keeps the requests.
class Recorded {
 public:
  explicit Recorded(std::deque<Bytes> replies)
      : replies_(std::move(replies)), server_([this](const Bytes& request) { return answer(request); }) {}

  [[nodiscard]] WorldServer address() const { return {"127.0.0.1", server_.port(), "", 2s}; }
  [[nodiscard]] std::vector<json> requests() const {
    const std::scoped_lock lock(mutex_);
    return requests_;
  }
  [[nodiscard]] std::vector<Bytes> raw() const {
    const std::scoped_lock lock(mutex_);
    return raw_;
  }

 private:
  std::optional<Bytes> answer(const Bytes& request) {
    const std::scoped_lock lock(mutex_);
    raw_.push_back(request);
    requests_.push_back(json::from_cbor(request));
    if (requests_.back().at("func") == "_*end*_") return Bytes{0xa0};
    if (replies_.empty()) return std::nullopt;
    Bytes reply = replies_.front();
    replies_.pop_front();
    return reply;
  }

  mutable std::mutex mutex_;
  std::deque<Bytes> replies_;
  std::vector<json> requests_;
  std::vector<Bytes> raw_;
  testing::ReplyServer server_;
};

const Bytes zero = bytes_of(std::string_view("\xa1\x63ret\x81\x00", 7));
const Bytes nothing = bytes_of("\xa1\x63ret\xa0");
const Bytes a_number = bytes_of(std::string_view("\xa1\x63ret\x81\xfb\x3f\xc3\x33\x33\x33\x33\x33\x34", 15));
const Bytes wait_a_little =
    bytes_of(std::string_view("\xa2\x64"
                              "args\xa0\x64"
                              "func\x68_*wait*_"));
const Bytes again =
    bytes_of(std::string_view("\xa2\x64"
                              "args\xa0\x64"
                              "func\x6a_*repeat*_"));

TEST(Protocol, RequestsHaveTheRecordedBytes) {
  Recorded server({zero, zero});
  Client client(server.address());
  EXPECT_EQ(client.call("sim.getSimulationState", json::array(), 2s), json::array({0}));
  EXPECT_EQ(client.call("sim.getObject", json::array({"/Floor"}), 2s), json::array({0}));
  const json first = server.requests().at(0);
  EXPECT_EQ(first.at("ver"), 2);
  EXPECT_EQ(first.at("timeout"), 60);
  const std::string uuid = first.at("uuid").get<std::string>();
  EXPECT_EQ(server.raw().at(1), bytes_of("\xa4\x64"
                                         "args\x81\x66/Floor\x65"
                                         "argsL\x01\x64"
                                         "func\x6dsim.getObject\x64uuid\x78\x24" +
                                         uuid));
}

TEST(Protocol, RepliesAreReadAsRecorded) {
  Recorded server({zero, a_number, nothing});
  Client client(server.address());
  EXPECT_EQ(client.call("a", json::array(), 2s), json::array({0}));
  EXPECT_DOUBLE_EQ(client.call("b", json::array(), 2s).at(0).get<double>(), 0.15);
  EXPECT_EQ(client.call("c", json::array(), 2s), json::array());
}

TEST(Protocol, ServerMayAskToWaitAndToRepeat) {
  Recorded server({wait_a_little, wait_a_little, again, nothing});
  Client client(server.address());
  EXPECT_EQ(client.call("sim.step", json::array(), 2s), json::array());
  std::vector<std::string> functions;
  for (const json& request : server.requests()) functions.push_back(request.at("func"));
  EXPECT_THAT(functions, ::testing::ElementsAre("sim.step", "_*executed*_", "_*executed*_", "sim.step"));
  EXPECT_EQ(server.requests().at(1).at("argsL"), 0);
}

TEST(Protocol, TheCallbackOfSomebodyElseIsAnsweredWithNothing) {
  const Bytes callback = json::to_cbor({{"func", "on_button"}, {"args", json::array({1})}});
  Recorded server({callback, zero});
  Client client(server.address());
  EXPECT_EQ(client.call("sim.f", json::array(), 2s), json::array({0}));
  EXPECT_EQ(server.requests().at(1).at("func"), "_*executed*_");
}

TEST(Protocol, AnErrorOfTheSimulatorIsItsFirstLine) {
  const std::string text =
      "1189: in sim._getObject: object does not exist_=NL=_stack traceback:_=NL=_[C]: in ?";
  Recorded server({json::to_cbor({{"err", text}}), zero});
  Client client(server.address());
  try {
    static_cast<void>(client.call("sim.getObject", json::array({"/x"}), 2s));
    FAIL();
  } catch (const RefusedCall& error) {
    EXPECT_STREQ(error.what(), "1189: in sim._getObject: object does not exist");
  }
  EXPECT_EQ(client.call("sim.f", json::array(), 2s), json::array({0})) << "the connection is as before";
}

TEST(Protocol, TakesLeaveOfTheServer) {
  Recorded server({zero});
  { static_cast<void>(Client(server.address()).call("sim.f", json::array(), 2s)); }
  EXPECT_EQ(server.requests().back().at("func"), "_*end*_");
}

std::string problem_after(const std::deque<Bytes>& replies) {
  Recorded server(replies);
  Client client(server.address());
  try {
    static_cast<void>(client.call("sim.f", json::array(), 300ms));
  } catch (const LinkError& error) {
    EXPECT_THROW(static_cast<void>(client.call("sim.f", json::array(), 300ms)), LinkError) << "it stays lost";
    std::string text = error.what();
    const std::string place = std::to_string(server.address().port);
    if (const auto at = text.find(place); at != std::string::npos) text.replace(at, place.size(), "PORT");
    return text;
  }
  return "";
}

TEST(Protocol, OtherProtocolsAreNamed) {
  const std::string who = "the server at 127.0.0.1:PORT ";
  EXPECT_EQ(problem_after({json::to_cbor({{"success", false}, {"error", "version does not match"}})}),
            who +
                "speaks another version of the remote API (1; CoppeliaSim before 4.5): it says 'version does "
                "not match'");
  EXPECT_EQ(problem_after({json::to_cbor(json::object())}), who + "speaks another version of the remote API");
  const std::string what =
      "the program at 127.0.0.1:PORT speaks another protocol: the reply is no map in CBOR";
  for (const Bytes& garbage :
       {bytes_of("hello"), Bytes{}, Bytes{0xa1}, Bytes{0x81, 0x00}, Bytes(1'000'000, 0x81)})
    EXPECT_EQ(problem_after({garbage}), what);
}

TEST(Protocol, AnEndlessWaitEnds) {
  EXPECT_EQ(problem_after(std::deque<Bytes>(100'000, again)),
            "the server at 127.0.0.1:PORT has not finished sim.f for 1 s");
}

}  // namespace
}  // namespace tessera::coppelia
