#pragma once

#include <array>
#include <string>
#include <string_view>

/// Conditions that compile, and the system that they belong to: neither `check` nor the compiler refuses them.
namespace tessera::test {

/// As a scalar of YAML.
inline std::string in_quotes(std::string_view condition) {
  std::string quoted;
  for (const char c : condition) quoted += c == '\'' ? std::string("''") : std::string(1, c);
  return "'" + quoted + "'";
}

/// A system with conditions: one in quotes, or a map.
inline std::string with_terminal(const std::string& terminal) {
  return R"(tessera: 1
system: s
types:
  Line: { left: bool, middle: bool, distance: float64 m }
  Scan: { ranges: "float64[8] m", origin: Line, label: string<=16, parts: "Line[3]" }
parameters: { limit: 0.5 m, hold: 2 s, verbose: false, label: "a" }
agents:
  robot:
    control:
      rate: 20 Hz
      inputs: { line: Line, scan: Scan, go: bool, level: float64, name: string, numbers: "int32[4]", large: "uint8[8192]" }
      outputs: { motion: float64 m/s }
      memory: { count: uint32, seconds: float64 s, last: Line, flag: bool, text: string<=8 }
      parameters: { gap: 0.1 m, tries: { type: int32, default: 3 }, pause: { type: uint32, default: 250, unit: ms } }
      behaviours:
        work: { terminal: )" +
         terminal + R"(, next: work }
    receptors:
      eye:
        rate: 20 Hz
        outputs: { line: Line, scan: Scan, go: bool, level: float64, name: string, numbers: "int32[4]", large: "uint8[8192]" }
        behaviours: { look: {} }
    effectors:
      motor: { rate: 20 Hz, inputs: { speed: float64 m/s }, behaviours: { drive: {} } }
channels:
  - robot.eye.line -> robot.control.line
  - robot.eye.scan -> robot.control.scan
  - robot.eye.go -> robot.control.go
  - robot.eye.level -> robot.control.level
  - robot.eye.name -> robot.control.name
  - robot.eye.numbers -> robot.control.numbers
  - robot.eye.large -> robot.control.large
  - robot.control.motion -> robot.motor.speed
)";
}

// clang-format off
inline constexpr auto legal_conditions = std::to_array<const char*>({
    "in.line.left",
    "!in.line.left && (in.line.middle || in.go)",
    "in.go and not in.line.left",
    "in.level > 0.5",
    "in.level.value() > 0.5",
    "in.go == in.line.left",
    "in.line.age > 1s",
    "in.line.age > 500 ms",
    "in.line.age > 1.5 s",
    "in.line.age >= std::chrono::milliseconds(20)",
    "in.line.age.count() > 5'000",
    "in.line.age > 2 * 100ms + 1 s",
    "in.line.age / 2 > 1 s",
    "-in.line.age < 0s",
    "in.line.age * 2 > elapsed",
    "in.line.age / 1 ms > 3",
    "in.line.stamp > in.scan.stamp",
    "in.line.stamp - in.scan.stamp > 2 s",
    "in.line.stamp + 2 s > in.scan.stamp",
    "in.line.stamp.time_since_epoch() > 1s",
    "tessera::seconds(in.line.age) > memory.seconds",
    "elapsed > 2 s",
    "elapsed >= 1 min && in.line.fresh",
    "elapsed.count() % 2 == 0",
    "tessera::seconds(elapsed) > parameters.hold",
    "elapsed > parameters.hold",
    "parameters.hold <= in.line.age",
    "in.line.age > memory.seconds && memory.seconds < 2 s",
    "elapsed - 1 s > 2 * parameters.hold + 500 ms",
    "elapsed + parameters.hold / 4 > (parameters.hold + memory.seconds) * 1.5",
    "in.line.age > (in.go ? parameters.hold : 500 ms)",
    "elapsed / parameters.hold > 0.5",
    "in.line.stamp + parameters.hold < in.scan.stamp",
    "elapsed > parameters.pause || elapsed == -parameters.pause",
    "index == 0",
    "memory.count % 10 == index",
    "memory.count > 100",
    "memory.count",
    "memory.last == in.line",
    "memory.last.distance < parameters.gap",
    "memory.flag ? in.line.left : in.line.middle",
    "(memory.flag ? in.line.age : elapsed) > 1 s",
    "in.scan.ranges[0] < 0.2",
    "in.scan.ranges[memory.count] < 0.2",
    "in.scan.ranges.size() > 3",
    "in.scan.ranges.front() < in.scan.ranges.back()",
    "in.scan.parts[2].left",
    "in.scan.origin.left || in.scan.label == \"wall\"",
    "in.scan.label.size() > 3",
    "in.scan.parts[0] == memory.last",
    "in.numbers[3] > 4",
    "in.numbers == in.numbers",
    "in.large[4095] > 4",
    "in.name == \"stop\"",
    "in.name.view().starts_with(\"st\")",
    "in.name != memory.text",
    "parameters.verbose && parameters.tries > 2",
    "parameters.label == \"a\"",
    "std::abs(in.level) > 1e-3",
    "std::max(in.level.value(), memory.seconds) > 1",
    "std::max<double>(in.level, memory.seconds) > 1",
    "static_cast<int>(in.level) == 3",
    "static_cast<std::int64_t>(in.level) == 3",
    "(int)in.level == 3",
    "(double)memory.count > 0.5",
    "double(memory.count) > 0.5",
    "int{3} > 2",
    "sizeof(int) == 4",
    "in.level > 3.5f",
    "in.level > 0x1F",
    "in.level > 1.5e-3",
    "in.level > std::numeric_limits<double>::epsilon()",
    "(memory.count & 3) == 0",
    "in.level > 1 && in.level < 2 || in.go",
    "memory.count == 1 | memory.count == 3",
    "std::cmp_greater(memory.count, -1)",
    "(memory.count >> 2) > 1",
    "~memory.count == 0",
    "(memory.count ^ 1u) != 0u",
    "out.motion > 0.1 || out.motion.timed_out",
    "out.motion.stamp > in.line.stamp",
    "in.line.disconnected || !in.line.valid || in.line.timed_out",
    "memory.last == Line{true, false, 1.0}",
    "Line{in.go}.left",
    "in.go || true",
    "(in.level > 0) == in.go",
    "'a' < 'b'",
    "INT32_MAX > 3",
    "in.level * 2 > memory.seconds + 1",
    "nullptr == nullptr",
    "in.line.Line::left",
    "std::get<0>(in.numbers) > 1",
    "get<0>(in.numbers) > 1",
});
// clang-format on

}  // namespace tessera::test
