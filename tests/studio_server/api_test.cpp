#include <gmock/gmock.h>

#include "served.hpp"

namespace tessera::server_test {

using nlohmann::json;
using testing::HasSubstr;

using Api = Served;

TEST_F(Api, ProjectNamesTheSystemItsFileAndTheWorlds) {
  serve();
  const json project = get("/api/project").json();
  EXPECT_EQ(project.at("name"), "line_follower");
  EXPECT_EQ(project.at("file"), "spec.yaml");
  EXPECT_EQ(project.at("folder"), options_.spec.parent_path().string());
  EXPECT_EQ(project.at("version"), "test");
  ASSERT_FALSE(project.at("worlds").empty());
  EXPECT_FALSE(project.at("worlds")[0].at("tracks").empty());
}

TEST_F(Api, SpecComesWithItsNet) {
  serve();
  const json spec_now = get("/api/spec").json();
  EXPECT_EQ(spec_now.at("text"), content_of(spec()));
  const json& analysis = spec_now.at("analysis");
  EXPECT_TRUE(analysis.at("diagnostics").empty());
  EXPECT_GT(analysis.at("net").at("shapes")[0].at("places").size(), 20U);
}

TEST_F(Api, ABrokenFileHasItsDiagnosticsAndNoNet) {
  std::string text = content_of(spec());
  text.replace(text.find("next: follow"), 12, "next: folow ");
  write(spec(), text);
  serve();
  const Reply reply = get("/api/spec");
  ASSERT_EQ(reply.status, 200);
  const json analysis = reply.json().at("analysis");
  ASSERT_FALSE(analysis.at("diagnostics").empty());
  const json& one = analysis.at("diagnostics")[0];
  EXPECT_EQ(one.at("severity"), "error");
  EXPECT_EQ(one.at("code"), "E101");
  EXPECT_THAT(one.at("hint").get<std::string>(), HasSubstr("follow"));
  EXPECT_GT(one.at("end_column").get<int>(), one.at("column").get<int>());
  EXPECT_TRUE(analysis.at("net").is_null());
}

TEST_F(Api, MessagesOfRos2AreLookedUp) {
  serve();
  std::string text = content_of(spec());
  text.insert(text.find("\nsimulation:"), R"(
drivers:
  robot.sensor.left:   { ros2: /left, type: my_robot/Light }
  robot.sensor.middle: { ros2: /middle, type: std_msgs/Float65 }
)");
  const auto told = [&] {
    std::vector<std::string> all;
    const json analysis = post("/api/check", {{"text", text}}).json();
    for (const json& one : analysis.at("diagnostics"))
      all.push_back(one.at("code").get<std::string>() + " " + one.at("hint").get<std::string>());
    EXPECT_FALSE(analysis.at("net").is_null()) << "the drivers are not in the net";
    return all;
  };
  EXPECT_EQ(
      told(),
      (std::vector<std::string>{
          "E320 write its definition into msg/my_robot/msg/Light.msg beside the specification, or source a "
          "ROS 2 installation that has it",
          "E320 did you mean 'std_msgs/Float64'?"}));
  const fs::path folder = spec().parent_path() / "msg/my_robot/msg";
  fs::create_directories(folder);
  write(folder / "Light.msg", "float64 brightness\n");
  EXPECT_EQ(told(), (std::vector<std::string>{"E320 did you mean 'std_msgs/Float64'?"}))
      << "the text is the same, but not the definition";
  fs::remove_all(spec().parent_path() / "msg");
}

TEST_F(Api, ColumnsCountAsBrowsersDo) {
  serve();
  const json analysis =
      post("/api/check", {{"text", "tessera: 1\nsystem: \"\xF0\x9F\xA4\x96\xC3\xA9\" bad\n"}}).json();
  ASSERT_FALSE(analysis.at("diagnostics").empty());
  const json ascii = post("/api/check", {{"text", "tessera: 1\nsystem: \"abc\" bad\n"}}).json();
  // A robot is two units and an accented letter one: as many as three letters of ASCII.
  EXPECT_EQ(analysis.at("diagnostics")[0].at("column"), ascii.at("diagnostics")[0].at("column"));
}

TEST_F(Api, TextThatIsNotYamlStillAnswers) {
  serve();
  for (const char* text : {"", "{", "\t", "a: [1, 2", "agents: {robot: 3}", "- - - -",
                           "agents: { r: { control: { "
                           "behaviours: { a: { next: b } } } } }"}) {
    const Reply reply = post("/api/check", {{"text", text}});
    EXPECT_EQ(reply.status, 200) << text;
    EXPECT_FALSE(reply.json().at("diagnostics").empty()) << text;
  }
}

TEST_F(Api, LanguageCompletesExplainsAndFinds) {
  serve();
  const std::string text = content_of(spec());
  const auto before = text.substr(0, text.find("next: follow") + 6);
  const auto line = std::count(before.begin(), before.end(), '\n');
  const auto character = before.size() - before.rfind('\n') - 1;
  json question{{"text", text}, {"line", line}, {"character", character}, {"ask", "completion"}};
  const json proposals = post("/api/language", question).json().at("proposals");
  ASSERT_EQ(proposals.size(), 3U);
  EXPECT_EQ(proposals[1].at("label"), "follow");
  EXPECT_EQ(proposals[1].at("from").at("character"), character);
  question["ask"] = "meaning";
  EXPECT_THAT(post("/api/language", question).json().at("meaning").at("text").get<std::string>(),
              HasSubstr("robot.control.follow"));
  question["ask"] = "definition";
  EXPECT_EQ(post("/api/language", question).json().at("definition").at("line"), line + 1);
  question["ask"] = "weather";
  EXPECT_EQ(post("/api/language", question).status, 400);
  question["line"] = -1;
  EXPECT_EQ(post("/api/language", question).status, 400);
}

TEST_F(Api, CheckDoesNotSave) {
  serve();
  const std::string before = content_of(spec());
  EXPECT_EQ(post("/api/check", {{"text", "tessera: 1"}}).status, 200);
  EXPECT_EQ(content_of(spec()), before);
}

TEST_F(Api, PutReplacesTheFileAndKeepsItsMode) {
  fs::permissions(spec(), fs::perms::owner_read | fs::perms::owner_write);
  serve();
  const json before = get("/api/spec").json();
  const std::string text = before.at("text").get<std::string>() + "# a comment\n";
  const Reply saved = put("/api/spec", {{"text", text}, {"revision", before.at("revision")}});
  ASSERT_EQ(saved.status, 200) << saved.body;
  EXPECT_EQ(content_of(spec()), text);
  EXPECT_EQ(fs::status(spec()).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(saved.json().at("revision"), get("/api/spec").json().at("revision"));
  EXPECT_EQ(std::distance(fs::directory_iterator(spec().parent_path()), fs::directory_iterator()),
            std::distance(fs::directory_iterator(fs::path(TESSERA_SOURCE_DIR) / "examples/01_line_follower"),
                          fs::directory_iterator()) -
                (fs::exists(fs::path(TESSERA_SOURCE_DIR) / "examples/01_line_follower/.tessera") ? 1 : 0))
      << "something was left beside the file";
}

TEST_F(Api, WhatAnotherEditorWroteIsNotOverwritten) {
  serve();
  const json before = get("/api/spec").json();
  write(spec(), "# of another editor\n");
  const Reply refused = put("/api/spec", {{"text", "mine"}, {"revision", before.at("revision")}});
  EXPECT_EQ(refused.status, 409);
  EXPECT_EQ(refused.json().at("text"), "# of another editor\n");
  EXPECT_EQ(content_of(spec()), "# of another editor\n");
  const Reply saved = put("/api/spec", {{"text", "mine"}, {"revision", refused.json().at("revision")}});
  EXPECT_EQ(saved.status, 200);
  EXPECT_EQ(content_of(spec()), "mine");
}

TEST_F(Api, AFileThatIsGoneCanBeSavedAgain) {
  serve();
  fs::remove(spec());
  const json gone = get("/api/spec").json();
  EXPECT_EQ(gone.at("text"), "");
  EXPECT_FALSE(gone.at("error").is_null());
  EXPECT_EQ(put("/api/spec", {{"text", "back"}, {"revision", gone.at("revision")}}).status, 200);
  EXPECT_EQ(content_of(spec()), "back");
}

TEST_F(Api, AFileThatAPageCannotSeeAsItIsIsNotReplaced) {
  serve();
  const std::string large(9U << 20U, '#');
  write(spec(), large);
  const json unread = get("/api/spec").json();
  EXPECT_THAT(unread.at("error").get<std::string>(), HasSubstr("larger than 8 MB"));
  EXPECT_EQ(unread.at("revision"), "");
  const Reply refused = put("/api/spec", {{"text", "mine"}, {"revision", unread.at("revision")}});
  EXPECT_EQ(refused.status, 500);
  EXPECT_EQ(content_of(spec()), large);
  // The page sees U+FFFD in place of the byte.
  write(spec(), "# one\n# gr\xfcn\n");
  const json read = get("/api/spec").json();
  const Reply latin = put("/api/spec", {{"text", "mine"}, {"revision", read.at("revision")}});
  EXPECT_EQ(latin.status, 500);
  EXPECT_THAT(latin.body, HasSubstr("a byte in line 2 is not UTF-8"));
  EXPECT_EQ(content_of(spec()), "# one\n# gr\xfcn\n");
  const fs::path source = spec().parent_path() / "src/control.cpp";
  const std::string code = content_of(source) + "// gr\xfcn\n";
  write(source, code);
  const json shown = get("/api/sources?file=src/control.cpp").json();
  EXPECT_EQ(
      put("/api/sources", {{"file", "src/control.cpp"}, {"text", "x"}, {"revision", shown.at("revision")}})
          .status,
      500);
  EXPECT_EQ(content_of(source), code);
}

TEST_F(Api, WithoutABuiltPageTheServerSaysHowToBuildIt) {
  serve();
  const Reply page = ask_with({{"Host", host()}}, "GET", "/", {});
  EXPECT_EQ(page.status, 200);
  EXPECT_THAT(page.body, HasSubstr("npm run build"));
}

TEST_F(Api, ThePageNeedsNoTokenAndMayLoadNothingForeign) {
  write(options_.page / "index.html", "<p>page");
  write(options_.page / "assets/index.js", "1");
  serve();
  const Reply page = ask_with({{"Host", host()}}, "GET", "/", {});
  EXPECT_EQ(page.body, "<p>page");
  const auto policy = page.headers.find("Content-Security-Policy");
  ASSERT_NE(policy, page.headers.end());
  EXPECT_THAT(policy->second, HasSubstr("default-src 'self'"));
  const Reply script = ask_with({{"Host", host()}}, "GET", "/assets/index.js", {});
  EXPECT_EQ(script.body, "1");
  EXPECT_THAT(script.headers.find("Content-Type")->second, HasSubstr("javascript"));
}

TEST_F(Api, FilesOfThePageComePackedToWhoeverTakesThemSoAndShortAnswersNever) {
  const std::string script(100'000, ' ');
  write(options_.page / "assets/index.js", script);
  serve();
  const auto ask_packed = [&](const std::string& path) {
    Headers headers = own_headers();
    headers.emplace("Accept-Encoding", "gzip, deflate, br");
    return ask_with(headers, "GET", path, {});
  };
  const Reply packed = ask_packed("/assets/index.js");
  ASSERT_TRUE(packed.headers.contains("Content-Encoding"));
  EXPECT_EQ(packed.headers.find("Content-Encoding")->second, "gzip");
  EXPECT_LT(packed.body.size(), 1000U);
  EXPECT_EQ(get("/assets/index.js").body, script);
  const Reply answer = ask_packed("/api/spec");
  EXPECT_FALSE(answer.headers.contains("Content-Encoding"));
  EXPECT_TRUE(answer.json().at("analysis").at("net").is_object());
}

TEST_F(Api, LargeFleetsTakeFewBytes) {
  write(spec(), R"(tessera: 1
system: fleet
templates:
  walker:
    control: { rate: 20 Hz, inputs: { heard: bool }, outputs: { said: bool }, behaviours: { walk: } }
agents: { robot: { use: walker, count: 2000, ring: true } }
channels: [ "robot[i].control.said -> robot[i+1].control.heard" ]
)");
  serve();
  const Reply plain = get("/api/spec");
  const json net = plain.json().at("analysis").at("net");
  EXPECT_EQ(net.at("agents").size(), 2000U);
  EXPECT_EQ(net.at("shapes").size(), 1U);
  EXPECT_EQ(net.at("shapes")[0].at("memory").size(), 2U) << "it reads from one robot and writes to another";
  EXPECT_LT(plain.body.size(), 1'000'000U);
  Headers headers = own_headers();
  headers.emplace("Accept-Encoding", "gzip");
  const Reply packed = ask_with(headers, "GET", "/api/spec", {});
  EXPECT_EQ(packed.headers.find("Content-Encoding")->second, "gzip");
  EXPECT_LT(packed.body.size(), 150'000U);
}

TEST_F(Api, APortThatIsTakenLeadsToTheNext) {
  serve();
  options_.port = port_;
  const server::Studio second(options_);
  EXPECT_GT(second.port(), port_);
  EXPECT_NE(second.token(), token_);
  options_.tries = 1;
  EXPECT_THROW(server::Studio{options_}, std::runtime_error);
}

}  // namespace tessera::server_test
