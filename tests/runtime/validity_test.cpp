// Which values are valid, and what a receiver sees of those that are not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <vector>

#include "nets.hpp"
#include "rerun/rerun.hpp"
#include "subsystem/written_outputs.hpp"
#include "tessera/fields.hpp"
#include "tessera/large_array.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

using ::testing::ElementsAre;

// ------------------------------------------------------------------------------------------- receivers

/// An input as a transition function or a condition has seen it.
struct Perceived {
  double value = 0;
  bool fresh = false, valid = false, failed = false;
  std::optional<Duration> age;  // nullopt: no valid value has come
  bool operator==(const Perceived&) const = default;
};
void PrintTo(const Perceived& seen, std::ostream* out) {
  *out << seen.value << (seen.fresh ? " fresh" : "") << (seen.valid ? " valid" : "")
       << (seen.failed ? " failed" : "");
  if (seen.age) *out << " age " << seen.age->count() / 1'000'000 << " ms";
}
[[nodiscard]] Perceived look(const Input<double>& input) {
  return {input, input.fresh, input.valid, input.failed,
          input.age == Duration::max() ? std::nullopt : std::optional(input.age)};
}

/// A sender that may fail, and what its receiver sees: first nothing, then every value.
struct Couple {
  TestSystem system;
  Script sender{.writes = false};
  std::vector<Perceived> seen;

  const System& build() {
    sender.route = [](const ScriptState&, bool) { return 0; };
    Script receiver;
    receiver.call = [this](ScriptState& state) { seen.push_back(look(state.x)); };
    const auto a = system.add("robot.a", nets::nb_sender_persistent, sender, 10ms, 0ms,
                              sender.senses ? Kind::receptor : Kind::control);
    const auto b = system.add("robot.b", nets::b_receiver, receiver);
    system.connect(a, "x", b, "x", buffered);
    return system.system();
  }
  const std::vector<Perceived>& after(Duration duration) {
    build();
    EXPECT_FALSE(run(system, simulated(duration)).failed);
    return seen;
  }
};

TEST(Validity, AnInvalidValueLeavesTheLastValidOneWithItsStampAndAge) {
  Couple pair;
  pair.sender.call = [](ScriptState& state) {
    state.out_x = 10 + static_cast<double>(state.context.iteration);
    if (state.context.iteration == 2 || state.context.iteration == 3) throw std::runtime_error("blind");
  };
  EXPECT_THAT(pair.after(45ms),
              ElementsAre(Perceived{}, Perceived{10, true, true, false, 0ms},
                          Perceived{11, true, true, false, 0ms}, Perceived{11, false, false, true, 10ms},
                          Perceived{11, false, false, true, 20ms}, Perceived{14, true, true, false, 0ms}));
}

TEST(Validity, AnInvalidValueIsNoFirstValue) {
  Couple pair;
  pair.sender.call = [](ScriptState& state) {
    state.out_x = 5;
    if (state.context.iteration == 0) throw std::runtime_error("blind");
  };
  EXPECT_THAT(pair.after(15ms), ElementsAre(Perceived{}, Perceived{0, false, false, true, {}},
                                            Perceived{5, true, true, false, 0ms}));
}

TEST(Validity, AnOutputIsInvalidUntilItIsWritten) {
  Couple pair;
  pair.sender.call = [](ScriptState& state) {
    if (state.context.iteration == 1) state.out_x = 0;
  };
  EXPECT_THAT(pair.after(25ms),
              ElementsAre(Perceived{}, Perceived{0, false, false, true, {}},
                          Perceived{0, true, true, false, 0ms}, Perceived{0, true, true, false, 0ms}));
}

TEST(Validity, AnIterationThatFailsHasWrittenNothing) {
  Couple pair;
  pair.sender.call = [](ScriptState& state) {
    if (state.context.iteration != 0) return;
    state.out_x = 1;
    throw std::runtime_error("blind");
  };
  EXPECT_THAT(pair.after(15ms), ElementsAre(Perceived{}, Perceived{0, false, false, true, {}},
                                            Perceived{0, false, false, true, {}}));
}

TEST(Validity, WhatFollowsAWriteStaysWrittenThroughAFailure) {
  Couple pair;
  pair.sender.call = [](ScriptState& state) {
    if (state.context.iteration == 0) state.out_x = 0;
    if (state.context.iteration == 1) throw std::runtime_error("blind");
  };
  EXPECT_THAT(pair.after(25ms),
              ElementsAre(Perceived{}, Perceived{0, true, true, false, 0ms},
                          Perceived{0, false, false, true, 10ms}, Perceived{0, true, true, false, 0ms}));
}

TEST(Validity, WhatAReceptorComputesFromNoReadingIsInvalid) {
  Couple pair;
  int reads = 0;
  pair.system.devices.sense = [&](double& value) {
    value = 0;
    return ++reads > 2;
  };
  pair.sender.senses = true;
  pair.sender.call = [](ScriptState& state) { state.out_x = state.sensed.value(); };
  EXPECT_THAT(pair.after(25ms),
              ElementsAre(Perceived{}, Perceived{0, false, false, true, {}},
                          Perceived{0, false, false, true, {}}, Perceived{0, true, true, false, 0ms}));
}

