#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "../environment.hpp"
#include "explorer.hpp"

namespace tessera::test {
namespace {

struct Mode {
  std::string name;
  Sides sides;
};

std::vector<Mode> modes() {
  const layers::SideMode free{false, false}, waits{true, false}, patient{true, true};
  return {{"non_blocking_to_non_blocking", {free, free, true}},
          {"non_blocking_to_blocking", {free, waits}},
          {"non_blocking_to_patient", {free, patient}},
          {"blocking_to_non_blocking", {waits, free}},
          {"blocking_to_blocking", {waits, waits}},
          {"patient_to_non_blocking", {patient, free}},
          {"patient_to_blocking", {patient, waits}}};
}

class Protocol : public testing::TestWithParam<Mode> {
 protected:
  static void expect_right(const Bounds& bounds) {
    Explorer<network::Sender, network::Receiver> explorer(GetParam().sides, bounds);
    EXPECT_EQ(explorer.run(), "");
    RecordProperty("states", static_cast<int>(explorer.size()));
    EXPECT_GT(explorer.size(), 100U);
  }
};

/// Before a restart; an order of more takes minutes under a sanitizer.
constexpr std::uint32_t writes = sanitized ? 1 : 2;

// Every trace is one of the net that the layers draw; every value is read once, in order; the result of a
// blocking send is true; and no side waits for ever if repeated messages arrive.
TEST_P(Protocol, DoesWhatTheNetDoes) { expect_right({.writes = 3}); }
TEST_P(Protocol, SurvivesARestartOfItsSender) { expect_right({.writes = writes, .sender_restarts = 1}); }
TEST_P(Protocol, SurvivesARestartOfItsReceiver) { expect_right({.writes = writes, .receiver_restarts = 1}); }

// TESSERA_PROTOCOL_DEEP=1 takes minutes.
TEST_P(Protocol, SurvivesRestartsOfBoth) {
  const bool deep = from_environment("TESSERA_PROTOCOL_DEEP", 0) > 0;
  expect_right({.writes = deep ? 2U : 1U, .sender_restarts = 1, .receiver_restarts = 1});
  if (deep) expect_right({.writes = 4});
  if (deep) expect_right({.writes = 3, .data = 3, .states = 3});
}

INSTANTIATE_TEST_SUITE_P(Modes, Protocol, testing::ValuesIn(modes()),
                         [](const auto& given) { return given.param.name; });

}  // namespace
}  // namespace tessera::test
