#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "ros2/codec/cdr.hpp"
#include "ros2/codec/related_identity.hpp"
#include "ros2/codec/request_header.hpp"
#include "ros2/codec/translator.hpp"
#include "ros2/codec/value_type.hpp"
#include "ros2/codec/written_mapping.hpp"
#include "ros2/definitions/resolver.hpp"

namespace tessera::ros2 {
namespace {

using Bytes = std::vector<std::byte>;

std::shared_ptr<const Structure> message_of(const std::string& definition) {
  std::vector<Mistake> mistakes;
  const bool is_name = definition.find('/') != std::string::npos && definition.find(' ') == std::string::npos;
  const auto message =
      is_name
          ? resolve(definition, DefinitionFolders({std::string(TESSERA_SOURCE_DIR) + "/share/tessera/ros2"}),
                    mistakes)
          : resolve("pkg/msg/Some", DefinitionBundle("pkg/msg/Some", definition), mistakes);
  for (const Mistake& one : mistakes) ADD_FAILURE() << one.shown();
  return message;
}

struct Wanted {
  std::string definition, value, fields{}, names{}, frame_id{};
};

std::string problems_of(const Wanted& wanted, Direction direction) {
  std::vector<MappingProblem> problems;
  const auto translator =
      Translator::make(message_of(wanted.definition), *parse_value_type(wanted.value),
                       written_mapping(wanted.fields, wanted.names, wanted.frame_id), direction, problems);
  EXPECT_EQ(translator.has_value(), problems.empty());
  std::string all;
  for (const MappingProblem& one : problems) all += one.subject + "|" + one.text + "|" + one.hint.text + "\n";
  return all;
}

Translator translator_of(const Wanted& wanted, Direction direction) {
  std::vector<MappingProblem> problems;
  auto translator =
      Translator::make(message_of(wanted.definition), *parse_value_type(wanted.value),
                       written_mapping(wanted.fields, wanted.names, wanted.frame_id), direction, problems);
  for (const MappingProblem& one : problems) ADD_FAILURE() << one.text;
  return *translator;
}

void append(Bytes& bytes, const void* more, std::size_t size) {
  const std::size_t first = bytes.size();
  bytes.resize(first + size);
  std::memcpy(bytes.data() + first, more, size);
}

template <class... Numbers>
Bytes bytes_of(Numbers... numbers) {
  Bytes bytes;
  bytes.reserve((std::size_t{0} + ... + sizeof numbers));
  (append(bytes, &numbers, sizeof numbers), ...);
  return bytes;
}

std::string hex(std::span<const std::byte> bytes) {
  std::string text;
  for (const std::byte one : bytes)
    for (const int half : {static_cast<int>(one) >> 4, static_cast<int>(one) & 15})
      text += "0123456789abcdef"[half];
  return text;
}
Bytes from_hex(const std::string& text) {
  Bytes bytes;
  for (std::size_t at = 0; at + 1 < text.size(); at += 2)
    bytes.push_back(static_cast<std::byte>(std::stoi(text.substr(at, 2), nullptr, 16)));
  return bytes;
}

/// Bytes that Cyclone DDS wrote, with code that its own compiler made (ros2.md of the design).
TEST(Codec, WritesTheBytesOfOtherImplementations) {
  Bytes message;
  ASSERT_TRUE(
      translator_of({"std_msgs/msg/Float64", "float64"}, Direction::send).encode(bytes_of(1.5), {}, message));
  EXPECT_EQ(hex(message), "00010000000000000000f83f");
  Bytes text = bytes_of(std::uint32_t{2});
  append(text, "hi", 2);
  ASSERT_TRUE(translator_of({"std_msgs/msg/String", "string(8)"}, Direction::send).encode(text, {}, message));
  EXPECT_EQ(hex(message), "000100010300000068690000");
  Bytes value;
  ASSERT_EQ(translator_of({"std_msgs/msg/String", "string(8)"}, Direction::receive).decode(message, value),
            Translator::Outcome::good);
  EXPECT_EQ(value, text);
  Translator::Misfit misfit;
  EXPECT_EQ(translator_of({"std_msgs/msg/String", "string(1)"}, Direction::receive)
                .decode(message, value, {}, &misfit),
            Translator::Outcome::other_length);
  EXPECT_TRUE(misfit.is_text);
  EXPECT_EQ(misfit.came, 2);
  EXPECT_EQ(misfit.room, 1);
}

/// An encoded value in the form of buffers: "2: 1.5 2.5".
template <class... Numbers>
Bytes sequence_of(Numbers... numbers) {
  Bytes bytes = bytes_of(static_cast<std::uint32_t>(sizeof...(numbers)));
  const Bytes elements = bytes_of(numbers...);
  bytes.insert(bytes.end(), elements.begin(), elements.end());
  return bytes;
}

TEST(Codec, SequencesOfNumbersHaveTheLengthThatTheyHave) {
  const Wanted wanted{"int32 before\nfloat64[] data\nint8 behind",
                      "{before: int32, data: float64[<=3], behind: int8}"};
  const Translator sends = translator_of(wanted, Direction::send),
                   receives = translator_of(wanted, Direction::receive);
  for (const Bytes& data : {sequence_of(), sequence_of(1.5), sequence_of(1.5, 2.5, -3.0)}) {
    Bytes value = bytes_of(std::int32_t{7}), message, back;
    append(value, data.data(), data.size());
    append(value, "\x05", 1);
    ASSERT_TRUE(sends.encode(value, {}, message));
    ASSERT_EQ(receives.decode(message, back), Translator::Outcome::good);
    EXPECT_EQ(hex(back), hex(value));
  }
  Bytes too_many = bytes_of(std::int32_t{7}), message, back{std::byte{9}};
  const Bytes four = sequence_of(1.0, 2.0, 3.0, 4.0);
  append(too_many, four.data(), four.size());
  append(too_many, "\x05", 1);
  EXPECT_FALSE(sends.encode(too_many, {}, message)) << "no value of the buffer";
  ASSERT_TRUE(
      translator_of({wanted.definition, "{before: int32, data: float64[<=4], behind: int8}"}, Direction::send)
          .encode(too_many, {}, message));
  Translator::Misfit misfit;
  EXPECT_EQ(receives.decode(message, back, {}, &misfit), Translator::Outcome::other_length);
  EXPECT_EQ(misfit.field, "data");
  EXPECT_EQ(misfit.came, 4);
  EXPECT_EQ(misfit.room, 3);
  EXPECT_EQ(back, Bytes{std::byte{9}}) << "a message that is dropped changes nothing";
}

const std::string path_definition = R"(int32 id
Pose[] poses
string end
================================================================================
MSG: pkg/Pose
string name
Point at
float64[] ignored
================================================================================
MSG: pkg/Point
float64 x
float64 y
)";

TEST(Codec, SequencesOfStructuresHaveZeroToTheirLargestLength) {
  const std::string value_type =
      "{id: int32, poses: {name: string(8), y: float64, x: float64}[<=16], end: string(4)}";
  const std::string fields = "id=id, poses.name=poses.name, poses.at.x=poses.x, poses.at.y=poses.y, end=end";
  const Translator sends = translator_of({path_definition, value_type, fields}, Direction::send);
  const Translator receives = translator_of({path_definition, value_type, fields}, Direction::receive);
  const auto value_of = [](std::uint32_t count) {
    Bytes value = bytes_of(std::int32_t{-1}, count);
    for (std::uint32_t index = 0; index < count; ++index) {
      const std::string name(index % 9, 'a');
      const Bytes length = bytes_of(static_cast<std::uint32_t>(name.size()));
      append(value, length.data(), length.size());
      append(value, name.data(), name.size());
      const Bytes numbers = bytes_of(0.5 * index, -1.0 * index);
      append(value, numbers.data(), numbers.size());
    }
    const Bytes end = bytes_of(std::uint32_t{2});
    append(value, end.data(), end.size());
    append(value, "ab", 2);
    return value;
  };
  Bytes message, back;
  for (std::uint32_t count = 0; count <= 16; ++count) {
    ASSERT_TRUE(sends.encode(value_of(count), {}, message)) << count;
    ASSERT_EQ(receives.decode(message, back), Translator::Outcome::good) << count;
    EXPECT_EQ(hex(back), hex(value_of(count))) << count;
  }
  EXPECT_FALSE(sends.encode(value_of(17), {}, message));
  const std::string longer =
      "{id: int32, poses: {name: string(8), y: float64, x: float64}[<=17], end: string(4)}";
  ASSERT_TRUE(
      translator_of({path_definition, longer, fields}, Direction::send).encode(value_of(17), {}, message));
  Translator::Misfit misfit;
  EXPECT_EQ(receives.decode(message, back, {}, &misfit), Translator::Outcome::other_length);
  EXPECT_EQ(misfit.field, "poses");
  EXPECT_EQ(misfit.came, 17);
  EXPECT_EQ(misfit.room, 16);
  EXPECT_EQ(hex(back), hex(value_of(16))) << "the last good one";
  EXPECT_EQ(receives.empty_value({}).size(), 4U + 4U + 4U);
}

TEST(Codec, SequencesSurviveDamagedMessages) {
  const std::string value_type = "{name: string(8), x: float64}[<=4]";
  const std::string fields = "poses.name=name, poses.at.x=x";
  const Translator receives = translator_of({path_definition, value_type, fields}, Direction::receive);
  Bytes value = bytes_of(std::uint32_t{2}, std::uint32_t{0}, 1.0, std::uint32_t{1});
  append(value, "a", 1);
  const Bytes last = bytes_of(2.0);
  append(value, last.data(), last.size());
  Bytes message, back;
  ASSERT_TRUE(
      translator_of({path_definition, value_type, fields}, Direction::send).encode(value, {}, message));
  ASSERT_EQ(receives.decode(message, back), Translator::Outcome::good);
  EXPECT_EQ(hex(back), hex(value));
  std::mt19937 random(1);
  for (int time = 0; time < 20'000; ++time) {
    Bytes damaged = message;
    if (time % 3 == 0) damaged.resize(random() % damaged.size());
    for (std::uint32_t change = random() % 3 + 1; change > 0 && !damaged.empty(); --change)
      damaged[random() % damaged.size()] = static_cast<std::byte>(random());
    static_cast<void>(receives.decode(damaged, back));
  }
}

TEST(Mapping, OfArraysNamesTheFieldsOfTheirElements) {
  const auto problems = [](const std::string& value, const std::string& fields,
                           Direction direction = Direction::receive) {
    return problems_of({path_definition, value, fields}, direction);
  };
  const std::string two = "{x: float64, y: float64}";
  // The hint names fields that are right.
  EXPECT_EQ(problems(two + "[4]", "poses="),
            "poses|the elements of 'poses' do not have the fields of those of the buffer|say which fields "
            "correspond: fields: { poses.at.x: x, poses.at.y: y }\n");
  EXPECT_EQ(problems(two + "[4]", "poses.at.x=x, poses.at.y=y"), "");
  EXPECT_EQ(problems(two + "[<=4]", "poses.at.x=x, poses.at.y=y"), "");
  EXPECT_EQ(problems(two + "[<=4]", "poses.at="), "") << "a structure in each element";
  EXPECT_EQ(problems("{all: " + two + "[<=4]}", "poses.at.x=all.x, poses.at.y=all.y"), "");
  EXPECT_EQ(problems("{all: " + two + "[<=4]}", "poses.at=all"), "");
  EXPECT_EQ(
      problems("{id: int32, all: " + two + "[4]}", "id=id, poses=all"),
      "poses|the elements of 'poses' do not have the fields of those of the buffer's 'all'|say which ones "
      "correspond, beside the others in `fields`: { poses.at.x: all.x, poses.at.y: all.y }\n");
  EXPECT_EQ(problems("{x: float64, height: float64}[4]", "poses="),
            "poses|the elements of 'poses' do not have the fields of those of the buffer|say which fields "
            "correspond, for example fields: { poses.at.x: x, poses.at.y: height }\n");
  EXPECT_EQ(problems("{x: float64, when: int64}[4]", "poses="),
            "poses|'pkg/msg/Pose' has no field 'x'|say which fields correspond: fields: { poses.at.x: x }\n"
            "poses|'pkg/msg/Pose' has no field 'when'|pkg/msg/Pose has name, at, ignored\n")
      << "nothing of that type";
  EXPECT_EQ(
      problems("float64", "poses.at.x="),
      "poses.at.x|the field 'poses.at.x' lies in the array 'poses', and the buffer in none|give the buffer "
      "an array of structures, such as Element<=16, for the whole array\n");
  EXPECT_EQ(
      problems(two, "poses="),
      "poses|'poses' of type pkg/Pose[] does not fit the buffer of type a structure|it is a sequence: a "
      "buffer such as Element<=16, where Element is a structure with fields of Pose, does\n");
  EXPECT_EQ(problems(two + "[4]", "poses.at.x=x"),
            "|no field of the message corresponds to the buffer's '[0].y'|name it in `fields`\n");
  EXPECT_EQ(problems(two + "[4]", "poses.at.z=x, poses.at.y=y"),
            "poses.at.z|'pkg/msg/Point' has no field 'z'|pkg/msg/Point has x, y\n");
  EXPECT_EQ(problems(two + "[<=4]", "id=x, poses.at.y=y"),
            "id|the buffer has no field 'x'|it is an array: begin the field of the message with that of its "
            "array, as in array.x\n");
}

TEST(Mapping, OfSequencesNeedsASequence) {
  const auto problems = [](const std::string& definition, const std::string& value, Direction direction) {
    return problems_of({definition, value, "data="}, direction);
  };
  using enum Direction;
  EXPECT_EQ(problems("float64[] data", "float64[<=4]", receive), "");
  EXPECT_EQ(problems("float64[] data", "float64[<=4]", send), "");
  EXPECT_EQ(problems("float64[<=2] data", "float64[<=4]", receive), "");
  EXPECT_EQ(problems("float64[<=2] data", "float64[<=4]", send),
            "data|the buffer of type float64<=4 does not fit 'data' of type float64[<=2]|a buffer of type "
            "float64<=2 does: it has 0 to 2 elements\n");
  EXPECT_EQ(problems("float64[4] data", "float64[<=4]", receive),
            "data|'data' of type float64[4] does not fit the buffer of type float64<=4|a buffer of type "
            "float64[4] does\n");
  EXPECT_EQ(
      problems("float64[] data", "float64", receive),
      "data|'data' of type float64[] does not fit the buffer of type float64|a buffer of type float64<=16 "
      "does: it has 0 to 16 elements\n");
}

const std::string detections_definition = R"(Detection[] detections
================================================================================
MSG: pkg/Detection
string id
Result[] results
float32[] mask
Point[2] corners
================================================================================
MSG: pkg/Result
Hypothesis hypothesis
================================================================================
MSG: pkg/Hypothesis
string class_id
float64 score
================================================================================
MSG: pkg/Point
int16 x
int16 y
)";
const std::string detections_value =
    "{results: {score: float64, class_id: string(8)}[<=3], mask: float64[<=4], y: {y: int16}[2]}[<=4]";
