#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "bag/channel.hpp"
#include "bag/raw_channel.hpp"
#include "tessera/poses.hpp"
#include "tessera/recording.hpp"

/// A recording of a rover that no run has made.
namespace tessera::bag::test {

inline constexpr std::uint32_t velocity = 0, count = 1, scan = 2;

inline constexpr const char* header = R"({"system": "rover", "net_hash": "n", "verification_hash": "v",
  "verdicts": [{"name": "safe", "verdict": "holds", "method": "circuits"}],
  "seed": 3, "clock": "simulated", "instances": ["robot.base"], "channels": ["a->b"],
  "transitions": [["robot.base.t0", 0, "begin_sending", "drive", 0], ["robot.base.t1", 0, "other"]],
  "behaviours": [["drive"]],
  "values": {"limit": 4096, "buffers": [["robot.base.velocity", 0, "real_out", "{v: float64, w: float64}"],
                                        ["robot.base.count", 0, "in", "uint32"],
                                        ["robot.base.scan", 0, "real_in", "{ranges: float32[<=4], name: string(8), on: bool}"]]},
  "scene": {"hash": "0123456789abcdef", "bodies": [["robot", "robot"], ["box", ""]]}})";

inline Background background() {
  Background made;
  made.ros.push_back({"robot.base.velocity", "/cmd_vel", "geometry_msgs/msg/Twist",
                      "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"
                      "================================================================================\n"
                      "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n",
                      "linear.x=v, angular.z=w", "", ""});
  made.ros.push_back({"robot.base.scan", "/scan", "test_msgs/msg/Scan",
                      "std_msgs/Header header\nfloat32[] ranges\nstring name\nbool on\n"
                      "================================================================================\n"
                      "MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n"
                      "================================================================================\n"
                      "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n",
                      "", "", "laser"});
  made.units["robot.base.count"][""] = "1";
  made.files.push_back({"spec.yaml", "application/yaml", "system: rover\n"});
  return made;
}

template <class... Numbers>
std::string bytes_of(Numbers... numbers) {
  std::string bytes;
  (bytes.append(reinterpret_cast<const char*>(&numbers), sizeof numbers), ...);
  return bytes;
}

/// Fills recordings as a run does.
class MadeRun {
 public:
  MadeRun() {
    RecordingReader reader;
    reader.feed(file_start(header));
    recording = reader.recording();
  }
  void add(Event::Kind kind, std::uint32_t subject, std::uint32_t version, std::string text = {}) {
    Event event;
    event.time_ns = time_ns += 1'000'000;
    event.subject = text.empty() ? subject : static_cast<std::uint32_t>(text.size());
    event.version = version;
    event.sequence = kind == Event::Kind::poses ? 0 : sequence++;
    event.origin =
        (kind == Event::Kind::poses ? system_instance << 8U : 0) | static_cast<std::uint32_t>(kind);
    recording.entries.push_back({event, std::move(text)});
  }
  void value(std::uint32_t buffer, std::uint32_t flags, std::string bytes) {
    add(Event::Kind::value, 0, buffer | flags << 24U, std::move(bytes));
  }
  void iteration(std::uint32_t number) {
    add(Event::Kind::call, 0, number);
    value(count, ValueFlags::stamped | ValueFlags::valid, bytes_of(std::int64_t{5}, number));
    std::string ranges = bytes_of(number % 5);
    for (std::uint32_t ray = 0; ray < number % 5; ++ray) ranges += bytes_of(0.1F * static_cast<float>(ray));
    value(scan, ValueFlags::fresh, ranges + bytes_of(std::uint32_t{2}) + "ab" + bytes_of(number % 2 == 0));
    value(velocity, 0, bytes_of(0.25 * number, -1.0));
    add(Event::Kind::firing, number % 2, 1);
    const std::vector<BodyPose> poses{{{0.5 * number, 0, 0}, {1, 0, 0, 0}}, {{1, 2, 3}, {0, 0, 0, 1}}};
    add(Event::Kind::poses, 0, 0, std::string(encoder.encode(time_ns, poses)));
    value(count, ValueFlags::stamped | ValueFlags::valid | ValueFlags::same, bytes_of(std::int64_t{6}));
    add(Event::Kind::log, 0, 1, "iteration " + std::to_string(number));
  }

  Recording recording;
  std::int64_t time_ns = 0;
  std::uint32_t sequence = 0;
  PoseEncoder encoder{2};
};

inline Recording made_recording() {
  MadeRun run;
  for (std::uint32_t number = 0; number < 8; ++number) run.iteration(number);
  return run.recording;
}

}  // namespace tessera::bag::test
