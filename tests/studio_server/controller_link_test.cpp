#include "server/runs/controller_link.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <utility>

#include "../eventually.hpp"
#include "served.hpp"
#include "tessera/monitor.hpp"

namespace tessera::server_test {

using server::ControllerLink;

/// A controller that sends the given lines.
class Link : public testing::Test {
 protected:
  Link() {
    file_ = (fs::temp_directory_path() / ("tessera_link_" + std::to_string(getpid()))).string();
    fs::remove(file_);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, file_.c_str(), file_.size() + 1);
    const int listening = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    EXPECT_EQ(bind(listening, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(listen(listening, 1), 0);
    EXPECT_TRUE(link_.connect(file_, /*own=*/false));
    controller_ = accept(listening, nullptr, nullptr);
    close(listening);
  }
  ~Link() override {
    if (controller_ >= 0) close(controller_);
    fs::remove(file_);
  }
  void say(const std::string& text) const { EXPECT_TRUE(send_all(controller_, text)); }
  static std::string piece(const std::string& bytes, bool begins = false) {
    return "{\"recording_bytes\":" + std::to_string(bytes.size()) +
           ",\"begins\":" + (begins ? "true" : "false") + ",\"more\":false}\n" + bytes;
  }
  [[nodiscard]] bool over() {
    return eventually([&] {
      static_cast<void>(link_.snapshot());
      return link_.is_over();
    });
  }
  void hang_up() { close(std::exchange(controller_, -1)); }

  ControllerLink link_;
  std::string file_;
  int controller_ = -1;
};

TEST_F(Link, ASnapshotIsNeverAheadOfTheRecordingThatCameBeforeIt) {
  say("{\"pid\":1}\n" + piece("a line\n{}\n", true) + "{\"pid\":2}\n");
  EXPECT_EQ(link_.snapshot().value().pid, 1);
  EXPECT_FALSE(link_.snapshot());
  const GrowingRecording::Piece first = link_.recording();
  EXPECT_EQ(first.bytes, "a line\n{}\n");
  EXPECT_TRUE(first.begins);
  EXPECT_EQ(link_.snapshot().value().pid, 2);
}

TEST_F(Link, AsksAgainOnlyWhenItHasGotWhatItAskedFor) {
  EXPECT_TRUE(link_.recording().more);
  EXPECT_TRUE(link_.recording().more);
  say(piece("one"));
  EXPECT_EQ(link_.recording().bytes, "one");
  EXPECT_TRUE(link_.recording().more);
  std::array<char, 1000> asked{};
  const ssize_t count = recv(controller_, asked.data(), asked.size(), 0);
  EXPECT_EQ(std::count(asked.begin(), asked.begin() + count, '\n'), 2);
}

TEST_F(Link, WhatComesWithTheEndIsHadAfterIt) {
  EXPECT_TRUE(link_.recording().more);
  say(piece("a") + "{\"ended\":true}\n" + piece("b") + piece("c") + piece(""));
  hang_up();
  std::string all;
  for (bool more = true; more;) {
    const GrowingRecording::Piece piece = link_.recording();
    all += piece.bytes;
    more = piece.more;
  }
  EXPECT_EQ(all, "abc");
  EXPECT_TRUE(link_.is_over());
  EXPECT_TRUE(link_.has_ended());
}

TEST_F(Link, WithoutAWordItIsLost) {
  EXPECT_TRUE(link_.recording().more);
  say(piece("all of this").substr(0, 55));
  hang_up();
  ASSERT_TRUE(over());
  EXPECT_FALSE(link_.has_ended());
  EXPECT_FALSE(link_.recording().more);
}

TEST_F(Link, NonsenseEndsIt) {
  say("\xff\n[]\n\n3\n{\"recording_bytes\":" + std::to_string(longest_piece + 1) + "}\n");
  ASSERT_TRUE(over());
  EXPECT_FALSE(link_.has_ended());
}

TEST_F(Link, KnowsItsOwnMachine) {
  EXPECT_TRUE(link_.is_process(getpid()));
  EXPECT_FALSE(link_.is_process(1));
}

}  // namespace tessera::server_test
