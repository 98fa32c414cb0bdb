#include "bag/live_bag.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include "../eventually.hpp"
#include "bag/bag_reader.hpp"
#include "made_run.hpp"
#include "mcap/reader.hpp"

/// Bags that are written while the recording grows.
namespace tessera::bag::test {
namespace {

namespace fs = std::filesystem;

class LiveBagOfTest : public ::testing::Test {
 protected:
  LiveBagOfTest() { fs::create_directories(folder_); }
  ~LiveBagOfTest() override { fs::remove_all(folder_); }
  void record(const std::string& bytes) const {
    std::ofstream(recording_, std::ios::binary | std::ios::app) << bytes;
  }
  [[nodiscard]] std::string bytes() const {
    std::string error;
    return bytes_of_file(bag_, error).value_or("");
  }

  const fs::path folder_ = fs::path(::testing::TempDir()) / ("live_bag_" + std::to_string(getpid()));
  const std::string recording_ = (folder_ / "run.tsr").string(), bag_ = (folder_ / "run.mcap").string();
};

TEST_F(LiveBagOfTest, IsReadableWhileTheRunGoesOnAndCompleteAfterIt) {
  const Recording run = made_recording();
  LiveBag live(recording_, bag_, background(), "a test");
  record(file_start(header));
  for (const Recording::Entry& entry : run.entries) record(file_bytes(raw_of(entry)));
  const auto messages = [&] { return mcap::read(bytes(), {}).messages; };
  ASSERT_TRUE(eventually([&] { return messages() > run.entries.size(); }));
  std::string error;
  std::optional<Bag> bag = read_bag_bytes(bytes(), error);
  ASSERT_TRUE(bag) << error;
  EXPECT_FALSE(bag->condition.is_complete);
  EXPECT_TRUE(bag->recording.truncated);
  EXPECT_EQ(bag->differences, std::vector<std::string>());
  EXPECT_EQ(bag->recording.entries.size(), run.entries.size());

  record(raw_end(1, 0));
  EXPECT_EQ(live.finish(), "");
  bag = read_bag_bytes(bytes(), error);
  ASSERT_TRUE(bag) << error;
  EXPECT_TRUE(bag->condition.is_whole()) << bag->condition.told();
  EXPECT_FALSE(bag->recording.truncated);
  EXPECT_EQ(bag->differences, std::vector<std::string>());
}

TEST_F(LiveBagOfTest, FullDiskIsToldAndTheRestOfTheRecordingIsRead) {
  record(file_start(header));
  LiveBag live(recording_, "/dev/full", background(), "a test");
  for (const Recording::Entry& entry : made_recording().entries) record(file_bytes(raw_of(entry)));
  const std::string problem = live.finish();
  EXPECT_NE(problem.find("cannot write /dev/full: No space left on device"), std::string::npos) << problem;
}

TEST_F(LiveBagOfTest, RunThatLeftNothingHasNoBag) {
  LiveBag live(recording_, bag_, background(), "a test");
  EXPECT_EQ(live.finish(), "the run left no recording, so there is no bag");
  EXPECT_FALSE(fs::exists(bag_));
}

}  // namespace
}  // namespace tessera::bag::test
