#include "bag/bag_inputs.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "bag/bag_writer.hpp"
#include "made_run.hpp"
#include "mcap/reader.hpp"
#include "mcap/writer.hpp"

/// The values of real inputs, out of bags that other programs have written.
namespace tessera::bag::test {
namespace {

/// The topics of the made recording as ros2 bag would have written them: times of the wall clock, and no recording.
std::string foreign_bag(bool with_scan = true) {
  BagWriter made(made_recording(), background(), "a test");
  for (const Recording::Entry& entry : made_recording().entries) made.add(entry);
  made.finish();
  mcap::Writer writer("ros2", "another program");
  std::map<std::string, std::uint16_t> channels;
  const std::string bytes = made.take();
  mcap::read(bytes, {.message = [&](const mcap::ReadMessage& one) {
               const std::string& topic = one.channel.topic;
               if (topic != "/cmd_vel" && !(topic == "/scan" && with_scan)) return;
               if (!channels.contains(topic))
                 channels[topic] = writer.add_channel(
                     {0,
                      writer.add_schema(one.schema->name, one.schema->encoding, one.schema->data),
                      topic,
                      "cdr",
                      {}});
               const std::uint64_t time = 1'700'000'000'000'000'000 + one.message.log_ns;
               writer.write(channels[topic], time, time, one.message.data);
             }});
  writer.finish();
  return writer.take();
}

WantedInput wanted(std::size_t ros, std::uint32_t buffer) {
  WantedInput input{background().ros[ros], made_recording().buffers[buffer].type};
  input.ros.frame_id.clear();  // an input sends none
  return input;
}

TEST(BagInputs, AreTheValuesOfTheRun) {
  std::string error;
  const auto inputs = inputs_of(foreign_bag(), "rover", {wanted(1, scan), wanted(0, velocity)}, error);
  ASSERT_TRUE(inputs) << error;
  EXPECT_EQ(inputs->values, 16U);
  EXPECT_EQ(inputs->notes, std::vector<std::string>());
  RecordingReader reader;
  reader.feed(inputs->recording);
  ASSERT_FALSE(reader.problem()) << reader.problem()->text;
  EXPECT_TRUE(reader.has_ended());
  EXPECT_EQ(reader.recording().clock, "bag");
  std::vector<std::string> values[2], wanted_values[2];
  std::vector<std::int64_t> times;
  for (const Recording::Entry& entry : reader.recording().entries) {
    values[value_of(entry).buffer].emplace_back(value_of(entry).bytes);
    times.push_back(entry.event.time_ns);
  }
  for (const Recording::Entry& entry : made_recording().entries)
    if (entry.event.kind() == Event::Kind::value && value_of(entry).buffer != count)
      wanted_values[value_of(entry).buffer == scan ? 0 : 1].emplace_back(value_of(entry).bytes);
  EXPECT_EQ(values[0], wanted_values[0]);
  EXPECT_EQ(values[1], wanted_values[1]);
  EXPECT_EQ(times.front(), 0);
  EXPECT_EQ(times.back(), inputs->end_ns);
}

TEST(BagInputs, SayWhatIsMissing) {
  std::string error;
  const auto inputs = inputs_of(foreign_bag(false), "rover", {wanted(1, scan), wanted(0, velocity)}, error);
  ASSERT_TRUE(inputs) << error;
  EXPECT_EQ(inputs->notes,
            std::vector<std::string>{"has no message on /scan: robot.base.scan gets no value"});
  EXPECT_FALSE(inputs_of(foreign_bag(false), "rover", {wanted(1, scan)}, error));
  EXPECT_EQ(error, "has no value for any real input");
  EXPECT_FALSE(inputs_of("no bag", "rover", {wanted(1, scan)}, error));
  EXPECT_EQ(error, "is no MCAP file");
}

TEST(BagInputs, RefuseMessagesOfAnotherType) {
  std::string error;
  WantedInput other = wanted(0, velocity);
  other.ros.type = "geometry_msgs/msg/TwistStamped";
  EXPECT_FALSE(inputs_of(foreign_bag(), "rover", {other}, error));
  EXPECT_EQ(error,
            "has cdr messages of geometry_msgs/msg/Twist on /cmd_vel, and the driver of robot.base.velocity "
            "wants cdr messages of geometry_msgs/msg/TwistStamped");
  other = wanted(0, velocity);
  other.type = "{v: float32, w: float32}";
  EXPECT_FALSE(inputs_of(foreign_bag(), "rover", {other}, error));
  EXPECT_NE(error.find("that robot.base.velocity cannot take"), std::string::npos) << error;
}

}  // namespace
}  // namespace tessera::bag::test
