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

TEST(Plan, NamesWhatDoesNotResolve) {
  const std::initializer_list<Place> ends{{"in"}, {"out"}};
  EXPECT_EQ(complaint(ends, {{"t", {"in"}, {"nowhere"}}}), "no place is named 'nowhere'");
  EXPECT_EQ(complaint(ends, {{"t", {"in", "z/full"}, {"out"}}}), "no port is named 'z'");
  EXPECT_EQ(complaint(ends, {{"t", {"in", "x/ack"}, {"out"}}}), "'t': its channel has no place 'x/ack'");
  EXPECT_EQ(complaint(ends, {{"t", {"in", "x/full"}, {"out", "y/full"}}}), "'t' touches two channels");
  EXPECT_EQ(complaint(ends, {{"t", {"x/full"}, {"out"}}}), "'t' takes from no place of its subsystem");
  EXPECT_EQ(complaint(ends, {{"t", {"in"}, {"out"}, if_error}}), "no place decides the condition of 't'");
  EXPECT_EQ(complaint(ends, {{"t", {"in"}, {"out"}, if_elapsed}}), "'t' waits for the timeout of no channel");
  EXPECT_EQ(complaint({{"in"}, {"in"}, {"out"}}, {}), "'in' is declared twice");
  EXPECT_EQ(complaint({{"in"}}, {}), "no place is named 'out'");
  EXPECT_EQ(complaint({{"in"}, {"out", calls("work")}}, {}), "no behaviour is named 'work'");
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
