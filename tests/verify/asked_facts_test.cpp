// Properties and conditions ask the facts of a net.
#include <gmock/gmock.h>

#include "proved.hpp"

namespace tessera::verify {
namespace {

std::string lending(const std::string& conditions, const std::string& properties) {
  return R"(tessera: 1
system: s
agents:
  desk:
    control:
      rate: 10 Hz
      outputs: { grant: bool }
      memory: { lent_to: { values: [nobody, a] }, n: { counts: 0..2 } }
      behaviours:
        wait: { send: [], receive: [], terminal: true, next: lend, sets: { lent_to: nobody, n: 2 } }
        lend:
          send: [grant]
          receive: []
          terminal: true
          sets: { lent_to: a }
          next: )" +
         conditions + R"(
        odd: { send: [], receive: [], terminal: true, next: wait }
  robot:
    control:
      rate: 10 Hz
      inputs: { grant: bool }
      behaviours:
        ask: { terminal: true, next: work }
        work: { receive: [], terminal: true, next: ask }
channels:
  - { from: desk.control.grant, to: robot.control.grant, receive: blocking, timeout: 1 s }
properties:
)" + properties;
}

Verdict verdict(const std::string& conditions, const std::string& property) {
  const Proved all = proved(lending(conditions, "  - { name: asked, " + property + " }\n"));
  return all["asked"].verdict;
}

const std::string goes_on = "wait";

TEST(AskedFacts, APropertyAsksWhetherAnInputIsFresh) {
  EXPECT_EQ(verdict(goes_on, "reachable: robot.control.grant.fresh"), Verdict::holds);
  EXPECT_EQ(verdict(goes_on, "reachable: not robot.control.grant.fresh and robot.control.work"),
            Verdict::holds);
  // Without the property the net has no such places.
  const net::Net without =
      flattened(lending(goes_on, "  - { name: asked, reachable: robot.control.work }\n"));
  const net::Net with =
      flattened(lending(goes_on, "  - { name: asked, reachable: robot.control.grant.fresh }\n"));
  EXPECT_EQ(with.places().size(), without.places().size() + 2);
}

TEST(AskedFacts, AFactThatTheNetDoesNotKnowIsRefused) {
  const auto complaint = [](const std::string& property) {
    try {
      static_cast<void>(verdict(goes_on, property));
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(complaint("reachable: desk.control.grant.timed_out"),
              ::testing::HasSubstr("the net does not know 'grant.timed_out'"));
  EXPECT_THAT(complaint("reachable: robot.control.grant.timed_out"),
              ::testing::HasSubstr("write not robot.control.grant.fresh"));
  EXPECT_THAT(complaint("reachable: desk.control.grant.fresh"),
              ::testing::HasSubstr("an output is never fresh"));
}

TEST(AskedFacts, ACounterIsComparedWithADecimalNumber) {
  EXPECT_EQ(verdict("[{ to: odd, when: memory.n < 1.5 }, wait]", "never: desk.control.odd"), Verdict::holds);
  EXPECT_EQ(verdict("[{ to: odd, when: 1.5f < memory.n }, wait]", "reachable: desk.control.odd"),
            Verdict::holds);
  EXPECT_EQ(verdict("[{ to: odd, when: memory.n == 1u }, wait]", "never: desk.control.odd"), Verdict::holds);
}

TEST(AskedFacts, AValueMayHaveItsNameInCpp) {
  EXPECT_EQ(verdict("[{ to: odd, when: \"memory.lent_to == Memory::LentTo::nobody\" }, wait]",
                    "never: desk.control.odd"),
            Verdict::holds);
  EXPECT_EQ(verdict("[{ to: odd, when: \"Memory::LentTo::a == memory.lent_to\" }, wait]",
                    "never: desk.control.odd"),
            Verdict::violated);
}

}  // namespace
}  // namespace tessera::verify