TEST(Validity, AReceptorWithoutAReadingMaySayAnotherValue) {
  Couple pair;
  pair.system.devices.sense = [](double&) { return false; };
  pair.sender.senses = true;
  pair.sender.call = [](ScriptState& state) { state.out_x = state.sensed.valid ? 1 : -1; };
  EXPECT_THAT(pair.after(5ms), ElementsAre(Perceived{}, Perceived{-1, true, true, false, 0ms}));
}

TEST(Validity, ADeviceThatThrowsMakesItsInputInvalidAndOlder) {
  TestSystem system;
  int reads = 0;
  system.devices.sense = [&](double& value) {
    value = ++reads;
    if (reads == 2 || reads == 3) throw std::runtime_error("unplugged");
    return reads != 4;
  };
  std::vector<Perceived> seen;
  Script script;
  script.senses = true;
  script.call = [&](ScriptState& state) { seen.push_back(look(state.sensed)); };
  script.route = [&](const ScriptState& state, bool failed) {
    if (failed) seen.push_back(look(state.sensed));
    return 0;
  };
  const auto a = system.add("robot.eye", nets::nb_sender_persistent, script, 10ms, 0ms, Kind::receptor);
  const auto b = system.add("robot.b", nets::b_receiver, {});
  system.connect(a, "x", b, "x", buffered);
  static_cast<void>(run(system, simulated(45ms)));
  EXPECT_THAT(seen,
              ElementsAre(Perceived{1, true, true, false, 0ms}, Perceived{1, false, false, true, 10ms},
                          Perceived{1, false, false, true, 20ms}, Perceived{1, false, false, true, 30ms},
                          Perceived{5, true, true, false, 0ms}));
}

// ------------------------------------------------------------------------------------------- effectors

TEST(Validity, AnEffectorWithoutValidValuesGetsStale) {
  TestSystem system;
  Script control{.writes = false}, motor;
  control.call = [](ScriptState& state) {
    state.out_x = 10;
    if (state.context.iteration > 0) throw std::runtime_error("blind");
  };
  motor.acts = true;
  motor.call = [](ScriptState& state) { state.command = state.x.value(); };
  const auto a = system.add("robot.control", nets::nb_sender_persistent, control, 20ms);
  const auto b = system.add("robot.motor", nets::nb_receiver, motor, 10ms, 50ms, Kind::effector);
  system.connect(a, "x", b, "x", buffered);
  EXPECT_FALSE(run(system, simulated(95ms)).failed);
  // Called at 0 without a value, then with 10 until the value of 0 ms is 50 ms old.
  EXPECT_THAT(system.devices.commands, ElementsAre(-1, 10, 10, 10, 10, 10, -1, -1, -1, -1, -1, -1));
}

TEST(Validity, ARealOutputThatWasNeverWrittenIsTheSafeCommand) {
  TestSystem system;
  Script motor;
  motor.acts = true;
  std::vector<double> before;
  motor.call = [&](ScriptState& state) {
    before.push_back(state.command);
    if (state.context.iteration == 2) state.command = 0;
  };
  system.add("robot.motor", nets::alone, motor, 10ms, 0ms, Kind::effector);
  EXPECT_FALSE(run(system, simulated(35ms)).failed);
  EXPECT_THAT(system.devices.commands, ElementsAre(-1, -1, 0, 0, -1));
  EXPECT_THAT(before, ElementsAre(0, 0, 0, 0)) << "the function finds zero, as it always did";
}

// ------------------------------------------------------------------------------------------- again

TEST(Validity, ARunWithInvalidValuesRunsTheSameAgain) {
  const auto build = [](Couple& pair) -> const System& {
    pair.system.devices.sense = [](double& value) {
      static int reads = 0;
      value = 0;
      return ++reads % 3 == 0;
    };
    pair.sender.senses = true;
    pair.sender.call = [](ScriptState& state) {
      if (state.sensed.fresh) state.out_x = state.sensed.value();
      if (state.context.iteration % 5 == 4) throw std::runtime_error("blind");
    };
    return pair.build();
  };
  RunOptions options = simulated(300ms);
  options.recording = scratch_file("run");
  {
    Couple pair;
    build(pair);
    static_cast<void>(run(pair.system, options));
    EXPECT_THAT(pair.seen, ::testing::Contains(Perceived{0, false, false, true, {}}));
    EXPECT_THAT(pair.seen, ::testing::Contains(Perceived{0, true, true, false, 0ms}));
  }
  Couple pair;
  std::string error;
  const auto report = rerun(build(pair), {}, options.recording, error);
  ASSERT_TRUE(report) << error;
  EXPECT_FALSE(report->first) << report->first->what;
}

// ------------------------------------------------------------------------------------------- structures

