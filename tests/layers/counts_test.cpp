#include "net/counts.hpp"

#include <gtest/gtest.h>

#include "layers/models.hpp"

namespace tessera::test {
namespace {

net::Counts counts_of(const spec::Model& model) {
  const Built built = build(model);
  return net::count(built.pages, built.net);
}

// The line follower: 1 agent, 3 subsystems, 4 behaviours (init, follow, watch, drive), 8 communication pages.
//
//   layer          places                pages          transitions                      arcs
//   system         in, out = 2           1 agent        t_in, t_out = 2                  2 * 2 = 4
//   agent          in, out = 2           3 subsystems   t_in, t_out = 2                  2 * (1 + 3) = 8
//   subsystem      3 * 2 = 6             4 behaviours   3 t_in + 4 next = 7              7 * 2 = 14
//   behaviour      4 * 3 = 12            4 * 2 = 8      4 * 6 = 24                       24 * 2 = 48
//   communication  22, see below         0              17                               50
//     init.snd, follow.snd   motion, NB -> B   2 * (3 places, t1 t1o t2 = 3, 9 arcs)  =  6,  6, 18
//     init.rcv, follow.rcv   line, NB -> NB    2 * (3 places, t1 t2 = 2, 6 arcs)      =  6,  4, 12
//     watch.snd              line                   3 places, 2 transitions, 6 arcs   =  3,  2,  6
//     watch.rcv, drive.snd   nothing           2 * (2 places, 1 transition, 2 arcs)   =  4,  2,  4
//     drive.rcv              velocity, timeout      3 places, t1 t2 timeout, 3+3+4    =  3,  3, 10
//   fused: line.channel; velocity.empty, velocity.full = 3
TEST(LayerCounts, OfTheLineFollowerAreThoseCountedByHand) {
  const net::Counts counts = counts_of(line_follower());
  EXPECT_EQ(counts.layers[0], (net::Counts::Layer{2, 2, 1}));
  EXPECT_EQ(counts.layers[1], (net::Counts::Layer{2, 2, 3}));
  EXPECT_EQ(counts.layers[2], (net::Counts::Layer{6, 7, 4}));
  EXPECT_EQ(counts.layers[3], (net::Counts::Layer{12, 24, 8}));
  EXPECT_EQ(counts.layers[4], (net::Counts::Layer{22, 17, 0}));
  EXPECT_EQ(counts.fused, 3U);
  EXPECT_EQ(counts.places, 2U + 2 + 6 + 12 + 22 + 3);
  EXPECT_EQ(counts.transitions, 2U + 2 + 7 + 24 + 17);
  EXPECT_EQ(counts.arcs, 4U + 8 + 14 + 48 + 50);
}

// A fleet shares only the system's in, out, t_in and t_out; these two have an arc to every agent.
TEST(LayerCounts, OfAFleetGrowWithItsAgents) {
  const net::Counts one = counts_of(fleet(1));
  const net::Counts ten = counts_of(fleet(10));
  EXPECT_EQ(ten.places, 2 + 10 * (one.places - 2));
  EXPECT_EQ(ten.fused, 10 * one.fused);
  EXPECT_EQ(ten.transitions, 2 + 10 * (one.transitions - 2));
  EXPECT_EQ(ten.arcs, 2 + 10 * (one.arcs - 2));
  EXPECT_EQ(ten.layers[0], (net::Counts::Layer{2, 2, 10}));
  EXPECT_EQ(ten.layers[4].places, 10 * one.layers[4].places);
}

struct PageCase {
  const char* name;
  Modes modes;
  std::size_t channels;
  spec::Transfer transfer;
  std::size_t snd_places, snd_transitions, rcv_places, rcv_transitions, fused;
};

constexpr auto sequential = spec::Transfer::sequential;
constexpr auto parallel = spec::Transfer::parallel;

// Sequential: k blocks share their ends, so 1 + k * (places of a block - 1). Parallel: 2 + k * places of a
// block, and fork and join. A block has in, 2, out, and a blocking sender `wait`.
const std::vector<PageCase> page_cases{
    {"nothing", {}, 0, sequential, 2, 1, 2, 1, 0},
    {"nothing side by side", {}, 0, parallel, 2, 1, 2, 1, 0},
    {"one NB NB", {N, N}, 1, sequential, 3, 2, 3, 2, 1},
    {"one NB NB parallel is the block itself", {N, N}, 1, parallel, 3, 2, 3, 2, 1},
    {"two NB NB", {N, N}, 2, sequential, 5, 4, 5, 4, 2},
    {"three NB NB", {N, N}, 3, sequential, 7, 6, 7, 6, 3},
    {"two NB NB parallel", {N, N}, 2, parallel, 8, 6, 8, 6, 2},
    {"three NB NB parallel", {N, N}, 3, parallel, 11, 8, 11, 8, 3},
    {"one NB B", {N, B}, 1, sequential, 3, 3, 3, 2, 2},
    {"one NB B timeout", {N, B, false, true}, 1, sequential, 3, 3, 3, 3, 2},
    {"three NB B timeout", {N, B, false, true}, 3, sequential, 7, 9, 7, 9, 6},
    {"one B NB", {B, N}, 1, sequential, 4, 3, 3, 3, 3},
    {"one B NB timeout", {B, N, true, false}, 1, sequential, 4, 4, 3, 3, 3},
    {"one B B", {B, B}, 1, sequential, 4, 3, 3, 2, 3},
    {"one B B send timeout", {B, B, true, false}, 1, sequential, 4, 4, 3, 2, 3},
    {"one B B both timeouts", {B, B, true, true}, 1, sequential, 4, 4, 3, 3, 3},
    {"two B B", {B, B}, 2, sequential, 7, 6, 5, 4, 6},
    {"three B B parallel with timeouts", {B, B, true, true}, 3, parallel, 14, 14, 11, 11, 9},
};

TEST(LayerCounts, OfCommunicationPagesFollowFromTheirBlocks) {
  for (const PageCase& expected : page_cases) {
    SCOPED_TRACE(expected.name);
    const Built built = build(pair(std::vector<Modes>(expected.channels, expected.modes), expected.transfer));
    EXPECT_EQ(places_of(built.pages, "a.control.give.snd").size(), expected.snd_places);
    EXPECT_EQ(transitions_of(built.pages, "a.control.give.snd").size(), expected.snd_transitions);
    EXPECT_EQ(places_of(built.pages, "a.motor.take.rcv").size(), expected.rcv_places);
    EXPECT_EQ(transitions_of(built.pages, "a.motor.take.rcv").size(), expected.rcv_transitions);
    EXPECT_EQ(net::count(built.pages, built.net).fused, expected.fused);
  }
}

TEST(LayerCounts, AreWrittenAsJson) {
  net::Counts counts;
  counts.places = 5;
  counts.fused = 1;
  counts.transitions = 3;
  counts.arcs = 6;
  counts.layers[1] = {2, 1, 4};
  const std::string text = net::to_json(counts);
  EXPECT_NE(
      text.find(
          "\"flat\": {\n    \"places\": 5,\n    \"fused\": 1,\n    \"transitions\": 3,\n    \"arcs\": 6"),
      std::string::npos)
      << text;
  EXPECT_NE(text.find("\"agent\": {\n      \"places\": 2,\n      \"transitions\": 1,\n      \"pages\": 4"),
            std::string::npos)
      << text;
}

}  // namespace
}  // namespace tessera::test