const std::string detections_fields =
    "detections.results.hypothesis.class_id=results.class_id, detections.mask=mask, "
    "detections.results.hypothesis.score=results.score, detections.corners.y=y.y";

/// A value with so many detections: the first has `results` of them, and each further one less by one.
Bytes detections_of(std::uint32_t count, std::uint32_t results, bool singles = false) {
  Bytes value = bytes_of(count);
  for (std::uint32_t index = 0; index < count; ++index) {
    append(value, &results, sizeof results);
    for (std::uint32_t result = 0; result < results; ++result) {
      const Bytes score = bytes_of(index + 0.25 * result, std::uint32_t{2});
      append(value, score.data(), score.size());
      append(value, "ab", 2);
    }
    const Bytes mask = singles ? sequence_of(0.5F, static_cast<float>(index)) : sequence_of(0.5, 1.0 * index);
    append(value, mask.data(), mask.size());
    const Bytes corners = bytes_of(static_cast<std::int16_t>(index), std::int16_t{-2});
    append(value, corners.data(), corners.size());
    if (results > 0) --results;
  }
  return value;
}

TEST(Codec, SequencesInTheElementsOfSequencesHaveLengthsOfTheirOwn) {
  const std::string& fields = detections_fields;
  const std::string singles =
      std::string(detections_value).replace(detections_value.find("float64[<=4]"), 7, "float32");
  const Translator receives =
      translator_of({detections_definition, detections_value, fields}, Direction::receive);
  const Translator sends = translator_of({detections_definition, singles, fields}, Direction::send);
  Bytes message, back;
  for (std::uint32_t count = 0; count <= 4; ++count)
    for (std::uint32_t results = 0; results <= 3; ++results) {
      ASSERT_TRUE(sends.encode(detections_of(count, results, true), {}, message));
      ASSERT_EQ(receives.decode(message, back), Translator::Outcome::good) << count << " " << results;
      EXPECT_EQ(hex(back), hex(detections_of(count, results))) << count << " " << results;
    }
  EXPECT_FALSE(sends.encode(detections_of(2, 4, true), {}, message)) << "no value of the buffer";
  const std::string more = std::string(singles).replace(singles.find("[<=3]"), 5, "[<=9]");
  ASSERT_TRUE(translator_of({detections_definition, more, fields}, Direction::send)
                  .encode(detections_of(3, 5, true), {}, message));
  Translator::Misfit misfit;
  EXPECT_EQ(receives.decode(message, back, {}, &misfit), Translator::Outcome::other_length);
  EXPECT_EQ(misfit.field, "[0].results");
  EXPECT_EQ(misfit.came, 5);
  EXPECT_EQ(misfit.room, 3);
  EXPECT_EQ(receives.empty_value({}), bytes_of(std::uint32_t{0}));
  const Translator same = translator_of({detections_definition, singles, fields}, Direction::receive);
  Bytes whole;
  ASSERT_TRUE(sends.encode(detections_of(4, 3, true), {}, whole));
  std::mt19937 random(1);
  for (int time = 0; time < 20'000; ++time) {
    Bytes damaged = whole;
    if (time % 3 == 0) damaged.resize(random() % damaged.size());
    for (std::uint32_t change = random() % 3 + 1; change > 0 && !damaged.empty(); --change)
      damaged[random() % damaged.size()] = static_cast<std::byte>(random() % 6);
    if (same.decode(damaged, back) == Translator::Outcome::good) {
      EXPECT_TRUE(sends.encode(back, {}, message)) << "it is a value of the buffer";
    }
  }
}

