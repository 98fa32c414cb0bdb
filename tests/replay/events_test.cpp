#include "replay/events.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>

#include "constructed.hpp"
#include "replay/perfetto.hpp"
#include "tessera/printable.hpp"

using tessera::Recording;
using tessera::ValueFlags;
using tessera::replay::Selection;

namespace {

TEST(Printable, TextKeepsItsLettersAndLosesWhatMovesTheTerminal) {
  using tessera::printable;
  EXPECT_EQ(printable("\x1b[31mred\x07 a\rb\x7f\n\tnext"), "\\x1b[31mred\\x07 a\\x0db\\x7f\n\tnext");
  EXPECT_EQ(printable("Fähre 艦 🚗 °"), "Fähre 艦 🚗 °");
  EXPECT_EQ(printable("\xff\xc3"), "\\xff\\xc3");
  EXPECT_EQ(printable("\xc2\x9b"
                      "2J"),
            "\\xc2\\x9b"
            "2J")
      << "a control character of 8 bits, in UTF-8";
  EXPECT_EQ(printable("\xe2\x80\xae"
                      "txt.exe"),
            "\\xe2\\x80\\xae"
            "txt.exe")
      << "right to left";
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a\\x00b");
  std::array<char, 6> room{};
  EXPECT_EQ(printable("abc\x1b", room), "abc") << "no part of an escape";
  EXPECT_EQ(printable("ab\x1b", room), "ab\\x1b");
}

template <class T>
std::string bytes_of(T value) {
  return {std::bit_cast<std::array<char, sizeof(T)>>(value).data(), sizeof(T)};
}
std::string velocity(double linear, std::int16_t angular) { return bytes_of(linear) + bytes_of(angular); }
std::string stamp(std::int64_t ns) { return bytes_of(ns); }

/// A controller whose output changes twice, and a motor that receives it, once invalid.
Constructed a_run() {
  Constructed run({"robot.control", "robot.motor"});
  run.recording.behaviours = {{"go"}, {"drive"}};
  run.recording.buffers = {
      {"robot.control.motion", 0, Recording::Direction::output, "{linear: float64, angular: int16}"},
      {"robot.motor.velocity", 1, Recording::Direction::input, "{linear: float64, angular: int16}"},
      {"robot.motor.image", 1, Recording::Direction::input, "uint8[10000]"},
      {"robot.motor.sensed", 1, Recording::Direction::real_input, "bool"}};
  run.call(1.0, 0)
      .value(1.0, 0, 0, 0, velocity(0.5, -3))
      .fire(1.25, 0, "go.t1")
      .value(1.3, 1, 1, ValueFlags::stamped | ValueFlags::valid | ValueFlags::fresh,
             stamp(1'000'000'000) + velocity(0.5, -3))
      .value(1.4, 1, 1, ValueFlags::stamped | ValueFlags::same, stamp(1'400'000'000))
      .value(1.4, 1, 2, ValueFlags::hashed, bytes_of(std::uint64_t{10000}) + bytes_of(std::uint64_t{0xabc}))
      .value(1.5, 1, 3, ValueFlags::fresh, "\1")
      .value(1.6, 1, 3, ValueFlags::silent, "")
      .value(2.0, 0, 0, 0, velocity(0.25, 7));
  return run;
}

std::string printed(const Selection& selection) {
  std::ostringstream text;
  tessera::replay::print_events(a_run().recording, selection, text);
  return text.str();
}

TEST(Events, ArePrintedWithTheValuesThatAreWanted) {
  Selection selection;
  EXPECT_EQ(printed(selection),
            "      1.000000 robot.control: calls go, iteration 0\n"
            "      1.250000 robot.control.go.t1\n");
  selection.events = false;
  selection.values = "";
  EXPECT_EQ(printed(selection),
            "      1.000000 robot.control.motion = {linear: 0.5, angular: -3}\n"
            "      1.300000 robot.motor.velocity = {linear: 0.5, angular: -3}\n"
            "      1.400000 robot.motor.velocity = {linear: 0.5, angular: -3}, invalid\n"
            "      1.400000 robot.motor.image = 10000 bytes, hash 0000000000000abc\n"
            "      1.500000 robot.motor.sensed = true\n"
            "      1.600000 robot.motor.sensed = no value\n"
            "      2.000000 robot.control.motion = {linear: 0.25, angular: 7}\n");
  selection.values = "motion";
  selection.last = 1;
  EXPECT_EQ(printed(selection), "      2.000000 robot.control.motion = {linear: 0.25, angular: 7}\n");
}

TEST(Events, MemoryIsPrintedLikeABuffer) {
  Constructed run({"robot.control"});
  run.recording.buffers = {
      {"robot.control.motion", 0, Recording::Direction::output, "float64"},
      {"robot.control.memory.count", 0, Recording::Direction::memory, "uint32"},
      {"robot.control.memory.last", 0, Recording::Direction::memory, "{x: float64, seen: bool}"}};
  run.value(1.0, 0, 0, 0, bytes_of(0.5))
      .value(1.0, 0, 1, 0, bytes_of(std::uint32_t{7}))
      .value(1.5, 0, 2, 0, bytes_of(0.25) + "\1");
  Selection selection;
  selection.events = false;
  selection.values = "control.memory.";
  std::ostringstream text, table, trace;
  tessera::replay::print_events(run.recording, selection, text);
  EXPECT_EQ(text.str(),
            "      1.000000 robot.control.memory.count = 7\n"
            "      1.500000 robot.control.memory.last = {x: 0.25, seen: true}\n");
  tessera::replay::write_values_csv(run.recording, selection, table);
  EXPECT_EQ(table.str(),
            "time_ns,buffer,status,stamp_ns,value,x,seen\n"
            "1000000000,robot.control.memory.count,,,7,,\n"
            "1500000000,robot.control.memory.last,,,,0.25,true\n");
  tessera::replay::write_perfetto(run.recording, trace);
  EXPECT_NE(trace.str().find("\"control.memory.last.x\""), std::string::npos) << trace.str();
}

TEST(Events, SafeCommandsArePrinted) {
  Constructed run({"robot.motor"});
  run.safe(1.0, 0, tessera::SafeEvent::given, "robot.motor.left: safe command: a fault")
      .safe(1.5, 0, tessera::SafeEvent::ended, "robot.motor.left: commands go to it again");
  std::ostringstream text, table;
  tessera::replay::print_events(run.recording, {}, text);
  EXPECT_EQ(text.str(),
            "      1.000000 robot.motor: robot.motor.left: safe command: a fault\n"
            "      1.500000 robot.motor: robot.motor.left: commands go to it again\n");
  tessera::replay::write_csv(run.recording, {}, table);
  EXPECT_NE(table.str().find(",safe,robot.motor,1,robot.motor.left: safe command: a fault"),
            std::string::npos)
      << table.str();
}

TEST(Events, ValuesAreATableWithAColumnPerField) {
  std::ostringstream text;
  Selection selection;
  selection.values = "mot";
  selection.to_s = 1.5;
  tessera::replay::write_values_csv(a_run().recording, selection, text);
  std::istringstream lines(text.str());
  std::string head, line;
  std::getline(lines, head);
  EXPECT_EQ(head.substr(0, head.find(",[0]")), "time_ns,buffer,status,stamp_ns,linear,angular");
  EXPECT_NE(head.find(",[15],value"), std::string::npos) << head;
  const std::string none(17, ',');
  for (const std::string& expected :
       {"1000000000,robot.control.motion,,,0.5,-3" + none,
        "1300000000,robot.motor.velocity,,1000000000,0.5,-3" + none,
        "1400000000,robot.motor.velocity,invalid,1400000000,0.5,-3" + none,
        "1400000000,robot.motor.image,,,," + none, "1500000000,robot.motor.sensed,,,," + none + "true"}) {
    std::getline(lines, line);
    EXPECT_EQ(line, expected);
  }
}

TEST(Events, CsvHasARowPerEvent) {
  std::ostringstream text;
  Selection selection;
  selection.values = "sensed";
  selection.events = false;
  tessera::replay::write_csv(a_run().recording, selection, text);
  EXPECT_EQ(text.str(),
            "time_ns,sequence,kind,subsystem,version,text\n"
            "1500000000,0,value,robot.motor,16,robot.motor.sensed = true\n"
            "1600000000,0,value,robot.motor,32,robot.motor.sensed = no value\n");
}

TEST(Perfetto, NumbersInBuffersAreCounters) {
  std::ostringstream text;
  tessera::replay::write_perfetto(a_run().recording, text);
  const nlohmann::json trace = nlohmann::json::parse(text.str());
  std::vector<double> linear;
  for (const nlohmann::json& event : trace.at("traceEvents"))
    if (event.at("ph") == "C" && event.at("name") == "control.motion.linear")
      linear.push_back(event.at("args").at("value").get<double>());
  EXPECT_EQ(linear, (std::vector<double>{0.5, 0.25}));
}

}  // namespace
