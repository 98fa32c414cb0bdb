#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "nets.hpp"
#include "tessera/bounded_sequence.hpp"
#include "tessera/bounded_string.hpp"
#include "tessera/fields.hpp"
#include "tessera/large_array.hpp"
#include "tessera/large_sequence.hpp"
#include "tessera/recording.hpp"
#include "tessera/value_encoding.hpp"
#include "tessera/value_text.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

// ------------------------------------------------------------------------------------------------ encoding

struct Point {
  std::int8_t x{};
  double y{};
  TESSERA_FIELDS(Point, x, y)
};
struct Scan {
  std::array<Point, 2> points{};
  BoundedString<8> label;
  bool flag{};
  std::array<std::uint16_t, 3> counts{};
  float share{};
  TESSERA_FIELDS(Scan, points, label, flag, counts, share)
};

[[nodiscard]] Scan a_scan() {
  Scan scan;
  scan.points = {Point{-3, 0.1}, Point{4, -1e300}};
  scan.label = "a, \"b\"";
  scan.flag = true;
  scan.counts = {1, 2, 65535};
  scan.share = 0.1F;
  return scan;
}

template <class T>
[[nodiscard]] std::string encoded(const T& value) {
  const ValueEncoding& encoding = *value_encoding_of<T>();
  ValueSink sink(encoding.most);
  encoding.put(&value, sink);
  EXPECT_TRUE(sink.whole());
  return {reinterpret_cast<const char*>(sink.bytes().data()), sink.bytes().size()};
}

TEST(ValueEncoding, SaysWhatATypeIsMadeOf) {
  EXPECT_EQ(value_encoding_of<double>()->type(), "float64");
  EXPECT_EQ(value_encoding_of<bool>()->type(), "bool");
  EXPECT_EQ((value_encoding_of<std::array<std::array<std::int16_t, 3>, 2>>()->type()), "int16[3][2]");
  EXPECT_EQ(
      value_encoding_of<Scan>()->type(),
      "{points: {x: int8, y: float64}[2], label: string(8), flag: bool, counts: uint16[3], share: float32}");
  EXPECT_EQ((value_encoding_of<LargeArray<float, 100>>()->type()), "float32[100]");
  EXPECT_EQ(value_encoding_of<std::vector<int>>(), nullptr);
}

TEST(ValueEncoding, LeavesThePaddingOut) {
  EXPECT_EQ(encoded(Point{1, 2}).size(), 9U);
  EXPECT_EQ(encoded(a_scan()).size(), 2 * 9 + 4 + 6 + 1 + 6 + 4U);
}

TEST(ValueEncoding, BringsValuesBack) {
  const std::string bytes = encoded(a_scan());
  Scan back;
  EXPECT_TRUE(value_encoding_of<Scan>()->take(&back, std::as_bytes(std::span(bytes))));
  EXPECT_EQ(back.points[1].y, -1e300);
  EXPECT_EQ(back.label, a_scan().label);
  EXPECT_EQ(back.counts, a_scan().counts);
  EXPECT_EQ(encoded(back), bytes);
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(value_encoding_of<Scan>()->take(&back, std::as_bytes(std::span(bytes).first(size))));
}