TEST(Mapping, OfArraysInElementsNamesTheFieldsOfTheInnerOnes) {
  const auto problems = [](const std::string& value, const std::string& fields) {
    return problems_of({detections_definition, value, fields}, Direction::receive);
  };
  EXPECT_EQ(problems("{results: {score: float64}[<=3]}[<=4]", "detections.results.hypothesis=results"), "");
  EXPECT_EQ(problems("{mask: float32[<=4], results: {hypothesis: {score: float64}}[<=3]}[<=4]", ""), "");
  EXPECT_EQ(problems("{score: float64}[<=4]", "detections.results.hypothesis.score=score"),
            "detections.results.hypothesis.score|the field 'detections.results.hypothesis.score' lies in the "
            "array 'detections.results', and the buffer's 'score' in none|give the buffer an array of "
            "structures, such as Element<=16, for the whole array\n");
  EXPECT_EQ(
      problems("{results: {score: float64}[<=3]}[<=4]", "detections.results.hypothesis.scor=results.score"),
      "detections.results.hypothesis.scor|'pkg/msg/Hypothesis' has no field 'scor'|did you mean 'score'?\n");
  EXPECT_EQ(
      problems(
          "{a: {score: float64}[<=3], b: {class_id: string(4)}[<=3]}[<=4]",
          "detections.results.hypothesis.score=a.score, detections.results.hypothesis.class_id=b.class_id"),
      "detections.results.hypothesis.class_id|'detections.results' corresponds to the buffer's '[0].a' and "
      "to the buffer's '[0].b'|\n");
}

