// Services with the other side as rmw_fastrtps_cpp makes it: the identity of a request stands beside the data.
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <optional>
#include <string>

#include "eventually.hpp"
#include "fast_peer.hpp"
#include "service_sides.hpp"
#include "stderr_text.hpp"

namespace tessera::ros2 {
namespace {

constexpr std::uint32_t calls = 1000;

/// Like `eventually`, for what takes less than a millisecond.
template <class Look>
bool soon(Look look) {
  const auto end = std::chrono::steady_clock::now() + test_patience;
  while (!look()) {
    if (std::chrono::steady_clock::now() > end) return false;
    usleep(20);
  }
  return true;
}

/// Prints the mean of the calls, which no test judges.
class Stopwatch {
 public:
  explicit Stopwatch(const char* what) : what_(what) {}
  ~Stopwatch() {
    const std::chrono::duration<double, std::milli> all = std::chrono::steady_clock::now() - start_;
    testing::Test::RecordProperty(what_, std::to_string(all.count() / calls));
    std::printf("%s: %.3f ms a call\n", what_, all.count() / calls);
  }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  const char* what_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

TEST(ServicesOfFastDds, ServerAnswersEachCallOfOurClient) {
  fast::Peer peer(service_domain());
  auto* const requests = peer.reader<fast::BareSetBoolRequest>("rq/enableRequest");
  auto* const replies = peer.writer<fast::BareSetBoolResponse>("rr/enableReply");
  Client client(std::chrono::seconds(60), /*wait=*/std::chrono::seconds(60));
  ASSERT_TRUE(
      eventually([&] { return fast::Peer::is_matched(*requests) && fast::Peer::is_matched(*replies); }));
  const Stopwatch watch("our client");
  for (std::uint32_t number = 1; number <= calls; ++number) {
    ASSERT_TRUE(client.call(number, number % 2 == 0));
    std::optional<fast::Peer::Identified<fast::BareSetBoolRequest>> request;
    ASSERT_TRUE(soon([&] {
      return (request = fast::Peer::take_identified<fast::BareSetBoolRequest>(*requests)).has_value();
    })) << number;
    ASSERT_EQ(request->message.data, number % 2 == 0);
    fast::BareSetBoolResponse reply;
    reply.success = request->message.data;
    reply.message = std::to_string(number);
    auto other = *request;  // a reply to another client
    other.own.writer_guid(requests->guid());
    fast::Peer::reply(*replies, reply, other);
    fast::Peer::reply(*replies, reply, *request);
    ASSERT_TRUE(soon([&] { return client.read(); })) << number;
    ASSERT_EQ(client.reply.call, number);
    ASSERT_EQ(client.reply.outcome, answered);
    ASSERT_EQ(client.reply.success, number % 2 == 0);
    ASSERT_EQ(client.reply.message.view(), std::to_string(number));
  }
  EXPECT_FALSE(fast::Peer::take<fast::BareSetBoolRequest>(*requests).has_value()) << "each request once";
}

TEST(ServicesOfFastDds, ClientGetsTheReplyToEachCallOfOurServer) {
  setenv("TESSERA_ROS2_FAST_LIBRARY", TESSERA_ROS2_FAST_LIBRARY, 1);
  using fast::Peer;
  Server server(std::chrono::seconds(60));
  Peer peer(service_domain());
  auto* const requests = peer.writer<fast::BareSetBoolRequest>("rq/enableRequest");
  auto* const replies = peer.reader<fast::BareSetBoolResponse>("rr/enableReply");
  ASSERT_TRUE(eventually([&] { return Peer::is_matched(*requests) && Peer::is_matched(*replies); }));
  std::uint32_t served = 0, received = 0;
  const auto serve = [&] {
    if (!server.read()) return false;
    served = server.request.call;
    return server.reply(served, server.request.data, "call " + std::to_string(served));
  };
  // The first requests are lost if the server has not found the client yet.
  fast::BareSetBoolRequest request;
  const std::chrono::steady_clock::time_point begin = std::chrono::steady_clock::now();
  ASSERT_TRUE(eventually([&] {
    if (served == 0) Peer::request(*requests, request, *replies);
    EXPECT_EQ(requests->wait_for_acknowledgments({60, 0}),
              eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK);
    static_cast<void>(serve());
    while (Peer::take<fast::BareSetBoolResponse>(*replies)) ++received;
    return received > 0;
  }));
  std::printf("first reply: %.0f ms\n",
              std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
  ASSERT_TRUE(soon([&] {
    while (serve()) continue;
    while (Peer::take<fast::BareSetBoolResponse>(*replies)) ++received;
    return received == served;
  }));
  const Stopwatch watch("our server");
  for (std::uint32_t number = served + 1, last = served + calls; number <= last; ++number) {
    request.data = number % 2 == 0;
    const auto expected = Peer::request(*requests, request, *replies);
    ASSERT_TRUE(soon(serve)) << number;
    std::optional<Peer::Identified<fast::BareSetBoolResponse>> reply;
    ASSERT_TRUE(soon([&] {
      EXPECT_FALSE(server.read());
      return (reply = Peer::take_identified<fast::BareSetBoolResponse>(*replies)).has_value();
    })) << number;
    ASSERT_TRUE(reply->related == expected) << number;
    ASSERT_EQ(reply->message.success, number % 2 == 0);
    ASSERT_EQ(reply->message.message, "call " + std::to_string(number));
  }
  EXPECT_FALSE(Peer::take<fast::BareSetBoolResponse>(*replies).has_value()) << "each reply once";
}

/// Each side of ours has an endpoint of Cyclone DDS and one of Fast DDS.
constexpr int endpoints = 2;

/// Each client calls as soon as it has found the server, which may not have found the client.
TEST(ServicesOfFastDds, NoFirstCallOfAClientIsLost) {
  setenv("TESSERA_ROS2_FAST_LIBRARY", TESSERA_ROS2_FAST_LIBRARY, 1);
  using fast::Peer;
  Server server(std::chrono::seconds(60));
  std::uint32_t served = 0;
  const auto serve = [&] {
    if (!server.read()) return;
    served = server.request.call;
    EXPECT_TRUE(server.reply(served, server.request.data, ""));
  };
  for (int clients = 0; clients < 2; ++clients) {
    Peer peer(service_domain(), fast::Reach::announced);
    auto* const requests = peer.writer<fast::BareSetBoolRequest>("rq/enableRequest");
    auto* const replies = peer.reader<fast::BareSetBoolResponse>("rr/enableReply");
    ASSERT_TRUE(soon([&] {
      serve();
      return Peer::found_by(*requests) == endpoints && Peer::is_matched(*replies);
    }));
    const std::uint32_t served_before = served;
    fast::BareSetBoolRequest request{true};
    const auto expected = Peer::request(*requests, request, *replies);
    std::optional<Peer::Identified<fast::BareSetBoolResponse>> reply;
    ASSERT_TRUE(eventually([&] {
      serve();
      return (reply = Peer::take_identified<fast::BareSetBoolResponse>(*replies)).has_value();
    })) << clients;
    EXPECT_TRUE(reply->related == expected);
    EXPECT_EQ(served, served_before + 1) << "each request once, though it comes two ways";
  }
}

/// Cyclone DDS skips a reply that comes before it is ready for it.
TEST(ServicesOfFastDds, NoFirstCallToAServerIsLost) {
  setenv("TESSERA_ROS2_FAST_LIBRARY", TESSERA_ROS2_FAST_LIBRARY, 1);
  using fast::Peer;
  Peer peer(service_domain(), fast::Reach::announced);
  auto* const requests = peer.reader<fast::BareSetBoolRequest>("rq/enableRequest");
  auto* const replies = peer.writer<fast::BareSetBoolResponse>("rr/enableReply");
  for (int clients = 1; clients <= 2; ++clients) {
    Client client(std::chrono::seconds(60), /*wait=*/std::chrono::seconds(60));
    ASSERT_TRUE(client.call(1, true));
    ASSERT_TRUE(eventually([&] {
      // As that of rmw_fastrtps_cpp, the server waits until it has found the reader of replies.
      if (Peer::found_by(*replies) >= clients * endpoints)
        if (const auto request = Peer::take_identified<fast::BareSetBoolRequest>(*requests)) {
          EXPECT_TRUE(request->related.writer_guid() != eprosima::fastrtps::rtps::GUID_t::unknown());
          fast::BareSetBoolResponse reply;
          reply.success = true;
          Peer::reply(*replies, reply, *request);
        }
      return client.read();
    })) << clients;
    EXPECT_EQ(client.reply.outcome, answered);
    EXPECT_TRUE(client.reply.success);
  }
}

TEST(ServicesOfFastDds, RequestsAreDroppedIfTheLibraryIsMissing) {
  setenv("TESSERA_ROS2_FAST_LIBRARY", "/nowhere/libtessera_ros2_fast.so", 1);
  const StderrText told;
  Server server(std::chrono::seconds(60));
  fast::Peer peer(service_domain());
  auto* const requests = peer.writer<fast::BareSetBoolRequest>("rq/enableRequest");
  auto* const replies = peer.reader<fast::BareSetBoolResponse>("rr/enableReply");
  ASSERT_TRUE(eventually([&] { return fast::Peer::is_matched(*requests); }));
  fast::BareSetBoolRequest request{true};
  EXPECT_TRUE(eventually([&] {
    fast::Peer::request(*requests, request, *replies);
    const bool asked = server.read();
    EXPECT_TRUE(!asked || server.reply(server.request.call, true, "")) << "no fault of the robot";
    return told.has("clients that run rmw_fastrtps_cpp get no replies: /nowhere/libtessera_ros2_fast.so");
  })) << told.now();
}

}  // namespace
}  // namespace tessera::ros2