TEST(ValueEncoding, LargeArraysGoThereAndBack) {
  using Image = LargeArray<std::uint8_t, 70'000>;
  Image image, back;
  image[69'999] = 7;
  const std::string bytes = encoded(image);
  EXPECT_TRUE(value_encoding_of<Image>()->take(&back, std::as_bytes(std::span(bytes))));
  EXPECT_TRUE(back == image);
}

struct Detections {
  BoundedSequence<Point, 3> boxes;
  BoundedSequence<BoundedString<4>, 2> names;
  LargeSequence<float, 2000> ranges;
  TESSERA_FIELDS(Detections, boxes, names, ranges)
};

TEST(BoundedSequence, IsAVectorThatRefusesWhatItCannotHold) {
  using Four = BoundedSequence<double, 4>;
  static_assert(std::is_trivially_copyable_v<Four>);
  Four numbers{1, 2};
  numbers.push_back(3);
  EXPECT_EQ(numbers, (Four{1, 2, 3}));
  EXPECT_EQ(numbers.size(), 3U);
  EXPECT_EQ(std::accumulate(numbers.begin(), numbers.end(), 0.0), 6);
  EXPECT_EQ(numbers.back(), 3);
  EXPECT_THROW(static_cast<void>(numbers[3]), std::out_of_range);
  numbers.push_back(numbers.front());
  EXPECT_TRUE(numbers.full());
  EXPECT_THROW(numbers.push_back(5), std::length_error);
  EXPECT_THROW(numbers.resize(5), std::length_error);
  EXPECT_EQ(numbers, (Four{1, 2, 3, 1})) << "as it was";
  numbers.resize(1);
  numbers.resize(2);
  EXPECT_EQ(numbers, (Four{1, 0})) << "new elements are zero";
  numbers.pop_back();
  numbers.clear();
  numbers.pop_back();
  EXPECT_TRUE(numbers.empty());
  EXPECT_THROW(static_cast<void>(numbers.front()), std::out_of_range);
  EXPECT_THROW(static_cast<void>(numbers.back()), std::out_of_range);
  EXPECT_TRUE(std::all_of(numbers.data(), numbers.data() + 4, [](double one) { return one == 0; }))
      << "nothing is left of what was removed";
  EXPECT_THROW((Four{1, 2, 3, 4, 5}), std::length_error);
}

TEST(BoundedSequence, OfManyElementsSharesThemAmongCopies) {
  LargeSequence<float, 2000> image;
  image.resize(1000);
  image[7] = 7;
  const LargeSequence<float, 2000> copy = image;
  image[7] = 8;
  EXPECT_EQ(copy[7], 7);
  EXPECT_EQ(std::as_const(image).data()[7], 8);
  EXPECT_FALSE(copy == image);
  image[7] = 7;
  EXPECT_TRUE(copy == image);
}

TEST(ValueEncoding, SequencesGoThereAndBackWithTheirLength) {
  const ValueEncoding& encoding = *value_encoding_of<Detections>();
  EXPECT_EQ(encoding.type(),
            "{boxes: {x: int8, y: float64}[<=3], names: string(4)[<=2], ranges: float32[<=2000]}");
  const auto layout = ValueLayout::parse(encoding.type());
  ASSERT_TRUE(layout);
  Detections value;
  EXPECT_EQ(layout->shown(encoded(value)), "{boxes: [], names: [], ranges: []}");
  EXPECT_EQ(encoded(value).size(), 12U);
  value.boxes = {{1, 2}, {3, 4}};
  value.names = {"ab"};
  value.ranges.resize(2);
  EXPECT_EQ(layout->shown(encoded(value)),
            "{boxes[0].x: 1, boxes[0].y: 2, boxes[1].x: 3, boxes[1].y: 4, names[0]: \"ab\", ranges[0]: 0, "
            "ranges[1]: 0}");
  for (std::size_t length = 0; length <= 3; ++length) {
    value.boxes.resize(length);
    Detections back;
    back.boxes = {{9, 9}, {9, 9}};
    const std::string bytes = encoded(value);
    ASSERT_TRUE(encoding.take(&back, std::as_bytes(std::span(bytes)))) << length;
    EXPECT_EQ(encoded(back), bytes) << length;
    EXPECT_EQ(back.boxes.size(), length);
    EXPECT_FALSE(encoding.take(&back, std::as_bytes(std::span(bytes).first(bytes.size() - 1))));
    EXPECT_FALSE(layout->visit(bytes + 'x', [](const auto&, const auto&) {}));
  }
  value.boxes.resize(3);
  value.names.resize(2);
  value.ranges.resize(2000);
  EXPECT_LE(encoded(value).size(), encoding.most);
  EXPECT_EQ(layout->sequences(), (std::vector<std::string>{"boxes", "names", "ranges"}));
  EXPECT_EQ(layout->scalars(), 6U + 2U + 2000U);
  EXPECT_EQ(layout->paths().size(), layout->scalars());
}

struct Track {
  BoundedSequence<Detections, 2> views;
  TESSERA_FIELDS(Track, views)
};

TEST(ValueEncoding, SequencesInTheElementsOfSequencesGoThereAndBack) {
  using Tracks = BoundedSequence<Track, 3>;
  const ValueEncoding& encoding = *value_encoding_of<Tracks>();
  const auto layout = ValueLayout::parse(encoding.type());
  ASSERT_TRUE(layout);
  EXPECT_TRUE(layout->has_sequences());
  EXPECT_EQ(layout->sequences().size(), 1U + 3U * (1U + 2U * 3U));
  Tracks value, back;
  value.resize(2);
  value[1].views.resize(2);
  value[1].views[1].boxes = {{1, 2}};
  value[1].views[1].names = {"ab"};
  EXPECT_EQ(layout->shown(encoded(value)),
            "{[0].views: [], [1].views[0].boxes: [], [1].views[0].names: [], [1].views[0].ranges: [], "
            "[1].views[1].boxes[0].x: 1, [1].views[1].boxes[0].y: 2, [1].views[1].names[0]: \"ab\", "
            "[1].views[1].ranges: []}");
  const std::string bytes = encoded(value);
  back.resize(3);
  back[2].views.resize(1);
  ASSERT_TRUE(encoding.take(&back, std::as_bytes(std::span(bytes))));
  EXPECT_EQ(encoded(back), bytes);
  back.resize(3);
  EXPECT_TRUE(back[2].views.empty()) << "nothing of a former element";
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(encoding.take(&back, std::as_bytes(std::span(bytes).first(size)))) << size;
}

TEST(ValueEncoding, OfSequencesRefusesLengthsThatAreTooGreat) {
  std::string bytes("\4\0\0\0", 4);
  bytes.append(4 * sizeof(double), '\0');
  BoundedSequence<double, 3> value;
  EXPECT_FALSE(value_encoding_of<decltype(value)>()->take(&value, std::as_bytes(std::span(bytes))));
  const auto layout = ValueLayout::parse("float64[<=3]");
  ASSERT_TRUE(layout);
  EXPECT_FALSE(layout->visit(bytes, [](const auto&, const auto&) {}));
  EXPECT_EQ(ValueLayout::parse("float64[<=4]")->shown(bytes), "{[0]: 0, [1]: 0, [2]: 0, [3]: 0}");
  for (const char* text : {"float64[<=", "float64[<=]", "float64[<3]", "float64[<=3", "bool[<=99999999999]"})
    EXPECT_FALSE(ValueLayout::parse(text)) << text;
}

TEST(ValueSink, OfWhatDoesNotFitTellsSizeAndAHashOfEveryByte) {
  const auto hash_of = [](const LargeArray<double, 1000>& value) {
    ValueSink sink(4096);
    value_encoding_of<LargeArray<double, 1000>>()->put(&value, sink);
    EXPECT_FALSE(sink.whole());
    EXPECT_EQ(sink.size(), 8000U);
    return sink.hash();
  };
  LargeArray<double, 1000> value;
  const std::uint64_t zero = hash_of(value);
  EXPECT_EQ(hash_of(value), zero);
  for (const std::size_t at : {0, 1, 511, 512, 999}) {
    LargeArray<double, 1000> other = value;
    other[at] = 1;
    EXPECT_NE(hash_of(other), zero) << at;
  }
}

TEST(ValueSink, HashesSmallPiecesAsWell) {
  std::array<Point, 100> points{};
  ValueSink one(64), other(64);
  value_encoding_of<std::array<Point, 100>>()->put(&points, one);
  value_encoding_of<std::array<Point, 100>>()->put(&points, other);
  EXPECT_TRUE(one == other);
  points[57].x = 1;
  other.clear();
  value_encoding_of<std::array<Point, 100>>()->put(&points, other);
  EXPECT_FALSE(one == other);
}

// ------------------------------------------------------------------------------------------------ reading

TEST(ValueLayout, ReadsWhatWasEncoded) {
  const auto layout = ValueLayout::parse(value_encoding_of<Scan>()->type());
  ASSERT_TRUE(layout);
  EXPECT_EQ(
      layout->shown(encoded(a_scan())),
      "{points[0].x: -3, points[0].y: 0.1, points[1].x: 4, points[1].y: -1e+300, label: \"a, \"b\"\", flag: "
      "true, counts[0]: 1, counts[1]: 2, counts[2]: 65535, share: 0.1}");
  std::vector<std::string> visited;
  EXPECT_TRUE(layout->visit(encoded(a_scan()),
                            [&](const std::string& path, const auto&) { visited.push_back(path); }));
  EXPECT_EQ(visited, layout->paths());
}

TEST(ValueLayout, OfEveryScalar) {
  const auto shown = [](const auto& value) {
    return ValueLayout::parse(value_encoding_of<std::remove_cvref_t<decltype(value)>>()->type())
        ->shown(encoded(value));
  };
  EXPECT_EQ(shown(std::numeric_limits<std::int64_t>::min()), "-9223372036854775808");
  EXPECT_EQ(shown(std::numeric_limits<std::uint64_t>::max()), "18446744073709551615");
  EXPECT_EQ(shown(std::int8_t{-1}), "-1");
  EXPECT_EQ(shown(std::uint16_t{65535}), "65535");
  EXPECT_EQ(shown(false), "false");
  EXPECT_EQ(shown(std::numeric_limits<double>::quiet_NaN()), "nan");
  EXPECT_EQ(shown(BoundedString<4>("ab")), "\"ab\"");
}

TEST(ValueLayout, RefusesWhatIsNoType) {
  for (const char* text : {"", "int", "int7", "float16", "string", "string(", "{a: bool", "{a bool}", "bool[",
                           "bool[3", "bool[3]x", "[3]", "{}[5]", "bool[99999999999]", "bool[65536][65536]"})
    EXPECT_FALSE(ValueLayout::parse(text)) << text;
  EXPECT_FALSE(ValueLayout::parse(std::string(100'000, '{')));
  std::string deep;
  for (int level = 0; level < 1000; ++level) deep += "{a: ";
  EXPECT_FALSE(ValueLayout::parse(deep));
}

TEST(ValueLayout, SaysWhenTheBytesAreOthers) {
  const auto layout = ValueLayout::parse("{a: int32, b: string(4)}");
  ASSERT_TRUE(layout);
  const std::string bytes("\1\0\0\0\2\0\0\0ab", 10);
  EXPECT_TRUE(layout->visit(bytes, [](const auto&, const auto&) {}));
  EXPECT_FALSE(layout->visit(bytes + 'x', [](const auto&, const auto&) {}));
  EXPECT_FALSE(layout->visit(bytes.substr(0, 9), [](const auto&, const auto&) {}));
  EXPECT_FALSE(layout->visit("\1\0\0\0\5\0\0\0abcde", [](const auto&, const auto&) {}));
}

// ------------------------------------------------------------------------------------------------ recordings

/// ValuesByBuffer of each buffer in order: "3 fresh", as shown; "-": silent.
using ValuesByBuffer = std::map<std::string, std::vector<std::string>>;

[[nodiscard]] ValuesByBuffer values_of(const Recording& recording) {
  ValuesByBuffer values;
  std::map<std::uint32_t, std::string> last;
  for (const Recording::Entry& entry : recording.entries) {
    if (entry.event.kind() != Event::Kind::value) continue;
    const ValueEvent value = value_of(entry);
    const Recording::Buffer& buffer = recording.buffers.at(value.buffer);
    EXPECT_EQ(buffer.instance, entry.event.instance());
    const auto layout = ValueLayout::parse(buffer.type);
    std::string text = value.has(ValueFlags::silent)   ? "-"
                       : value.has(ValueFlags::failed) ? "failed"
                       : value.has(ValueFlags::same)   ? last[value.buffer]
                                                       : layout->shown(value.bytes);
    if (!value.has(ValueFlags::silent | ValueFlags::failed)) last[value.buffer] = text;
    if (value.has(ValueFlags::stamped))
      text += fmt::format(" of {} ms", value.stamp_ns / 1'000'000) +
              (value.has(ValueFlags::valid) ? "" : " invalid");
    values[buffer.path + ' ' + std::string(name_of(buffer.direction))].push_back(text);
  }
  return values;
}

[[nodiscard]] Recording recorded(TestSystem& system, RunOptions options) {
  options.recording = scratch_file("run");
  static_cast<void>(run(system, options));
  std::string error;
  auto recording = read_recording(options.recording, error);
  EXPECT_TRUE(recording) << error;
  EXPECT_FALSE(recording->truncated);
  return recording.value_or(Recording{});
}

TEST(RecordedValues, AreThoseThatChange) {
  TestSystem system;
  Script sender, receiver;
  sender.call = [](ScriptState& state) { state.out_x = static_cast<double>(state.context.iteration / 2); };
  receiver.call = [](ScriptState& state) { state.command = state.x * 10; };
  receiver.acts = true;
  const auto a = system.add("robot.a", nets::nb_sender, sender, 10ms);
  const auto b = system.add("robot.b", nets::b_receiver, receiver);
  system.connect(a, "x", b, "x", buffered);
  const ValuesByBuffer values = values_of(recorded(system, simulated(35ms)));
  EXPECT_EQ(values.at("robot.a.x out"), (std::vector<std::string>{"0", "1"}));
  EXPECT_EQ(values.at("robot.b.x in"),
            (std::vector<std::string>{"0 of 0 ms", "0 of 10 ms", "1 of 20 ms", "1 of 30 ms"}));
  EXPECT_EQ(values.at("robot.b.command real_out"), (std::vector<std::string>{"0", "10"}));
  EXPECT_EQ(values.at("robot.a.y out"), (std::vector<std::string>{"0"}));
  EXPECT_FALSE(values.contains("robot.a.x in"));
}

TEST(RecordedValues, OfARealInputSayWhenThereWasNone) {
  TestSystem system;
  Script sensor;
  sensor.senses = true;
  int reads = 0;
  system.devices.sense = [&](double& value) {
    value = 5;
    ++reads;
    if (reads == 6) throw std::runtime_error("unplugged");
    return reads != 3 && reads != 4;
  };
  sensor.decide = [](const ScriptState&) { return Outcome::go_on; };
  system.add("robot.a", nets::alone, sensor, 10ms, 0ms, Kind::receptor);
  const ValuesByBuffer values = values_of(recorded(system, simulated(75ms)));
  // Two values, two times none, one, and a failure, which ends the run.
  EXPECT_EQ(values.at("robot.a.sensed real_in"), (std::vector<std::string>{"5", "-", "5", "failed"}));
}

/// Two subsystems, of which the second one remembers, and fails at its fourth iteration.
void add_one_that_remembers(TestSystem& system) {
  Script script;
  script.remembers = true;
  script.call = [](ScriptState& state) {
    state.count = static_cast<std::uint32_t>(state.context.iteration / 2);
    if (state.context.iteration == 3) {
      state.word = "found";
      state.map[599] = 1;
      throw std::runtime_error("after that");
    }
  };
  system.add("robot.a", nets::alone, {}, 10ms);
  system.add("robot.b", nets::alone, script, 10ms);
}

TEST(RecordedValues, OfMemoryAreThoseThatChange) {
  TestSystem system;
  add_one_that_remembers(system);
  const Recording recording = recorded(system, simulated(55ms));
  const ValuesByBuffer values = values_of(recording);
  EXPECT_EQ(values.at("robot.b.memory.count memory"), (std::vector<std::string>{"0", "1"}));
  EXPECT_EQ(values.at("robot.b.memory.word memory"), (std::vector<std::string>{"\"\"", "\"found\""}))
      << "what a function has remembered before it failed stays remembered";
  EXPECT_FALSE(values.contains("robot.a.memory.count memory"));
  ASSERT_EQ(recording.buffers.size(), 4U + 4U + 2U);
  EXPECT_EQ(recording.buffers[7].path, "robot.b.y") << "memory stands behind the buffers of all subsystems";
  EXPECT_EQ(recording.buffers[8].path, "robot.b.memory.count");
  EXPECT_EQ(recording.buffers[9].type, "string(8)");
}

TEST(RecordedValues, OfMemoryComeAtTheEndOfTheIterationThatChangedIt) {
  TestSystem system;
  add_one_that_remembers(system);
  const Recording recording = recorded(system, simulated(55ms));
  std::vector<std::int64_t> at_ms;
  for (const Recording::Entry& entry : recording.entries)
    if (entry.event.kind() == Event::Kind::value && value_of(entry).buffer == 8)
      at_ms.push_back(entry.event.time_ns / 1'000'000);
  EXPECT_EQ(at_ms, (std::vector<std::int64_t>{0, 20}));
}

TEST(RecordedValues, OfLargeMemoryAreRecordedOnlyWithAllValues) {
  TestSystem system;
  add_one_that_remembers(system);
  RunOptions options = simulated(55ms);
  EXPECT_FALSE(values_of(recorded(system, options)).contains("robot.b.memory.map memory"));
  options.values = RunOptions::Values::all;
  EXPECT_EQ(values_of(recorded(system, options)).at("robot.b.memory.map memory").size(), 2U);
  options.values = RunOptions::Values::none;
  EXPECT_TRUE(recorded(system, options).buffers.empty());
}

TEST(RecordedValues, OfMemoryCountAgainstTheLimitOfARecording) {
  TestSystem system;
  Script script;
  script.remembers = true;
  script.call = [](ScriptState& state) { ++state.count; };
  system.add("robot.a", nets::alone, script, 1ms);
  RunOptions options = simulated(10s);
  options.record_limit = {.segment_bytes = 20'000, .segments = 3};
  const Recording recording = recorded(system, options);
  EXPECT_GT(recording.segment.value_or(0), 10U);
  const std::vector<std::string> counts = values_of(recording).at("robot.a.memory.count memory");
  EXPECT_EQ(counts.back(), "10000");
  EXPECT_LT(counts.size(), 60'000U / 48U);
}

TEST(RecordedValues, CallsSayWhenATransitionFunctionBegan) {
  TestSystem system;
  Script script;
  system.add("robot.a", nets::alone, script, 10ms);
  const Recording recording = recorded(system, simulated(25ms));
  std::vector<std::int64_t> at_ms;
  for (const Recording::Entry& entry : recording.entries) {
    if (entry.event.kind() != Event::Kind::call) continue;
    EXPECT_EQ(recording.behaviours.at(0).at(entry.event.subject), "run");
    EXPECT_EQ(entry.event.version, at_ms.size());
    at_ms.push_back(entry.event.time_ns / 1'000'000);
  }
  EXPECT_EQ(at_ms, (std::vector<std::int64_t>{0, 10, 20}));
}

TEST(RecordedValues, AreLeftOutWhenNotWanted) {
  TestSystem system;
  system.add("robot.a", nets::alone, {}, 10ms);
  RunOptions options = simulated(25ms);
  options.values = RunOptions::Values::none;
  const Recording recording = recorded(system, options);
  EXPECT_TRUE(recording.buffers.empty());
  for (const Recording::Entry& entry : recording.entries) {
    EXPECT_NE(entry.event.kind(), Event::Kind::value);
    EXPECT_NE(entry.event.kind(), Event::Kind::call);
  }
}

}  // namespace
}  // namespace tessera::testing
