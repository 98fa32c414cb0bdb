// The example as its users run it: a generated controller, and a robot with another implementation of DDS.
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
#include <set>
#include <string>

#include "fast_peer.hpp"
#include "mcap/reader.hpp"
#include "mcap/writer.hpp"

namespace tessera::ros2 {
namespace {

namespace fs = std::filesystem;

/// The example in a folder of its own. Its run waits for the robot, so the result does not depend on time.
fs::path copy_of_example() {
  fs::path folder = fs::path(testing::TempDir()) / ("ros2_patrol_" + std::to_string(getpid()));
  fs::copy(fs::path(TESSERA_SOURCE_DIR) / "examples/10_patrol", folder, fs::copy_options::recursive);
  std::ifstream stream(folder / "spec.yaml");
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  text.insert(text.find("qos: sensor") + 11, ", wait: 100 s");
  text.insert(text.find("    frame_id: map\n"), "    wait: 100 s\n");
  std::ofstream(folder / "spec.yaml") << text;
  return folder;
}

std::string content_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The topics of the battery and of the operator alone, at the times of a wall clock.
void write_topics(const fs::path& bag, const fs::path& topics) {
  mcap::Writer writer("ros2", "another program");
  std::map<std::string, std::uint16_t> channels;
  mcap::read(content_of(bag), {.message = [&](const mcap::ReadMessage& one) {
               const std::string& topic = one.channel.topic;
               if (topic != "/battery_state" && topic != "/patrol/pause") return;
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

/// The robot's count of its goals, at its end.
struct Summary {
  int goals = 0, succeeded = 0, aborted = 0, given_up = 0, given_up_low = 0, charged = 0, under_way = -1;
};

Summary summary_of(FILE& output) {
  Summary read;
  EXPECT_EQ(std::fscanf(&output,
                        "goals %d, succeeded %d, aborted %d, given up %d, below 20 %%: %d, charged %d, "
                        "under way %d",
                        &read.goals, &read.succeeded, &read.aborted, &read.given_up, &read.given_up_low,
                        &read.charged, &read.under_way),
            7);
  return read;
}

TEST(Example, PatrolsAndRecoversAndChargesAndCancelsAtTheEnd) {
  const fs::path project = copy_of_example();
  const std::string domain = std::to_string(10 + getpid() % 50);
  const std::string robot = std::string(TESSERA_ROS2_NAVIGATOR) + " " + domain + " 200";
  const std::unique_ptr<FILE, int (*)(FILE*)> output(popen(robot.c_str(), "r"), pclose);
  ASSERT_NE(output, nullptr);
  fast::Peer operators(static_cast<std::uint32_t>(std::stoi(domain)));
  auto* const pauses = operators.writer<fast::Bool>("rt/site/pause");
  auto* const reports = operators.reader<fast::Text>("rt/site/report");
  // As a launch file starts it.
  const std::string parameters = (project / "site.yaml").string();
  std::ofstream(parameters) << "/site/robot:\n  ros__parameters:\n    control: { low: 0.3 }\n";
  const std::string arguments =
      " --ros-args -r __ns:=/site -r /patrol/report:=report -r robot:/patrol/pause:=/site/pause "
      "--params-file " +
      parameters + " -- ";
  const std::string run = "ROS_DOMAIN_ID=" + domain + " " TESSERA_BINARY_DIR "/tessera run " +
                          project.string() + arguments + " --for 12s --mcap " +
                          (project / "patrol.mcap").string() + " > " + (project / "run.log").string() +
                          " 2>&1";
  // The operator wants a pause as soon as the robot is on its way to the last station, until it stands.
  std::set<std::string> said;
  std::future<int> ran = std::async(std::launch::async, [&] { return std::system(run.c_str()); });
  while (ran.wait_for(std::chrono::milliseconds(5)) != std::future_status::ready)
    while (const auto report = fast::Peer::take<fast::Text>(*reports)) {
      said.insert(report->data);
      fast::Bool pause{said.contains("to station 2") && !said.contains("paused")};
      pauses->write(&pause);
    }
  EXPECT_EQ(ran.get(), 0) << content_of(project / "run.log");
  for (const char* words : {"the node /robot is /site/robot", "/patrol/report is /site/report"})
    EXPECT_NE(content_of(project / "run.log").find(words), std::string::npos) << words;
  const Summary robot_did = summary_of(*output);
  EXPECT_GE(robot_did.goals, 5) << content_of(project / "run.log");
  EXPECT_GE(robot_did.succeeded, 3);
  EXPECT_EQ(robot_did.aborted, 1);
  EXPECT_GE(robot_did.given_up_low, 1);
  EXPECT_GE(robot_did.charged, 1);
  EXPECT_EQ(robot_did.under_way, 0) << "the safe command";
  for (const char* words : {"to station 0", "to station 2", "recovers", "to the dock", "charges", "paused"})
    EXPECT_TRUE(said.contains(words)) << words;

  // The same code on the topics of a bag that another program might have written, twice the same.
  write_topics(project / "patrol.mcap", project / "topics.mcap");
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
  const std::unique_ptr<FILE, int (*)(FILE*)> again(popen(robot.c_str(), "r"), pclose);
  const std::string simulate = "ROS_DOMAIN_ID=" + domain + " " TESSERA_BINARY_DIR "/tessera simulate " +
                               project.string() +
                               " --hardware robot.legs --hardware robot.eyes --hardware robot.gauge"
                               " --hardware robot.panel --hardware robot.voice"
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
  EXPECT_GE(summary_of(*again).goals, 1);
  fs::remove_all(project);
}

}  // namespace
}  // namespace tessera::ros2