TEST(Codec, PutsJointsOfTrajectoriesInTheOrderOfTheirNames) {
  const std::string value = "{positions: float64[2], velocities: float64[<=2], sec: int32}[<=3]";
  Wanted wanted{"trajectory_msgs/msg/JointTrajectory", value,
                "points.positions=positions, points.velocities=velocities, points.time_from_start.sec=sec",
                "left, right"};
  Bytes points = bytes_of(std::uint32_t{2}, 1.0, 2.0);
  for (const Bytes& part :
       {sequence_of(3.0, 4.0), bytes_of(std::int32_t{1}, 5.0, 6.0), sequence_of(), bytes_of(std::int32_t{2})})
    append(points, part.data(), part.size());
  Bytes message, back;
  ASSERT_TRUE(translator_of(wanted, Direction::send).encode(points, {}, message));
  ASSERT_EQ(translator_of(wanted, Direction::receive).decode(message, back), Translator::Outcome::good);
  EXPECT_EQ(hex(back), hex(points));
  wanted.names = "right, left";
  ASSERT_EQ(translator_of(wanted, Direction::receive).decode(message, back), Translator::Outcome::good);
  Bytes turned = bytes_of(std::uint32_t{2}, 2.0, 1.0);
  for (const Bytes& part :
       {sequence_of(4.0, 3.0), bytes_of(std::int32_t{1}, 6.0, 5.0), sequence_of(), bytes_of(std::int32_t{2})})
    append(turned, part.data(), part.size());
  EXPECT_EQ(hex(back), hex(turned));
  wanted.names = "left";
  EXPECT_EQ(problems_of(wanted, Direction::send),
            "points.positions|there are 1 names, and the buffer's '[0].positions' is float64[2]|\n"
            "points.velocities|there are 1 names, and the buffer's '[0].velocities' is float64<=2|\n");
}

