#pragma once

#include <gmock/gmock.h>

#include <atomic>
#include <cstdlib>
#include <future>
#include <thread>

#include "../eventually.hpp"
#include "project/process/process.hpp"
#include "served.hpp"

namespace tessera::server_test {

using nlohmann::json;
using testing::HasSubstr;

/// A program that was started elsewhere.
class Elsewhere {
 public:
  explicit Elsewhere(const project::Command& words)
      : running_([this, words] {
          exit_ = project::capture_apart(words, enough_);
          over_ = true;
        }) {}
  ~Elsewhere() { static_cast<void>(stop()); }
  [[nodiscard]] bool runs() const { return !over_; }
  /// How it ended.
  [[nodiscard]] std::string stop() {
    enough_ = true;
    if (running_.joinable()) running_.join();
    return exit_.text;
  }

 private:
  std::atomic<bool> enough_{false}, over_{false};
  project::Exit exit_;
  std::thread running_;  // the last: it uses the others
};

/// `tessera studio` itself, because controllers are built with the files installed beside it. The tests share
/// one folder, one after the other, in which the controller is built once.
class RunOfTheStudio : public Served {
 protected:
  /// folder: of the build. project: of the source; empty: the line follower.
  explicit RunOfTheStudio(const fs::path& folder = "tests/studio_runs", const fs::path& project = {})
      : Served(TESSERA_BINARY_DIR / folder) {
    if (!project.empty()) mirror(TESSERA_SOURCE_DIR / project, folder_ / "project");
    keep_ = true;
    forget_runs();
    // Sockets of other controllers, which come and go, are not of this test's world.
    fs::remove_all(sockets_);
    fs::create_directories(sockets_ / "tessera");
    fs::permissions(sockets_ / "tessera", fs::perms::owner_all);
    setenv("XDG_RUNTIME_DIR", sockets_.c_str(), 1);
    std::promise<std::string> url;
    std::future<std::string> printed = url.get_future();
    command_ = std::thread([this, &url] {
      bool first = true;
      static_cast<void>(
          project::capture_apart({TESSERA_BINARY_DIR "/tessera", "studio", (folder_ / "project").string(),
                                  "--port", "0", "--no-browser"},
                                 stop_, [&](std::string_view line) {
                                   if (line.starts_with("http://") && std::exchange(first, false))
                                     url.set_value(std::string(line));
                                 }));
    });
    const std::string address = printed.get();
    const std::size_t colon = address.rfind(':');
    port_ = std::stoi(address.substr(colon + 1));
    token_ = address.substr(address.find("token=") + 6);
    events_ = std::make_unique<EventStream>(port_, token_);
    EXPECT_FALSE(events_->next("hello").is_null());
    EXPECT_EQ(post("/api/trust", json::object()).json().at("kept"), true);
  }
  ~RunOfTheStudio() override {
    stop_ = true;
    command_.join();
    forget_runs();
    fs::remove_all(sockets_);
  }
  void forget_runs() const {
    for (const char* runs : {"runs", "last"}) fs::remove_all(folder_ / "project/.tessera" / runs);
  }

  std::string start(const json& request) {
    const Reply reply = post("/api/runs", request);
    EXPECT_EQ(reply.status, 202) << reply.body;
    return reply.json().at("run");
  }
  int control(const std::string& run, const json& command) {
    return post("/api/runs/" + run + "/control", command).status;
  }
  json await_state(const std::string& run, const std::string& state) {
    return events_->next(
        "run", [&](const json& data) { return data.at("run") == run && data.at("state") == state; });
  }
  json info(const std::string& run) { return get("/api/runs/" + run).json(); }
  std::uint32_t place(const std::string& name) {
    // Those of the system come first, then those of each agent (FoldedNet of net.schema.json).
    const json net = get("/api/spec").json().at("analysis").at("net");
    std::size_t first = net.at("system").at("places").size();
    for (const json& agent : net.at("agents")) {
      const json& places = net.at("shapes").at(agent.at("shape").get<std::size_t>()).at("places");
      for (std::size_t index = 0; index < places.size(); ++index)
        if (agent.at("name").get<std::string>() + "." + places[index].at("name").get<std::string>() == name)
          return static_cast<std::uint32_t>(first + index);
      first += places.size();
    }
    ADD_FAILURE() << "no place " << name;
    return 0;
  }

  std::string await_controller() {
    json names = json::array();
    EXPECT_TRUE(eventually([&] { return !(names = get("/api/controllers").json()).empty(); }));
    return names.empty() ? "" : names.at(0).get<std::string>();
  }
  /// The server's report on a run, once `wanted` holds for it. null: the run ends first, or takes too long.
  json await_info(const std::string& run, const std::function<bool(const json&)>& wanted) {
    json now;
    const auto look = [&] { return wanted(now = info(run)); };
    const auto is_over = [&] { return now.at("state") == "ended" || now.at("state") == "failed"; };
    return eventually(look, is_over) ? now : json();
  }

  const fs::path sockets_ = fs::temp_directory_path() / ("tessera_sockets_" + std::to_string(getpid()));
  std::atomic<bool> stop_{false};
  std::thread command_;
  std::unique_ptr<EventStream> events_;
};

}  // namespace tessera::server_test
