// A list `next` may be complete by what is known: answers of the communication, values of memory.
#include <gtest/gtest.h>

#include <string>

#include "spec_reading.hpp"

namespace tessera::spec {
namespace {

std::string asking(const std::string& behaviour, const std::string& channel) {
  return "tessera: 1\nsystem: demo\nagents:\n  a:\n    control:\n      rate: 10 Hz\n"
         "      inputs: { x: bool }\n      memory: { m: { values: [u, v, w] } }\n      behaviours:\n"
         "        one: { " +
         behaviour +
         ", next: [NEXT] }\n        two: { next: { to: one, when: error } }\n"
         "  b:\n    control:\n      rate: 10 Hz\n      outputs: { x: bool }\n      behaviours: { go: { } }\n"
         "channels:\n  - { from: b.control.x, to: a.control.x" +
         channel + " }\n";
}

bool warns(std::string text, const std::string& next) {
  text.replace(text.find("NEXT"), 4, next);
  const Reading reading(text);
  EXPECT_TRUE(reading.model) << reading.report();
  return reading.codes().find("W312") != std::string::npos;
}

TEST(CompleteLists, AreKnownByWhatTheCommunicationHasShown) {
  const std::string text = asking("terminal: true", ", receive: blocking, timeout: 1 s");
  const std::string both = "{ to: two, when: in.x.fresh }, { to: one, when: in.x.timed_out }";
  EXPECT_TRUE(warns(text, both)) << "an invalid value is neither";
  EXPECT_FALSE(warns(text, both + R"(, { to: two, when: "!in.x.fresh && !in.x.timed_out" })"));
  EXPECT_FALSE(warns(text, R"({ to: two, when: in.x.fresh }, { to: one, when: "!in.x.fresh" })"));
  EXPECT_TRUE(
      warns(text, R"({ to: two, when: in.x.fresh && elapsed > 1 s }, { to: one, when: "!in.x.fresh" })"));
}

TEST(CompleteLists, AreKnownByTheValuesOfMemory) {
  const std::string text = asking("terminal: true", "");
  EXPECT_FALSE(warns(text, "{ to: two, when: memory.m == u }, { to: one, when: memory.m != u }"));
  EXPECT_TRUE(warns(text, "{ to: two, when: memory.m == u }, { to: one, when: memory.m == v }"));
  EXPECT_FALSE(warns(text,
                     "{ to: two, when: memory.m == u }, { to: one, when: memory.m == v }, { to: one, when: "
                     "memory.m == w }"));
  // The condition that ends the behaviour counts, too.
  EXPECT_FALSE(warns(asking("terminal: memory.m == u", ""), "{ to: two, when: memory.m != v }"));
}

}  // namespace
}  // namespace tessera::spec
