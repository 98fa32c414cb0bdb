#include "server/http/events.hpp"

#include "served.hpp"

namespace tessera::server_test {

using nlohmann::json;

using EventsOfAServer = Served;

TEST_F(EventsOfAServer, BeginWithHello) {
  serve();
  EventStream stream(port_, token_);
  const json hello = stream.next("hello");
  EXPECT_EQ(hello.at("server_start"), get("/api/project").json().at("server_start"));
  EXPECT_EQ(hello.at("revision"), get("/api/spec").json().at("revision"));
}

TEST_F(EventsOfAServer, TellEveryBrowserOfAChangedFile) {
  serve();
  EventStream first(port_, token_), second(port_, token_);
  ASSERT_FALSE(first.next("hello").is_null());
  ASSERT_FALSE(second.next("hello").is_null());
  write(spec(), "tessera: 1\n");
  const std::string revision = get("/api/spec").json().at("revision");
  const auto is_it = [&](const json& data) { return data.at("revision") == revision; };
  EXPECT_FALSE(first.next("spec", is_it).is_null());
  EXPECT_FALSE(second.next("spec", is_it).is_null());
}

/// The page does not know which line of another file a number would be.
TEST_F(EventsOfAServer, TellOfAChangedFileThatTheSpecificationIncludes) {
  std::string text = content_of(spec());
  const std::size_t begin = text.find("types:"), end = text.find("parameters:");
  fs::create_directories(spec().parent_path() / "parts");
  const fs::path part = spec().parent_path() / "parts/types.yaml";
  const std::string types = text.substr(begin, end - begin);
  write(part, types);
  write(spec(), text.replace(begin, end - begin, "include: parts/types.yaml\n"));
  serve();
  const json before = get("/api/spec").json();
  EXPECT_TRUE(before.at("analysis").at("diagnostics").empty()) << before.at("analysis").at("diagnostics");
  EXPECT_FALSE(before.at("analysis").at("net").is_null());
  EventStream stream(port_, token_);
  ASSERT_FALSE(stream.next("hello").is_null());
  write(part, types + "  Wrong: { x: flot64 }\n");
  EXPECT_EQ(stream.next("spec").at("revision"), before.at("revision"));
  const json after = post("/api/check", {{"text", text}}).json();
  ASSERT_EQ(after.at("diagnostics").size(), 1U) << after;
  const json& mistake = after.at("diagnostics")[0];
  EXPECT_EQ(mistake.at("line"), 0);
  EXPECT_EQ(mistake.at("message").get<std::string>().substr(0, 19), "parts/types.yaml:5:") << mistake;
}

TEST_F(EventsOfAServer, TellOfAFileThatWasReplacedByRenaming) {
  serve();
  EventStream stream(port_, token_);
  ASSERT_FALSE(stream.next("hello").is_null());
  write(folder_ / "project/.spec.yaml.swp", "tessera: 1\n");
  fs::rename(folder_ / "project/.spec.yaml.swp", spec());
  EXPECT_EQ(stream.next("spec").at("revision"), get("/api/spec").json().at("revision"));
}

TEST_F(EventsOfAServer, EndWhenTheServerEnds) {
  serve();
  EventStream stream(port_, token_);
  ASSERT_FALSE(stream.next("hello").is_null());
  studio_.reset();
  EXPECT_TRUE(stream.next("hello").is_null());
}

TEST(Events, ABrowserThatDoesNotReadIsDroppedAndHoldsNobodyUp) {
  server::Events events;
  const auto idle = events.subscribe("hello", "{}");
  ASSERT_NE(idle, nullptr);
  const std::string much = '"' + std::string(1U << 20U, 'x') + '"';
  for (int times = 0; times < 100; ++times) events.publish("values", much);
  EXPECT_EQ(idle->next(), "");
  const auto fresh = events.subscribe("hello", "{}");
  EXPECT_EQ(fresh->next(), "event: hello\ndata: {}\n\n");
}

TEST(Events, ThereAreOnlySoManyBrowsers) {
  server::Events events;
  std::vector<std::shared_ptr<server::Events::Subscription>> all;
  for (std::size_t one = 0; one < server::Events::most_subscribers; ++one)
    all.push_back(events.subscribe("hello", "{}"));
  EXPECT_NE(all.back(), nullptr);
  EXPECT_EQ(events.subscribe("hello", "{}"), nullptr);
  all.pop_back();
  EXPECT_NE(events.subscribe("hello", "{}"), nullptr);
}

}  // namespace tessera::server_test