TEST(Mapping, OfFeedbackAndResultIsForPartsThatMayBeEmpty) {
  const auto message = message_of("string[] joint_names\nfloat64[] actual\nint32 code");
  const auto make = [&](const std::string& value, const std::string& names, Direction direction,
                        std::vector<MappingProblem>& problems) {
    return Translator::make(message, *parse_value_type(value),
                            mapping_of_action(written_mapping("actual=actual", names, ""), false, direction),
                            direction, problems);
  };
  std::vector<MappingProblem> problems;
  const std::string fixed = "{call: uint32, state: uint8, actual: float64[2]}";
  EXPECT_FALSE(make(fixed, "", Direction::receive, problems).has_value());
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(
      problems[0].text + "|" + problems[0].hint.text,
      "'actual' of type float64[] does not fit the buffer's 'actual' of type float64[2]|a buffer of type "
      "float64<=16 does: it has 0 to 16 elements");
  EXPECT_TRUE(make(fixed, "", Direction::send, problems).has_value());
  const auto receives =
      make("{call: uint32, state: uint8, actual: float64[<=2]}", "left, right", Direction::receive, problems);
  ASSERT_TRUE(receives.has_value());
  const auto value_of = [&](const std::string& definition_of_names, const Bytes& actual) {
    Bytes sent, back;
    const Translator sends = translator_of({"string[] joint_names\nfloat64[] actual\nint32 code",
                                            "{actual: float64[<=2]}", "actual=actual", definition_of_names},
                                           Direction::send);
    EXPECT_TRUE(sends.encode(actual, {}, sent));
    const std::array<std::uint64_t, 2> own{7, 2};
    return receives->decode(sent, back, own) == Translator::Outcome::good ? hex(back) : "";
  };
  const Bytes own = bytes_of(std::uint32_t{7}, std::uint8_t{2});
  EXPECT_EQ(value_of("", sequence_of()), hex(own) + hex(sequence_of()));
  EXPECT_EQ(value_of("right, left", sequence_of(1.0, 2.0)), hex(own) + hex(sequence_of(2.0, 1.0)));
  EXPECT_EQ(value_of("", sequence_of(1.0, 2.0)), "") << "of which joints?";
}

