#include "tessera/growing_recording.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "recorder/marking_track.hpp"
#include "recorder/recorder.hpp"
#include "test_system.hpp"

namespace fs = std::filesystem;

namespace tessera::testing {
namespace {

constexpr std::size_t plenty = std::size_t{1} << 20U;

/// A recording of one transition that fires from time to time.
class Growing : public ::testing::Test {
 protected:
  void record(RunOptions::Limit limit = {}) {
    FlatNet net;
    net.places = {{"a", 1}};
    net.transitions = {{"t", 0, {0}, {0}, ""}};
    std::string error;
    recorder_ = Recorder::open(file_, {"{\"run\":1}"}, 1, Recorder::Mode::direct, error, 0, limit,
                               std::make_unique<MarkingTrack>(net, std::vector<ChannelId>(1)));
    ASSERT_NE(recorder_, nullptr) << error;
  }
  void fire(int times) {
    for (int time = 0; time < times; ++time) recorder_->lane(0)->firing(Time{}, 0, 0);
    recorder_->flush();
  }

  const std::string file_ = scratch_file("run.tsr");
  std::unique_ptr<Recorder> recorder_;
};

/// The present content, file by file.
std::vector<std::string> files_of(GrowingRecording& growing, std::size_t most = plenty) {
  std::vector<std::string> files;
  for (GrowingRecording::Piece piece = growing.next(most); !piece.bytes.empty(); piece = growing.next(most)) {
    EXPECT_LE(piece.bytes.size(), most);
    if (piece.begins || files.empty()) files.emplace_back();
    files.back() += piece.bytes;
  }
  return files;
}

TEST_F(Growing, ComesAsItIsWrittenInPieces) {
  fs::remove(file_);
  GrowingRecording growing(file_, GrowingRecording::From::newest);
  EXPECT_TRUE(growing.next(plenty).bytes.empty());
  record();
  fire(10);
  GrowingRecording::Piece first = growing.next(100);
  EXPECT_EQ(first.bytes.size(), 100U);
  EXPECT_TRUE(first.begins);
  EXPECT_TRUE(first.more);
  std::string all = first.bytes + files_of(growing, 100).at(0);
  EXPECT_EQ(all, file_bytes(file_));
  fire(3);
  const GrowingRecording::Piece later = growing.next(plenty);
  EXPECT_EQ(later.bytes.size(), 3 * sizeof(Event));
  EXPECT_FALSE(later.begins);
  EXPECT_FALSE(later.more);
}

TEST_F(Growing, GoesOnInTheNextSegment) {
  record({3000, 5});
  fire(10);
  GrowingRecording growing(file_, GrowingRecording::From::newest);
  std::string first = files_of(growing).at(0);
  fire(300);
  const std::vector<std::string> files = files_of(growing, 500);
  ASSERT_EQ(files.size(), 3U);
  EXPECT_EQ(first + files[0], file_bytes(segment_path(file_, 0)));
  EXPECT_EQ(files[1], file_bytes(segment_path(file_, 1)));
  EXPECT_EQ(files[2], file_bytes(file_));
}

TEST_F(Growing, WhoIsTooSlowGoesOnWithTheNewest) {
  record({3000, 2});
  fire(10);
  GrowingRecording growing(file_, GrowingRecording::From::newest);
  EXPECT_FALSE(growing.next(plenty).bytes.empty());
  fire(1000);
  const std::vector<std::string> files = files_of(growing);
  ASSERT_EQ(files.size(), 2U);  // the rest of the one that it had open, though it is gone by now
  EXPECT_EQ(files[1], file_bytes(file_));
}

TEST_F(Growing, BeginsWithTheOldestSegmentOfItsRunIfItShall) {
  record({3000, 4});
  fire(1000);
  recorder_ = nullptr;
  GrowingRecording growing(file_, GrowingRecording::From::oldest);
  EXPECT_EQ(files_of(growing).size(), 4U);

  GrowingRecording newest(file_, GrowingRecording::From::newest);
  EXPECT_EQ(files_of(newest), std::vector{file_bytes(file_)});
  const std::string one = segment_path(file_, 7);
  ASSERT_TRUE(fs::exists(one));
  GrowingRecording numbered(one, GrowingRecording::From::oldest);
  EXPECT_EQ(files_of(numbered), std::vector{file_bytes(one)});

  std::string other = file_bytes(segment_path(file_, 7));
  other.replace(other.find("\"run\":1"), 7, "\"run\":2");
  std::ofstream(segment_path(file_, 7), std::ios::binary) << other;
  GrowingRecording shorter(file_, GrowingRecording::From::oldest);
  EXPECT_EQ(files_of(shorter).back(), file_bytes(file_));
  GrowingRecording again(file_, GrowingRecording::From::oldest);
  EXPECT_LT(files_of(again).size(), 4U);
}

TEST_F(Growing, NothingComesOfALinkOrOfSomethingElse) {
  std::ofstream(file_) << "something else entirely";
  GrowingRecording none(file_, GrowingRecording::From::newest);
  EXPECT_TRUE(none.next(plenty).bytes.empty());
  record();
  fs::remove(scratch_file("link.tsr"));
  fs::create_symlink(file_, scratch_file("link.tsr"));
  GrowingRecording link(scratch_file("link.tsr"), GrowingRecording::From::newest);
  EXPECT_TRUE(link.next(plenty).bytes.empty());
}

}  // namespace
}  // namespace tessera::testing
