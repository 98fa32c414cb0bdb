// The example as its users run it: a generated controller, and a base of another implementation of DDS.
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <future>
#include <iterator>
#include <map>
#include <memory>
#include <string>

#include "fast_peer.hpp"
#include "mcap/reader.hpp"
#include "mcap/writer.hpp"

namespace tessera::ros2 {
namespace {

namespace fs = std::filesystem;

/// The example in a folder of its own. Its run waits for the base, so the result does not depend on time.
fs::path copy_of_example() {
  fs::path folder = fs::path(testing::TempDir()) / ("ros2_base_" + std::to_string(getpid()));
  fs::copy(fs::path(TESSERA_SOURCE_DIR) / "examples/10_ros2_base", folder, fs::copy_options::recursive);
  std::ifstream stream(folder / "spec.yaml");
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  for (const std::string end : {"qos: sensor", "angular.z: omega }"})
    text.insert(text.find(end) + end.size(), ", wait: 100 s");
  std::ofstream(folder / "spec.yaml") << text;
  return folder;
}

std::string content_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The topics of the sensors alone, at the times of a wall clock.
void write_topics(const fs::path& bag, const fs::path& topics) {
  mcap::Writer writer("ros2", "another program");
  std::map<std::string, std::uint16_t> channels;
  mcap::read(content_of(bag), {.message = [&](const mcap::ReadMessage& one) {
               const std::string& topic = one.channel.topic;
               if (topic != "/scan" && topic != "/odom") return;
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
  EXPECT_EQ(channels.size(), 2U);
  writer.finish();
  std::ofstream(topics, std::ios::binary) << writer.take();
}

TEST(Example, DrivesABaseOverTopicsAndStopsItAtTheEnd) {
  const fs::path project = copy_of_example();
  const std::string domain = std::to_string(10 + getpid() % 50);
  const std::string base = std::string(TESSERA_ROS2_BASE) + " " + domain + " 200";
  const std::unique_ptr<FILE, int (*)(FILE*)> output(popen(base.c_str(), "r"), pclose);
  ASSERT_NE(output, nullptr);
  const std::string run = "ROS_DOMAIN_ID=" + domain + " " TESSERA_BINARY_DIR "/tessera run " +
                          project.string() + " --for 3s --mcap " + (project / "base.mcap").string() + " > " +
                          (project / "run.log").string() + " 2>&1";
  EXPECT_EQ(std::system(run.c_str()), 0);
  std::ifstream log(project / "run.log");
  int commands = 0;
  double driven_m = 0, nearest_m = 0, last_v = -1;
  EXPECT_EQ(std::fscanf(output.get(), "commands %d, driven %lf m, nearest wall %lf m, last v %lf", &commands,
                        &driven_m, &nearest_m, &last_v),
            4)
      << std::string(std::istreambuf_iterator<char>(log), {});
  EXPECT_GT(commands, 10);
  EXPECT_GT(driven_m, 0.05);
  EXPECT_EQ(last_v, 0) << "the safe command";

  // The same code on the topics of a bag that another program might have written, twice the same.
  write_topics(project / "base.mcap", project / "topics.mcap");
  for (const char* file : {"a.tsr", "b.tsr"}) {
    const std::string from = TESSERA_BINARY_DIR "/tessera simulate " + project.string() + " --from " +
                             (project / "topics.mcap").string() + " --record " + (project / file).string() +
                             " >> " + (project / "run.log").string() + " 2>&1";
    EXPECT_EQ(std::system(from.c_str()), 0);
  }
  EXPECT_GT(content_of(project / "a.tsr").size(), 10'000U);
  EXPECT_EQ(content_of(project / "a.tsr"), content_of(project / "b.tsr"));

  // Once more in a simulated run, whose clock others follow.
  fast::Peer follower(static_cast<std::uint32_t>(std::stoi(domain)));
  auto* const clocks = follower.reader<fast::Clock>("rt/clock");
  const std::unique_ptr<FILE, int (*)(FILE*)> again(popen(base.c_str(), "r"), pclose);
  const std::string simulate = "ROS_DOMAIN_ID=" + domain + " " TESSERA_BINARY_DIR "/tessera simulate " +
                               project.string() +
                               " --hardware robot.laser --hardware robot.wheels --hardware robot.base"
                               " --ros2-clock lo --for 2s >> " +
                               (project / "run.log").string() + " 2>&1";
  std::future<int> result = std::async(std::launch::async, [&] { return std::system(simulate.c_str()); });
  double last_s = -1;
  int ticks = 0;
  const auto follow = [&] {
    while (const auto tick = fast::Peer::take<fast::Clock>(*clocks)) {
      const double now_s = tick->sec + 1e-9 * tick->nanosec;
      EXPECT_GE(now_s, last_s);
      last_s = now_s;
      ++ticks;
    }
  };
  while (result.wait_for(std::chrono::milliseconds(5)) != std::future_status::ready) follow();
  follow();
  EXPECT_EQ(result.get(), 0) << std::string(
      std::istreambuf_iterator<char>(std::ifstream(project / "run.log").rdbuf()), {});
  EXPECT_GT(ticks, 50);
  EXPECT_GT(last_s, 1);
  EXPECT_LE(last_s, 2.0);
  fs::remove_all(project);
}

}  // namespace
}  // namespace tessera::ros2