struct Spot {
  double x{}, y{};
  TESSERA_FIELDS(Spot, x, y)
};
struct Switches {
  bool left{};
  std::int32_t count{};
  TESSERA_FIELDS(Switches, left, count)
};
struct Sweep {
  std::array<float, 3> ranges{};
  bool known{};
  Spot origin{};
  TESSERA_FIELDS(Sweep, ranges, known, origin)
};
struct Photo {
  LargeArray<float, 2000> pixels{};
  BoundedString<8> name{};
  TESSERA_FIELDS(Photo, pixels, name)
};

/// The outputs of a subsystem, with or without real inputs.
struct Written {
  Output<Spot> point;
  Output<Switches> flags;
  Output<Sweep> scan;
  Output<Photo> image;
  Output<bool> closed;
  Input<double> first, second;
  SubsystemParts parts;
  std::optional<WrittenOutputs> written;

  explicit Written(bool senses = false) {
    parts.bindings.output("point", point);
    parts.bindings.output("flags", flags);
    parts.bindings.output("scan", scan);
    parts.bindings.output("image", image);
    parts.bindings.output("closed", closed);
    if (senses) {
      parts.bindings.real_input("first", first);
      parts.bindings.real_input("second", second);
    }
    written.emplace(parts);
  }
  void iterate(const std::function<void()>& call) {
    written->keep();
    written->before_call();
    call();
    written->after_call();
  }
  [[nodiscard]] std::vector<bool> all() const {
    std::vector<bool> all;
    for (std::uint32_t output = 0; output < 5; ++output) all.push_back(written->has(output));
    return all;
  }
};
using Which = std::vector<bool>;  // point, flags, scan, image, closed

TEST(WrittenOutputs, AreNoneOfThoseThatNobodyTouches) {
  Written outputs;
  for (int i = 0; i < 3; ++i) outputs.iterate([] {});
  EXPECT_EQ(outputs.all(), Which(5));
  EXPECT_TRUE(is_initial<Spot>(outputs.point) && is_initial<Sweep>(outputs.scan)) << "no mark is left";
}

TEST(WrittenOutputs, AreThoseThatAreAssignedAsAWholeWhateverTheValue) {
  Written outputs;
  outputs.iterate([&] {
    outputs.point = Spot{};
    outputs.flags = Switches{};
    outputs.scan = Sweep{};
    outputs.image = Photo{};
    outputs.closed = false;
  });
  EXPECT_EQ(outputs.all(), Which(5, true));
}

TEST(WrittenOutputs, AreThoseThatGetTheValueOfAnother) {
  Written outputs;
  Output<bool> other;
  Output<Switches> flags;
  outputs.iterate([&] {
    outputs.closed = other;
    outputs.flags = flags;
  });
  EXPECT_EQ(outputs.all(), (Which{false, true, false, false, true}));
}

TEST(WrittenOutputs, AreThoseWithAnAssignedFloatingPointField) {
  Written outputs;
  outputs.iterate([&] {
    outputs.point.y = 0;
    auto& scan = outputs.scan;
    scan.origin.x += 0;
  });
  EXPECT_EQ(outputs.all(), (Which{true, false, true, false, false}));
  Written with_array;
  with_array.iterate([&] { with_array.scan.ranges = {}; });
  EXPECT_TRUE(with_array.written->has(2));
}

TEST(WrittenOutputs, AreThoseWithAnAssignedZeroWithAMinus) {
  Written outputs;
  for (int i = 0; i < 2; ++i) outputs.iterate([&] { outputs.point.x = -0.0; });
  EXPECT_TRUE(outputs.written->has(0));
}

TEST(WrittenOutputs, AreThoseThatChangeThroughAReference) {
  Written outputs;
  const auto fill = [](Switches& flags) { flags.count = 3; };
  outputs.iterate([&] {
    fill(outputs.flags);
    outputs.image.pixels[1999] = 1;
  });
  EXPECT_EQ(outputs.all(), (Which{false, true, false, true, false}));
}

TEST(WrittenOutputs, OfOtherFieldsWithTheirInitialValuesAreExplainedOnce) {
  Written outputs;
  outputs.iterate([&] { outputs.flags.left = false; });
  EXPECT_FALSE(outputs.written->has(1));
  EXPECT_TRUE(outputs.written->should_explain(1));
  EXPECT_FALSE(outputs.written->should_explain(1));
  EXPECT_FALSE(outputs.written->should_explain(0)) << "every field of it tells";
}

TEST(WrittenOutputs, OfAReceptorNeedAReading) {
  Written outputs(/*senses=*/true);
  const auto write = [&] {
    outputs.point = Spot{};
    outputs.flags.left = false;
    outputs.scan.origin.x = 0;
    outputs.closed = false;
  };
  outputs.iterate(write);
  EXPECT_EQ(outputs.all(), Which(5));
  outputs.first.age = 0ms;
  outputs.iterate(write);
  EXPECT_EQ(outputs.all(), (Which{true, false, true, false, true}))
      << "flags may be those of the other device";
  outputs.second.age = 0ms;
  outputs.iterate(write);
  EXPECT_EQ(outputs.all(), Which(5, true)) << "nothing tells whether the flags and the image were written";
}

}  // namespace
}  // namespace tessera::testing