TEST(Codec, ReadsBothOrdersOfBytes) {
  const Translator translator =
      translator_of({"uint8 a\nint32 b\nfloat64[] c\nstring d", "{b: int64, c: float64[1], d: string(3)}"},
                    Direction::receive);
  Bytes little, big;
  ASSERT_EQ(translator.decode(
                from_hex("0001000007000000feffffff0100000000000000000000000000f83f026800000300000068690000"),
                little),
            Translator::Outcome::malformed)
      << "the string of 2 has no zero";
  // at 0 a, 4 b, 8 length, 16 number, 24 length, 28 text
  ASSERT_EQ(translator.decode(
                from_hex("0001000007000000feffffff0100000000000000000000000000f83f03000000686900"), little),
            Translator::Outcome::good);
  ASSERT_EQ(translator.decode(
                from_hex("0000000007000000fffffffe00000001000000003ff800000000000000000003686900"), big),
            Translator::Outcome::good);
  EXPECT_EQ(little, big);
  Bytes expected = bytes_of(std::int64_t{-2}, 1.5, std::uint32_t{2});
  append(expected, "hi", 2);
  EXPECT_EQ(little, expected);
}

TEST(Codec, FillsWhatTheBufferDoesNot) {
  const Translator send = translator_of(
      {"geometry_msgs/msg/PoseStamped", "float64", "pose.position.x", "", "map"}, Direction::send);
  Bytes message, value;
  ASSERT_TRUE(send.encode(bytes_of(2.5), {7, 8}, message));
  const Translator receive =
      translator_of({"geometry_msgs/msg/PoseStamped",
                     "{sec: int32, nanosec: uint32, frame: string(8), x: float64, w: float64}",
                     "header.stamp.sec=sec, header.stamp.nanosec=nanosec, header.frame_id=frame, "
                     "pose.position.x=x, pose.orientation.w=w"},
                    Direction::receive);
  ASSERT_EQ(receive.decode(message, value), Translator::Outcome::good);
  Bytes expected = bytes_of(std::int32_t{7}, std::uint32_t{8}, std::uint32_t{3});
  append(expected, "map", 3);
  const std::array rest{2.5, 1.0};
  append(expected, rest.data(), sizeof rest);
  EXPECT_EQ(value, expected);
}

TEST(Codec, PutsJointsInTheOrderOfTheirNames) {
  const Wanted wanted{"sensor_msgs/msg/JointState", "{position: float64[2], velocity: float64[2]}", "",
                      "left, right"};
  const Translator receive = translator_of(wanted, Direction::receive);
  Bytes message, value;
  ASSERT_TRUE(translator_of(wanted, Direction::send).encode(bytes_of(1.0, 2.0, 3.0, 4.0), {}, message));
  ASSERT_EQ(receive.decode(message, value), Translator::Outcome::good);
  EXPECT_EQ(value, bytes_of(1.0, 2.0, 3.0, 4.0));
  Wanted other = wanted;
  other.names = "right, left";
  ASSERT_EQ(translator_of(other, Direction::receive).decode(message, value), Translator::Outcome::good);
  EXPECT_EQ(value, bytes_of(2.0, 1.0, 4.0, 3.0));
  other.names = "left, middle";
  Translator::Misfit misfit;
  EXPECT_EQ(translator_of(other, Direction::receive).decode(message, value, {}, &misfit),
            Translator::Outcome::other_names);
  EXPECT_EQ(misfit.field, "middle");
}

TEST(Codec, PutsTheHeaderOfServicesBeforeTheData) {
  const RequestHeader header{0x0102030405060708, 5};
  Bytes message = from_hex("000100000100000000000000");
  const Bytes alone = message;
  put_header(header, message);
  EXPECT_EQ(hex(message), "00010000080706050403020105000000000000000100000000000000");
  EXPECT_EQ(take_header(message), header);
  EXPECT_EQ(message, alone);
  Bytes big = from_hex("000000000102030405060708000000000000000501");
  EXPECT_EQ(take_header(big), header);
  EXPECT_EQ(hex(big), "0000000001");
  for (std::size_t size = 0; size < 20; ++size) {
    Bytes cut = from_hex("0001000008070605040302010500000000000000");
    cut.resize(size);
    const Bytes before = cut;
    EXPECT_FALSE(take_header(cut).has_value()) << size;
    EXPECT_EQ(cut, before);
  }
}

