#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <memory>
#include <thread>
#include <vector>

#include "served.hpp"

namespace tessera::server_test {

using testing::HasSubstr;
using testing::Not;

class Hostile : public Served {
 protected:
  [[nodiscard]] bool still_serves() const { return get("/api/spec").status == 200; }
};

TEST_F(Hostile, EveryAddressOfTheApiNeedsTheToken) {
  serve();
  for (const char* path : {"/api/project", "/api/spec", "/api/events", "/api/verify/1", "/api/recordings",
                           "/api/runs", "/api/nothing"})
    for (const std::string& token : {std::string(), std::string("Bearer "), std::string("Bearer 0123"),
                                     "Bearer " + std::string(32, '0'), "Basic " + token_}) {
      Headers headers{{"Host", host()}};
      if (!token.empty()) headers.emplace("Authorization", token);
      EXPECT_EQ(ask_with(headers, "GET", path, {}).status, 401) << path << " with '" << token << "'";
    }
  EXPECT_EQ(ask_with({{"Host", host()}}, "PUT", "/api/spec", R"({"text":"","revision":""})").status, 401);
  for (const char* path : {"/api/trust", "/api/emergency_stop", "/api/emergency_reset", "/api/runs"})
    EXPECT_EQ(ask_with({{"Host", host()}}, "POST", path, "{}").status, 401) << path;
  EXPECT_EQ(ask_with({{"Host", host()}}, "GET", "/api/spec?token=" + token_, {}).status, 401)
      << "only the event stream takes the token from the address";
}

/// A project that came from elsewhere, with a note of its own that it is trusted.
TEST_F(Hostile, TheCodeOfAFolderRunsOnlyOnceTheUserTrustsIt) {
  const fs::path project = folder_ / "project";
  for (const char* const place : {".tessera/trusted", "trusted", ".tessera"})
    write(project / place / project::hash_of(project.string()), project.string() + "\n");
  serve();
  EXPECT_EQ(get("/api/project").json().at("trusted"), false);
  for (const char* kind : {"simulate", "run"}) {
    const Reply refused = post("/api/runs", {{"kind", kind}});
    EXPECT_EQ(refused.status, 403) << kind;
    EXPECT_THAT(refused.body, HasSubstr("not trusted"));
  }
  EXPECT_EQ(post("/api/runs", {{"kind", "attach"}, {"socket", "x.sock"}}).status, 400)
      << "it executes nothing of the folder";
  EXPECT_FALSE(fs::exists(project / ".tessera/generated"));
  EXPECT_EQ(post("/api/trust", nlohmann::json::object()).json().at("kept"), true);
  EXPECT_EQ(get("/api/project").json().at("trusted"), true);

  // Another folder of the same name is another one.
  studio_.reset();
  fs::rename(project, folder_ / "there");
  fs::create_directories(folder_ / "elsewhere");
  fs::rename(folder_ / "there", folder_ / "elsewhere/project");
  options_.spec = folder_ / "elsewhere/project/spec.yaml";
  serve();
  EXPECT_EQ(get("/api/project").json().at("trusted"), false);
  // The answer counts until the server ends where no note of it can be kept.
  fs::remove_all(folder_ / "user");
  write(folder_ / "user", "");  // the server must not see the environment change
  EXPECT_EQ(post("/api/trust", nlohmann::json::object()).json().at("kept"), false);
  EXPECT_EQ(get("/api/project").json().at("trusted"), true);
}

TEST_F(Hostile, AnExampleIsTrustedUnlessItsFolderHadCodeAlready) {
  const auto begins = [&](const std::string& name) {
    studio_.reset();
    options_.spec = folder_ / name / "spec.yaml";
    fs::create_directories(folder_ / name);
    serve();
    const std::string example = get("/api/examples").json().at(0).at("name");
    EXPECT_EQ(post("/api/begin", {{"example", example}}).status, 200);
    return get("/api/project").json().at("trusted").get<bool>();
  };
  options_.share = folder_ / "share";
  fs::create_directories(options_.share);
  for (const auto& entry : fs::directory_iterator(fs::path(TESSERA_SOURCE_DIR) / "share/tessera"))
    fs::create_symlink(entry.path(), options_.share / entry.path().filename());
  if (!fs::exists(options_.share / "examples"))
    fs::create_symlink(fs::path(TESSERA_SOURCE_DIR) / "examples", options_.share / "examples");
  EXPECT_TRUE(begins("new"));
  write(folder_ / "old/project.cmake", "execute_process(COMMAND true)");
  EXPECT_FALSE(begins("old"));
}

TEST_F(Hostile, ASpecificationThatThePageBeginsIsTrustedUnlessThereWasCodeOrAnother) {
  const std::string text =
      "tessera: 1\nsystem: own\nagents: { robot: { control: { rate: 1 Hz, behaviours: { run: } } } }\n";
  const auto begins = [&](const std::string& name) {
    studio_.reset();
    options_.spec = folder_ / name / "spec.yaml";
    fs::create_directories(folder_ / name);
    serve();
    const std::string revision = get("/api/spec").json().at("revision");
    EXPECT_EQ(put("/api/spec", {{"text", text}, {"revision", revision}}).status, 200);
    return get("/api/project").json().at("trusted").get<bool>();
  };
  EXPECT_TRUE(begins("empty"));
  write(folder_ / "code/src/control.cpp", "");
  EXPECT_FALSE(begins("code"));
  write(folder_ / "other/spec.yaml", text + "# of others\n");
  EXPECT_FALSE(begins("other"));
}

TEST_F(Hostile, ForeignOriginsAndHostsAreRefused) {
  serve();
  const std::string own = "http://" + host();
  for (const std::string& origin : {std::string("http://evil.example"), std::string("null"),
                                    "https://" + host(), own + ".evil.example", own + "/", own + "0"}) {
    Headers headers = own_headers();
    headers.emplace("Origin", origin);
    EXPECT_EQ(ask_with(headers, "GET", "/api/spec", {}).status, 403) << origin;
  }
  for (const std::string& name : {std::string("evil.example"), "evil.example:" + host().substr(10),
                                  std::string("127.0.0.1"), std::string("127.0.0.1:1"), std::string()}) {
    Headers headers{{"Host", name}, {"Authorization", "Bearer " + token_}};
    EXPECT_EQ(ask_with(headers, "GET", "/api/spec", {}).status, 403) << name;
    EXPECT_EQ(ask_with(headers, "GET", "/", {}).status, 403) << name;
  }
  EXPECT_EQ(ask_with({{"Authorization", "Bearer " + token_}}, "GET", "/api/spec", {}).status, 403);
  Headers cross = own_headers();
  cross.emplace("Sec-Fetch-Site", "cross-site");
  EXPECT_EQ(ask_with(cross, "GET", "/api/spec", {}).status, 403);
  Headers here = own_headers();
  here.emplace("Origin", own);
  here.emplace("Sec-Fetch-Site", "same-origin");
  EXPECT_EQ(ask_with(here, "GET", "/api/spec", {}).status, 200);
}

TEST_F(Hostile, NothingOutsideThePageAndTheProjectIsRead) {
  write(options_.page / "index.html", "page");
  write(folder_ / "secret.txt", "SECRET");
  fs::create_symlink(folder_ / "secret.txt", options_.page / "link.txt");
  serve();
  for (const char* path :
       {"/../secret.txt", "/..%2fsecret.txt", "/%2e%2e/secret.txt", "/%2e%2e%2fsecret.txt", "//etc/passwd",
        "/link.txt", "/%00", "/index.html%00.txt", "/..\\secret.txt", "/api/recordings/..%2f..%2fsecret.txt",
        "/api/recordings/../secret.txt", "/api/recordings/%2e%2e", "/api/recordings/%2fetc%2fpasswd", "/.",
        "/..", "/assets/../../secret.txt"}) {
    const Reply reply = get(path);
    EXPECT_NE(reply.status, 200) << path;
    EXPECT_THAT(reply.body, Not(HasSubstr("SECRET"))) << path;
  }
  EXPECT_TRUE(still_serves());
}

TEST_F(Hostile, ASpecificationThatBecomesALinkIsNotFollowed) {
  write(folder_ / "secret.txt", "SECRET");
  serve();
  fs::remove(spec());
  fs::create_symlink(folder_ / "secret.txt", spec());
  const Reply reply = get("/api/spec");
  EXPECT_THAT(reply.body, Not(HasSubstr("SECRET")));
  EXPECT_EQ(put("/api/spec", {{"text", "x"}, {"revision", reply.json().at("revision")}}).status, 500);
  EXPECT_EQ(content_of(folder_ / "secret.txt"), "SECRET");
}

TEST_F(Hostile, WhatIsNoJsonOfTheRightFormIsRefused) {
  serve();
  const std::string deep = std::string(100'000, '[');
  for (const std::string& body :
       {std::string("{"), std::string("[]"), std::string("null"), std::string(R"({"text":1})"),
        std::string(R"({"text":"a"})"), std::string("\xff\xfe"), deep, std::string(R"({"revision":"a"})"),
        std::string(R"({"text":["a"],"revision":"a"})")}) {
    const Reply reply = ask("PUT", "/api/spec", body);
    EXPECT_EQ(reply.status, 400) << body.substr(0, 40);
    EXPECT_TRUE(reply.json().contains("error")) << body.substr(0, 40);
  }
  EXPECT_EQ(ask("PUT", "/api/spec", {}).status, 400);
  EXPECT_TRUE(still_serves());
}

TEST_F(Hostile, ABodyOfAGigabyteIsRefusedBeforeItIsRead) {
  serve();
  const int socket = connect_to(port_);
  ASSERT_TRUE(send_all(socket, "PUT /api/spec HTTP/1.1\r\nHost: " + host() + "\r\nAuthorization: Bearer " +
                                   token_ + "\r\nContent-Length: 1073741824\r\n\r\n"));
  const std::string piece(1U << 20U, 'x');
  std::size_t sent = 0;
  while (sent < 1024 && send_all(socket, piece)) ++sent;
  EXPECT_LT(sent, 1024U) << "all of it was taken";
  close(socket);
  EXPECT_EQ(ask_with(
                [this] {
                  Headers headers = own_headers();
                  headers.emplace("Content-Length", "1073741824");
                  return headers;
                }(),
                "PUT", "/api/spec", {})
                .status,
            413);
  EXPECT_TRUE(still_serves());
}

TEST_F(Hostile, BodiesThatWouldGrowAreRefused) {
  serve();
  const auto with = [this](const char* name, const std::string& value) {
    Headers headers = own_headers();
    headers.emplace(name, value);
    return headers;
  };
  EXPECT_EQ(ask_with(with("Transfer-Encoding", "chunked"), "PUT", "/api/spec", {}).status, 411);
  EXPECT_EQ(ask_with(with("Content-Encoding", "gzip"), "PUT", "/api/spec", "x").status, 415);
  EXPECT_EQ(ask_with(with("Range", "bytes=0-1"), "GET", "/", {}).status, 416);
  std::string ranges = "bytes=0-0";
  while (ranges.size() < 7000) ranges += ",0-0";
  EXPECT_NE(ask_with(with("Range", ranges), "GET", "/", {}).status, 200);
  EXPECT_EQ(get("/" + std::string(4000, 'a')).status, 414);
  EXPECT_NE(get("/" + std::string(100'000, 'a')).status, 200);
  EXPECT_NE(ask_with(with("X", std::string(1'000'000, 'a')), "GET", "/", {}).status, 200);
  EXPECT_TRUE(still_serves());
}

TEST_F(Hostile, ManyHeadersAreBounded) {
  serve();
  const int socket = connect_to(port_);
  send_all(socket, "GET / HTTP/1.1\r\n");
  std::size_t sent = 0;
  const std::string header = "X-Y: " + std::string(1000, 'z') + "\r\n";
  while (sent < 100'000 && send_all(socket, header)) ++sent;
  EXPECT_LT(sent, 100'000U);
  close(socket);
  EXPECT_TRUE(still_serves());
}

TEST_F(Hostile, SlowClientsLoseTheirConnectionAndHoldNobodyUp) {
  options_.limits.workers = 4;
  options_.limits.read = std::chrono::milliseconds(300);
  serve();
  std::vector<int> slow;
  for (int one = 0; one < 12; ++one) {
    slow.push_back(connect_to(port_));
    send_all(slow.back(), "GET /api/spec HTTP/1.1\r\nHost: ");
  }
  EXPECT_TRUE(still_serves());  // after they were thrown out
  for (const int socket : slow) {
    EXPECT_THAT(receive_all(socket), Not(HasSubstr("200")));  // and it ends
    close(socket);
  }
}

TEST_F(Hostile, OneWhoReadsNothingLosesItsConnection) {
  options_.limits.workers = 1;
  options_.limits.write = std::chrono::milliseconds(300);
  write(options_.page / "big.txt", std::string(std::size_t{64} << 20U, 'x'));
  serve();
  const int socket = connect_to(port_);
  send_all(socket, "GET /big.txt HTTP/1.1\r\nHost: " + host() + "\r\n\r\n");
  EXPECT_TRUE(still_serves());
  close(socket);
}

TEST_F(Hostile, AThousandConnectionsAreServedOrRefused) {
  rlimit files{};
  getrlimit(RLIMIT_NOFILE, &files);
  files.rlim_cur = std::min<rlim_t>(files.rlim_max, 8192);
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &files), 0);
  options_.limits.read = std::chrono::milliseconds(1000);
  serve();
  std::vector<int> sockets;
  for (int one = 0; one < 1000; ++one)
    if (const int socket = connect_to(port_); socket >= 0) sockets.push_back(socket);
  EXPECT_GT(sockets.size(), 900U);
  int refused = 0;
  for (const int socket : sockets) {
    if (receive_all(socket).find(" 503 ") != std::string::npos) ++refused;
    close(socket);
  }
  EXPECT_GT(refused, 0);
  EXPECT_TRUE(still_serves());
}

}  // namespace tessera::server_test
