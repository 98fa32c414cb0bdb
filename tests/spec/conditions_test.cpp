#include "spec/conditions/tokens.hpp"
#include "spec/legal_conditions.hpp"
#include "spec_reading.hpp"

namespace tessera::spec {
namespace {

std::string with_condition(const std::string& condition) {
  return test::with_terminal(test::in_quotes(condition));
}

TEST(Conditions, LegalOnesAreAccepted) {
  for (const char* condition : test::legal_conditions) {
    const Reading reading(with_condition(condition));
    EXPECT_TRUE(reading.model.has_value()) << condition << "\n" << reading.report();
    EXPECT_EQ(reading.report(), "") << condition;
  }
}

/// The kinds and paths of the names in a condition, with columns counted from its first character.
std::string named(const std::string& condition) {
  const Reading reading(with_condition(condition));
  if (!reading.model) return reading.report();
  const Expression& expression =
      reading.model->definitions[0].subsystems[0].behaviours[0].terminal.expressions[0];
  std::string text;
  for (const Reference& one : references(expression))
    text += (text.empty() ? "" : " ") + one.path + "@" +
            std::to_string(one.span.column - expression.span.column) + "+" + std::to_string(one.span.length);
  return text;
}

TEST(Conditions, NameWhatTheyReferTo) {
  EXPECT_EQ(named("in.line.left"), "in.line@3+4 in.line.left@8+4");
  EXPECT_EQ(named("in.scan.parts[memory.count % 3].distance > parameters.limit"),
            "in.scan@3+4 in.scan.parts@8+5 in.scan.parts.distance@32+8 memory.count@21+5 "
            "parameters.limit@54+5");
  EXPECT_EQ(named("out.motion.timed_out || in.go.age > 500 ms"),
            "out.motion@4+6 out.motion.timed_out@11+9 in.go@27+2 in.go.age@30+3");
  EXPECT_EQ(named("elapsed > 2 s && index == 0"), "elapsed@0+7 index@17+5");
  EXPECT_EQ(named("std::abs(memory.seconds) > 1"), "memory.seconds@16+7");
}

TEST(Conditions, ReferencesKnowTheirTarget) {
  const Reading reading(with_condition("in.scan.origin.middle && parameters.tries > 1 && memory.flag"));
  ASSERT_TRUE(reading.model.has_value()) << reading.report();
  const auto& all =
      references(reading.model->definitions[0].subsystems[0].behaviours[0].terminal.expressions[0]);
  ASSERT_EQ(all.size(), 5U);
  EXPECT_EQ(all[0].kind, Reference::Kind::input);
  EXPECT_EQ(all[0].target, 1U);
  EXPECT_EQ(all[2].kind, Reference::Kind::field);
  EXPECT_EQ(reading.model->structures[all[2].structure].fields[all[2].target.value()].name, "middle");
  EXPECT_EQ(all[3].kind, Reference::Kind::own_parameter);
  EXPECT_EQ(all[3].target, 1U);
  EXPECT_EQ(all[4].kind, Reference::Kind::memory);
}

TEST(Conditions, DurationsBecomeThoseOfCpp) {
  EXPECT_EQ(with_cpp_durations("in.x.age > 500 ms"), "in.x.age > 500ms ");
  EXPECT_EQ(with_cpp_durations("elapsed > 2 s && in.x"), "elapsed > 2s  && in.x");
  EXPECT_EQ(with_cpp_durations("elapsed > 0.5   min"), "elapsed > 0.5min   ");
  EXPECT_EQ(with_cpp_durations("in.x == \"2 s\" && y > 1s"), "in.x == \"2 s\" && y > 1s");
  EXPECT_EQ(with_cpp_durations("a.x2 > 1'000 ms"), "a.x2 > 1'000ms ");
}

}  // namespace
}  // namespace tessera::spec