TEST(Codec, GivesAndTakesFieldsThatNoMessageHas) {
  Mapping mapping;
  mapping.own = own_fields_of_service(/*has_outcome=*/true);
  std::vector<MappingProblem> problems;
  const auto value = parse_value_type("{word: string(4), call: uint32, data: bool, outcome: uint8}");
  const auto message = message_of("bool data\nstring word");
  const auto translator = Translator::make(message, *value, mapping, Direction::receive, problems);
  ASSERT_TRUE(translator.has_value()) << problems.front().text;
  Bytes got;
  ASSERT_EQ(
      translator->decode(from_hex("000100000100000003000000686900"), got, std::array<std::uint64_t, 2>{7, 1}),
      Translator::Outcome::good);
  EXPECT_EQ(hex(got), "020000006869070000000101");
  EXPECT_EQ(translator->own_number(got, call_field), 7U);
  EXPECT_EQ(translator->own_number(got, outcome_field), 1U);
  EXPECT_EQ(translator->own_number(std::span(got).first(5), call_field), 0U) << "no such value";
  EXPECT_EQ(hex(translator->empty_value(std::array<std::uint64_t, 2>{9, 3})), "00000000090000000003");
  const auto back = Translator::make(message, *value, mapping, Direction::send, problems);
  ASSERT_TRUE(back.has_value());
  Bytes sent;
  ASSERT_TRUE(back->encode(got, {}, sent));
  EXPECT_EQ(hex(sent),
            "0001000101000000030000006869"
            "0000");
}

TEST(Codec, RefusesWhatIsNoSuchMessage) {
  const Translator translator =
      translator_of({"bool a\nfloat64[2] b", "{a: bool, b: float64[2]}"}, Direction::receive);
  const Bytes good = from_hex("00010000010000000000000000000000000000000000000000000000");
  Bytes value;
  ASSERT_EQ(translator.decode(good, value), Translator::Outcome::good);
  for (std::size_t size = 0; size < good.size(); ++size)
    EXPECT_EQ(translator.decode(std::span(good).first(size), value), Translator::Outcome::malformed) << size;
  Bytes other = good;
  other.resize(good.size() + 3);
  EXPECT_EQ(translator.decode(other, value), Translator::Outcome::good) << "padding";
  other.resize(good.size() + 4);
  EXPECT_EQ(translator.decode(other, value), Translator::Outcome::malformed) << "another definition";
  other = good;
  other[4] = std::byte{2};
  EXPECT_EQ(translator.decode(other, value), Translator::Outcome::malformed) << "no bool";
  other = good;
  other[1] = std::byte{7};
  EXPECT_EQ(translator.decode(other, value), Translator::Outcome::malformed) << "XCDR2";
}

