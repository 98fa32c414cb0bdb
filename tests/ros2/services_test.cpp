// Clients and servers of services against Fast DDS, whose types are written by hand, and against each other.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <functional>
#include <vector>

#include "attempts.hpp"
#include "eventually.hpp"
#include "fast_peer.hpp"
#include "service_sides.hpp"
#include "stderr_text.hpp"

namespace tessera::ros2 {
namespace {

class WithFastService : public testing::Test {
 protected:
  using Reader = eprosima::fastdds::dds::DataReader;
  using Writer = eprosima::fastdds::dds::DataWriter;
  fast::Peer peer{service_domain()};

  struct FastServer {
    Reader* requests;
    Writer* replies;
  };
  FastServer fast_server(const std::string& user_data = "serviceid=01.0f.2;") {
    return {peer.reader<fast::SetBoolRequest>("rq/enableRequest", false, user_data),
            peer.writer<fast::SetBoolResponse>("rr/enableReply", true, user_data)};
  }
  static bool is_found(const FastServer& server) {
    return fast::Peer::is_matched(*server.requests) && fast::Peer::is_matched(*server.replies);
  }
  static void answer(const FastServer& server, const fast::SetBoolRequest& request, const std::string& text) {
    fast::SetBoolResponse reply;
    reply.client = request.client;
    reply.sequence = request.sequence;
    reply.success = request.data;
    reply.message = text;
    server.replies->write(&reply);
  }

