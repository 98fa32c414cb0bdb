#include "nets/plan.hpp"

#include <gtest/gtest.h>

#include "nets.hpp"

namespace tessera::testing {
namespace {

constexpr Port port[] = {{"x", Side::send, "x"}, {"y", Side::send, "y"}};
const std::span<const FusedPlace> two_channels[] = {buffered, buffered};

[[nodiscard]] std::string complaint(std::initializer_list<Place> with,
                                    std::initializer_list<Transition> transitions,
                                    std::span<const std::span<const FusedPlace>> fused = two_channels) {
  const std::vector<Place> rows(with);
  const std::vector<Transition> arcs(transitions);
  std::string error;
  EXPECT_FALSE(compile({{}, port, rows, arcs}, fused, error));
  return error;
}

TEST(Plan, TellsWhichNumberDoesNotExist) {
  const std::initializer_list<Place> ends{{"in"}, {"out"}};
  EXPECT_EQ(complaint(ends, {{"t", {0}, {2}}}), "there is no place 2");
  EXPECT_EQ(complaint(ends, {{"t", {0, memory(2, 1)}, {1}}}), "there is no port 2");
  EXPECT_EQ(complaint(ends, {{"t", {0, memory(0, 2)}, {1}}}), "'t': its channel has no place 2");
  EXPECT_EQ(complaint(ends, {{"t", {0, memory(0, 1)}, {1, memory(1, 1)}}}), "'t' touches two channels");
  EXPECT_EQ(complaint(ends, {{"t", {memory(0, 1)}, {1}}}), "'t' takes from no place of its subsystem");
  EXPECT_EQ(complaint(ends, {{"t", {0}, {1}, if_error}}), "no place decides the condition of 't'");
  EXPECT_EQ(complaint(ends, {{"t", {0}, {1}, if_elapsed}}), "'t' waits for the timeout of no channel");
  EXPECT_EQ(complaint({{"in"}}, {}), "there is no place 1");
  EXPECT_EQ(complaint({{"in"}, {"out", calls(0)}}, {}), "there is no behaviour 0");
  const std::span<const FusedPlace> one_missing[] = {buffered, {}};
  EXPECT_EQ(complaint(ends, {}, one_missing), "port 'y' has no channel");
}

TEST(Plan, TimedWaysOutOfAPlaceComeLast) {
  std::string error;
  const std::span<const FusedPlace> fused[] = {buffered};
  const auto plan = compile(nets::b_receiver_timed, fused, error);
  ASSERT_TRUE(plan) << error;
  for (std::uint32_t place = 0; place < plan->places.size(); ++place) {
    bool timed = false;
    for (const std::uint32_t transition : plan->leaving_of(place)) {
      const bool is_timed = plan->transitions[transition].guard.kind == Guard::Kind::elapsed;
      EXPECT_TRUE(is_timed || !timed);
      timed = timed || is_timed;
    }
  }
}

}  // namespace
}  // namespace tessera::testing