TEST(Codec, SurvivesAnyBytes) {
  const Translator translator =
      translator_of({"sensor_msgs/msg/PointCloud2", "{height: uint32, is_dense: bool}"}, Direction::receive);
  const Translator scan = translator_of(
      {"sensor_msgs/msg/LaserScan", "{range_max: float64, ranges: float32[3]}"}, Direction::receive);
  Bytes good, value;
  ASSERT_TRUE(translator_of({"sensor_msgs/msg/LaserScan", "{range_max: float32, ranges: float32[3]}"},
                            Direction::send)
                  .encode(bytes_of(9.0F, 1.0F, 2.0F, 3.0F), {}, good));
  std::mt19937 random(1);
  int accepted = 0;
  for (int round = 0; round < 20'000; ++round) {
    Bytes bytes = good;
    for (int change = 0; change < 3; ++change)
      bytes[random() % bytes.size()] = static_cast<std::byte>(random() % 4 == 0 ? 0xff : random() % 5);
    bytes.resize(random() % 3 == 0 ? random() % bytes.size() : bytes.size());
    static_cast<void>(translator.decode(bytes, value));
    if (scan.decode(bytes, value) == Translator::Outcome::good) ++accepted;
  }
  EXPECT_GT(accepted, 1000);
  EXPECT_LT(accepted, 19'000);
}

TEST(Codec, ConvertsExactlyOrNotAtAll) {
  EXPECT_TRUE(converts_exactly(Primitive::float32, Primitive::float64));
  EXPECT_TRUE(converts_exactly(Primitive::uint8, Primitive::int16));
  EXPECT_TRUE(converts_exactly(Primitive::int32, Primitive::float64));
  EXPECT_TRUE(converts_exactly(Primitive::int16, Primitive::float32));
  for (const auto& [from, to] : {std::pair{Primitive::float64, Primitive::float32},
                                 {Primitive::int64, Primitive::float64},
                                 {Primitive::int8, Primitive::uint8},
                                 {Primitive::uint8, Primitive::int8},
                                 {Primitive::int32, Primitive::float32},
                                 {Primitive::boolean, Primitive::uint8},
                                 {Primitive::float32, Primitive::int64},
                                 {Primitive::string, Primitive::uint8}})
    EXPECT_FALSE(converts_exactly(from, to)) << name_of(from) << " " << name_of(to);
}

TEST(Mapping, MistakesAreTold) {
  const std::string twist = "geometry_msgs/msg/Twist", motion = "{v: float64, omega: float64}";
  EXPECT_EQ(problems_of({twist, motion, "linear.x=v, angular.zz=omega"}, Direction::send),
            "angular.zz|'geometry_msgs/msg/Vector3' has no field 'zz'|did you mean 'z'?\n");
  EXPECT_EQ(problems_of({twist, motion, "linear.x=v"}, Direction::send),
            "|no field of the message corresponds to the buffer's 'omega'|name it in `fields`\n");
  EXPECT_EQ(problems_of({twist, motion, "linear.x=v, angular.z=omgea"}, Direction::send),
            "angular.z|the buffer has no field 'omgea'|did you mean 'omega'?\n");
  EXPECT_EQ(
      problems_of({twist, motion}, Direction::send),
      "|'geometry_msgs/msg/Twist' has no field 'v'|say which fields correspond: fields: { linear.x: v }\n"
      "|'geometry_msgs/msg/Twist' has no field 'omega'|say which fields correspond: fields: { linear.y: "
      "omega }\n");
  EXPECT_EQ(
      problems_of({"std_msgs/msg/Float32", "float64"}, Direction::send),
      "|the buffer of type float64 does not fit 'data' of type float32|a buffer of type float32 does\n");
  EXPECT_EQ(problems_of({"std_msgs/msg/Float32", "float64"}, Direction::receive), "");
  EXPECT_EQ(problems_of({"float64[9] a", "float64[8]"}, Direction::receive),
            "|'a' of type float64[9] does not fit the buffer of type float64[8]|a buffer of type float64[9] "
            "does\n");
  EXPECT_EQ(problems_of({"float64[<=4] a", "float64[8]"}, Direction::send),
            "|the buffer of type float64[8] does not fit 'a' of type float64[<=4]|a buffer of type "
            "float64<=4 does: it has 0 to 4 elements\n");
  EXPECT_EQ(
      problems_of({"string<=4 a", "string(8)"}, Direction::send),
      "|the buffer of type string<=8 does not fit 'a' of type string<=4|a buffer of type string<=4 does\n");
  EXPECT_EQ(problems_of({twist, "float64"}, Direction::send),
            "|which field of 'geometry_msgs/msg/Twist' is meant?|for example fields: angular\n");
  EXPECT_EQ(problems_of({"wstring a", "string(8)"}, Direction::send),
            "|'pkg/msg/Some' has the wstring 'a'|implementations of DDS disagree on wide strings; let a node "
            "copy the message into one that has a string instead\n");
  EXPECT_EQ(
      problems_of({twist, "float64", "linear.x", "a, b"}, Direction::receive),
      "names|'geometry_msgs/msg/Twist' has no field 'name' or 'joint_names' of type string[]|names are for "
      "messages such as sensor_msgs/JointState\n");
}

TEST(RelatedIdentity, IsFoundAmongTheParametersOfADatagram) {
  const auto list = [](std::initializer_list<int> numbers) {
    std::vector<std::byte> bytes;
    for (const int number : numbers) bytes.push_back(static_cast<std::byte>(number));
    return bytes;
  };
  const auto with_identity = [&](int low, int high) {
    std::vector<std::byte> bytes =
        list({0x71, 0, 4, 0, 0, 0, 0, 1, low, high, 24, 0});  // after a status info
    for (int byte = 1; byte <= 16; ++byte) bytes.push_back(static_cast<std::byte>(byte));
    const auto rest = list({1, 0, 0, 0, 7, 0, 0, 0x80, 1, 0, 0, 0});
    bytes.insert(bytes.end(), rest.begin(), rest.end());
    return bytes;
  };
  for (const auto& bytes : {with_identity(0x0f, 0x80), with_identity(0x83, 0)}) {
    const auto found = related_identity_in(bytes);
    ASSERT_TRUE(found.has_value());
    EXPECT_EQ(found->endpoint, (Guid{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16}));
    EXPECT_EQ(found->sequence, 0x1'8000'0007);
    for (std::size_t size = 0; size < bytes.size() - 4; ++size)  // without the end of the list
      EXPECT_FALSE(related_identity_in(std::span(bytes).first(size)).has_value()) << size;
  }
  EXPECT_FALSE(related_identity_in(with_identity(0x70, 0)).has_value()) << "a key hash";
  auto ended = list({1, 0, 0, 0});
  const auto behind = with_identity(0x0f, 0x80);
  ended.insert(ended.end(), behind.begin(), behind.end());
  EXPECT_FALSE(related_identity_in(ended).has_value()) << "behind the end of the list";
}

}  // namespace
}  // namespace tessera::ros2