  /// Calls with new numbers until the server gets one: a request is lost if it is sent before the server has
  /// found the client, though the client has found the server.
  template <class AnyClient>
  fast::SetBoolRequest first_request(AnyClient& client, const FastServer& server, bool data) {
    std::optional<fast::SetBoolRequest> got;
    EXPECT_TRUE(eventually([&] { return is_found(server); }));
    EXPECT_TRUE(eventually([&] {
      if (!client.call(++number, data)) return false;
      const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(300);
      while (!got && std::chrono::steady_clock::now() < until) {
        EXPECT_TRUE(client.call(number, data));
        got = fast::Peer::take<fast::SetBoolRequest>(*server.requests);
      }
      return got.has_value();
    }));
    return got.value_or(fast::SetBoolRequest{});
  }
  std::uint32_t number = 0;
};

TEST_F(WithFastService, ClientIsAnsweredOnceForEachCall) {
  Client client;
  const FastServer server = fast_server();
  const fast::SetBoolRequest request = first_request(client, server, true);
  EXPECT_TRUE(request.data);
  while (client.read()) EXPECT_EQ(client.reply.outcome, replaced);
  fast::SetBoolRequest other = request;
  other.client ^= 1;
  answer(server, other, "not for us");
  answer(server, request, "on");
  answer(server, request, "twice");
  ASSERT_TRUE(eventually([&] { return client.read(); }));
  EXPECT_EQ(client.reply.call, number);
  EXPECT_EQ(client.reply.outcome, answered);
  EXPECT_TRUE(client.reply.success);
  EXPECT_EQ(client.reply.message.view(), "on");
  // The same number is the same call. The next one comes after whatever was on the way.
  ASSERT_TRUE(client.call(number, false));
  ASSERT_TRUE(client.call(0, false));
  const std::uint32_t before = number;
  const fast::SetBoolRequest next = first_request(client, server, false);
  EXPECT_EQ(number, before + 1);
  EXPECT_FALSE(next.data);
  EXPECT_EQ(next.sequence, request.sequence + 1);
  answer(server, next, "off");
  ASSERT_TRUE(eventually([&] { return client.read(); }));
  EXPECT_EQ(client.reply.call, number);
  EXPECT_EQ(client.reply.message.view(), "off");
  EXPECT_FALSE(client.read());
}

TEST_F(WithFastService, NewerCallReplacesOneThatIsPending) {
  Client client;
  const FastServer server = fast_server();
  const fast::SetBoolRequest first = first_request(client, server, true);
  while (client.read()) EXPECT_EQ(client.reply.outcome, replaced);
  const std::uint32_t old = number;
  const fast::SetBoolRequest second = first_request(client, server, false);
  answer(server, first, "late");
  answer(server, second, "new");
  ASSERT_TRUE(eventually([&] { return client.read(); }));
  EXPECT_EQ(client.reply.call, old);
  EXPECT_EQ(client.reply.outcome, replaced);
  EXPECT_EQ(client.reply.message.view(), "");
  ASSERT_TRUE(eventually([&] { return client.read(); }));
  EXPECT_EQ(client.reply.call, number);
  EXPECT_EQ(client.reply.message.view(), "new");
}

TEST_F(WithFastService, ReplyThatDoesNotFitIsAnOutcome) {
  Client client;
  const FastServer server = fast_server();
  const fast::SetBoolRequest request = first_request(client, server, true);
  while (client.read()) EXPECT_EQ(client.reply.outcome, replaced);
  answer(server, request, "longer than sixteen bytes");
  ASSERT_TRUE(eventually([&] { return client.read(); }));
  EXPECT_EQ(client.reply.outcome, unreadable);
  EXPECT_EQ(client.reply.call, number);
}

/// Two servers of one name, each of which would misread a request to the other.
TEST_F(WithFastService, ServersOfTwoKindsGetNoRequest) {
  testing::internal::CaptureStderr();
  Client client(std::chrono::milliseconds(200));
  const FastServer with_header = fast_server();
  fast::Peer other(service_domain());
  const FastServer bare{other.reader<fast::BareSetBoolRequest>("rq/enableRequest"),
                        other.writer<fast::BareSetBoolResponse>("rr/enableReply")};
  ASSERT_TRUE(eventually([&] { return is_found(with_header) && is_found(bare); }));
  std::string told;
  ASSERT_TRUE(eventually([&] {  // the client may not have found the servers yet
    EXPECT_TRUE(client.call(++number, true));
    EXPECT_TRUE(eventually([&] { return client.read(); }));
    told += testing::internal::GetCapturedStderr();
    testing::internal::CaptureStderr();
    return told.find("would misunderstand it") != std::string::npos;
  }));
  while (fast::Peer::take<fast::BareSetBoolRequest>(*bare.requests)) continue;
  EXPECT_TRUE(client.call(++number, true));
  EXPECT_TRUE(eventually([&] { return client.read(); }));
  EXPECT_EQ(client.reply.outcome, no_server);
  told += testing::internal::GetCapturedStderr();
  EXPECT_FALSE(fast::Peer::take<fast::BareSetBoolRequest>(*bare.requests).has_value());
}

TEST_F(WithFastService, ServerAnswersOneAfterTheOther) {
  Server server;
  auto* const requests = peer.writer<fast::SetBoolRequest>("rq/enableRequest", true, "clientid=01.0f.3;");
  auto* const replies = peer.reader<fast::SetBoolResponse>("rr/enableReply", false, "clientid=01.0f.3;");
  ASSERT_TRUE(
      eventually([&] { return fast::Peer::is_matched(*requests) && fast::Peer::is_matched(*replies); }));
  fast::SetBoolRequest request;
  request.client = 77;
  request.data = true;
  ASSERT_TRUE(eventually([&] {
    ++request.sequence;
    requests->write(&request);
    return server.read();
  }));
  EXPECT_EQ(server.request.call, 1U);
  EXPECT_TRUE(server.request.data);
  EXPECT_FALSE(server.read()) << "the first has no reply yet";
  EXPECT_TRUE(server.reply(0, true, "nobody"));
  EXPECT_TRUE(server.reply(1, true, "done"));
  EXPECT_TRUE(server.reply(1, true, "twice"));
  std::optional<fast::SetBoolResponse> reply;
  ASSERT_TRUE(eventually([&] {
    EXPECT_TRUE(server.reply(1, true, "again"));  // it may not have found the client yet
    return (reply = fast::Peer::take<fast::SetBoolResponse>(*replies)).has_value();
  }));
  EXPECT_EQ(reply->client, 77U);
  EXPECT_EQ(reply->message, "done");
  EXPECT_TRUE(reply->success);
  // Requests sent while the first was pending wait in order.
  request.data = false;
  const std::int64_t last = request.sequence += 2;
  requests->write(&request);
  std::uint32_t call = 1;
  ASSERT_TRUE(eventually([&] {
    if (!server.read()) return false;
    EXPECT_EQ(server.request.call, ++call);
    EXPECT_TRUE(server.reply(call, false, "next"));
    return !server.request.data;
  }));
  ASSERT_TRUE(eventually([&] {
    while ((reply = fast::Peer::take<fast::SetBoolResponse>(*replies)))
      if (reply->sequence == last) return true;
    return false;
  }));
  EXPECT_EQ(reply->message, "next");
}

TEST_F(WithFastService, ServerDropsRequestsWithoutAHeader) {
  testing::internal::CaptureStderr();
  Server server;
  auto* const requests = peer.writer<fast::BareSetBoolRequest>("rq/enableRequest");
  ASSERT_TRUE(eventually([&] { return fast::Peer::is_matched(*requests); }));
  fast::BareSetBoolRequest request{true};
  std::string told;
  EXPECT_TRUE(eventually([&] {
    requests->write(&request);
    EXPECT_FALSE(server.read());
    told += testing::internal::GetCapturedStderr();
    testing::internal::CaptureStderr();
    return told.find("is not one of rmw_cyclonedds_cpp") != std::string::npos;
  }));
  told += testing::internal::GetCapturedStderr();
}

TEST_F(WithFastService, ServerTellsOfASecondServer) {
  Server server;
  auto* const rival = peer.writer<fast::SetBoolResponse>("rr/enableReply", true, "serviceid=01.0f.9;");
  ASSERT_NE(rival, nullptr);
  const StderrText told;
  EXPECT_TRUE(eventually([&] {
    EXPECT_FALSE(server.read());
    return told.has("service /enable: another server executes the requests, too");
  })) << told.now();
}

TEST(Services, OfTwoControllersFindEachOther) {
  Server server;
  Client<BareReply> client(std::chrono::seconds(30), /*wait=*/std::chrono::seconds(60));
  std::uint32_t number = 0;
  // A request that comes late belongs to a call that a newer one has replaced: its reply is dropped.
  ASSERT_TRUE(attempted([&] { EXPECT_TRUE(client.call(++number, true)); },
                        [&] {
                          static_cast<void>(server.read());
                          if (server.request.call > 0)
                            EXPECT_TRUE(server.reply(server.request.call, true, "yes"));
                          return client.read();
                        }))
      << "results without a reply are not given to a buffer without `outcome`";
  EXPECT_EQ(client.reply.call, number);
  EXPECT_TRUE(client.reply.success);
  EXPECT_EQ(client.reply.message.view(), "yes");
}

/// The safe command of a controller that ends.
TEST(Services, RequestOfAClientThatHasGoneIsExecuted) {
  Server server;
  std::uint32_t call = 0;
  EXPECT_TRUE(attempted(
      [&] {
        Client client(std::chrono::seconds(30), /*wait=*/std::chrono::seconds(60));
        EXPECT_TRUE(client.call(++call, false));
      },
      [&] { return server.read(); }));
  EXPECT_TRUE(server.reply(server.request.call, true, "nobody hears it"));
}

TEST(Services, CallWithoutAServerEnds) {
  Client client(std::chrono::milliseconds(20));
  ASSERT_TRUE(client.call(5, true));
  ASSERT_TRUE(eventually([&] { return client.read(); }));
  EXPECT_EQ(client.reply.call, 5U);
  EXPECT_EQ(client.reply.outcome, no_server);
  EXPECT_FALSE(client.reply.success);
  EXPECT_FALSE(client.read());
}

TEST(Services, CallWithoutAReplyEndsOnBothSides) {
  Server server(std::chrono::milliseconds(20));
  Client client(std::chrono::milliseconds(500), /*wait=*/std::chrono::seconds(60));
  std::uint32_t number = 0;
  ASSERT_TRUE(attempted([&] { EXPECT_TRUE(client.call(++number, true)); }, [&] { return server.read(); }));
  EXPECT_TRUE(eventually([&] { return client.read() && client.reply.outcome == no_reply; }));
  EXPECT_EQ(client.reply.call, number);
  EXPECT_TRUE(server.reply(server.request.call, true, "too late"));
  // An abandoned request does not block the next one.
  const std::uint32_t before = server.request.call;
  EXPECT_TRUE(attempted([&] { EXPECT_TRUE(client.call(++number, false)); }, [&] { return server.read(); }));
  EXPECT_GT(server.request.call, before);
}

}  // namespace
}  // namespace tessera::ros2
