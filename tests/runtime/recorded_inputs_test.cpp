#include "drivers/recorded_inputs.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>

#include "tessera/recording.hpp"

namespace tessera::testing {
namespace {

/// A file with one real input of the type int32.
class RecordedInputsOfTest : public ::testing::Test {
 protected:
  explicit RecordedInputsOfTest(const char* clock = "simulated") {
    std::string header = R"({"system": "s", "net_hash": "", "verification_hash": "", "seed": 0, "clock": ")";
    header +=
        clock + std::string(R"(", "instances": ["r.s"], "channels": [], "transitions": [], "behaviours": [[]],
                       "values": {"limit": 9, "buffers": [["r.s.x", 0, "real_in", "int32"]]}})");
    header.resize((header.size() + 12 + 7) / 8 * 8 - 12, ' ');
    const auto length = static_cast<std::uint32_t>(header.size());
    bytes_ = recording_magic;
    bytes_.append(reinterpret_cast<const char*>(&length), sizeof length);
    bytes_ += header;
  }
  ~RecordedInputsOfTest() override { std::filesystem::remove(file_); }

  void add(std::int64_t time_ns, std::uint32_t flags, std::optional<std::int32_t> value = std::nullopt) {
    Event event;
    event.time_ns = time_ns;
    event.subject = value ? sizeof *value : 0;
    event.version = flags << 24U;
    event.origin = static_cast<std::uint32_t>(Event::Kind::value);
    bytes_.append(reinterpret_cast<const char*>(&event), sizeof event);
    if (!value) return;
    bytes_.append(reinterpret_cast<const char*>(&*value), sizeof *value);
    bytes_.append(sizeof event - sizeof *value, '\0');
  }
  void read() {
    std::ofstream(file_, std::ios::binary) << bytes_;
    std::string error;
    inputs_ = RecordedInputs::read(file_, error);
    ASSERT_NE(inputs_, nullptr) << error;
    receptor_ = inputs_->receptor("r.s.x");
    const auto wrong = dynamic_cast<RecordedReceptor&>(*receptor_)
                           .follow(clock_, "r.s.x", value_encoding_of<std::int32_t>());
    EXPECT_FALSE(wrong) << wrong->text;
  }
  /// "5", "-" for no value, "!" for a device that throws.
  std::string at(std::int64_t time_ns) {
    clock_.set(Time(Duration(time_ns)));
    std::int32_t value = 0;
    try {
      return receptor_->read(std::as_writable_bytes(std::span(&value, 1))) ? std::to_string(value) : "-";
    } catch (const std::runtime_error&) {
      return "!";
    }
  }

  std::string file_ =
      (std::filesystem::path(::testing::TempDir()) / ("inputs" + std::to_string(getpid()))).string();
  std::string bytes_;
  SimulatedClock clock_;
  std::unique_ptr<RecordedInputs> inputs_;
  std::unique_ptr<RealReceptor> receptor_;
};
class BagInputsOfTest : public RecordedInputsOfTest {
 protected:
  BagInputsOfTest() : RecordedInputsOfTest("bag") {}
};

TEST_F(RecordedInputsOfTest, ValueOfARecordingStaysUntilTheNext) {
  add(10, ValueFlags::fresh, 5);
  add(20, ValueFlags::silent);
  add(30, ValueFlags::fresh | ValueFlags::same);
  add(40, ValueFlags::failed);
  add(50, ValueFlags::fresh, 7);
  read();
  EXPECT_EQ(at(9), "-");
  EXPECT_EQ(at(10), "5");
  EXPECT_EQ(at(11), "5");
  EXPECT_EQ(at(25), "-");
  EXPECT_EQ(at(30), "5");
  EXPECT_EQ(at(40), "!");
  EXPECT_EQ(at(100), "7");
}

TEST_F(BagInputsOfTest, MessageIsNewOnceAndTheNewestCounts) {
  add(20, ValueFlags::fresh, 6);
  add(10, ValueFlags::fresh, 5);
  add(30, ValueFlags::fresh, 7);
  read();
  EXPECT_EQ(at(10), "5");
  EXPECT_EQ(at(11), "-");
  EXPECT_EQ(at(30), "7");
  EXPECT_EQ(at(31), "-");
}

TEST_F(BagInputsOfTest, QueuedMessageComesBeforeAnyLaterOne) {
  add(10, ValueFlags::fresh, 5);
  add(20, ValueFlags::fresh | ValueFlags::queued, 6);
  add(20, ValueFlags::fresh | ValueFlags::queued, 7);
  add(20, ValueFlags::fresh, 8);
  add(30, ValueFlags::fresh, 9);
  read();
  for (const char* wanted : {"6", "7", "9", "-"}) EXPECT_EQ(at(40), wanted);
}

TEST_F(RecordedInputsOfTest, OtherTypesAreRefused) {
  add(10, ValueFlags::fresh, 5);
  read();
  const auto other = inputs_->receptor("r.s.x");
  const auto wrong =
      dynamic_cast<RecordedReceptor&>(*other).follow(clock_, "r.s.x", value_encoding_of<float>());
  ASSERT_TRUE(wrong);
  EXPECT_EQ(wrong->text, "r.s.x is int32 in the recorded inputs, and float32 in this controller");
}

TEST_F(RecordedInputsOfTest, LargeValuesThatAreNotInItAreRefused) {
  add(10, ValueFlags::hashed, 5);
  bytes_[bytes_.size() - 2 * sizeof(Event) + 8] = 16;  // number of bytes and hash
  std::ofstream(file_, std::ios::binary) << bytes_;
  std::string error;
  EXPECT_EQ(RecordedInputs::read(file_, error), nullptr);
  EXPECT_NE(error.find("the values of r.s.x are too large"), std::string::npos) << error;
}

}  // namespace
}  // namespace tessera::testing
