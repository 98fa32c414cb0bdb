#include <gtest/gtest.h>

#include "executor_oracle.hpp"
#include "nets.hpp"
#include "nets/flat_net.hpp"
#include "tessera/recording.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

// Every run of the subsystem executors must be possible for the general executor on the same net.

namespace tessera::testing {
namespace {

struct Pair {
  const char* name;
  const SubsystemNet &sender, &receiver;
  std::span<const FusedPlace> places;
};
void PrintTo(const Pair& pair, std::ostream* stream) { *stream << pair.name; }

class SubsystemRuns : public ::testing::TestWithParam<Pair> {};

/// The transitions that fired, in order, as indices into net_of(system).transitions.
[[nodiscard]] std::vector<std::uint32_t> firings_of_a_run(TestSystem& system) {
  RunOptions options = simulated(1s);
  options.recording = scratch_file("run");
  static_cast<void>(run(system, options));
  std::string error;
  const auto recording = read_recording(options.recording, error);
  EXPECT_TRUE(recording) << error;
  std::vector<std::uint32_t> firings;
  for (const Recording::Entry& entry : recording->entries)
    if (entry.event.kind() == Event::Kind::firing) firings.push_back(entry.event.subject);
  return firings;
}

TEST_P(SubsystemRuns, AreRunsOfTheGeneralExecutor) {
  TestSystem system;
  const auto a = system.add("robot.a", GetParam().sender, {}, 3ms);
  const auto b = system.add("robot.b", GetParam().receiver, {}, 2ms);
  system.connect(a, "x", b, "x", GetParam().places, 5ms, 1ms);
  const std::vector<std::uint32_t> recorded = firings_of_a_run(system);
  ASSERT_GT(recorded.size(), 1000U);

  const FlatNet flat = net_of(system.system());
  ExecutableNet net;
  std::size_t next = 0;  // of recorded
  for (const FlatNet::FlatPlace& place : flat.places)
    net.places.push_back({.name = place.name, .tokens = place.tokens});
  for (std::uint32_t t = 0; t < flat.transitions.size(); ++t) {
    ExecutableNet::Transition transition{.name = flat.transitions[t].name};
    for (const std::uint32_t place : flat.transitions[t].inputs) transition.inputs.push_back({place});
    for (const std::uint32_t place : flat.transitions[t].outputs) transition.outputs.push_back({place});
    transition.condition = [&, t] { return next < recorded.size() && recorded[next] == t; };
    net.transitions.push_back(std::move(transition));
  }
  NetExecutor* self = nullptr;
  const auto executor = load(net, {.bound = 1, .on_firing = [&](std::uint32_t) {
                                     ++next;
                                     self->reconsider();
                                   }});
  self = executor.get();
  const NetExecutor::Outcome outcome = executor->run(recorded.size());
  EXPECT_EQ(outcome.end, NetExecutor::End::limit) << outcome.fault;
  EXPECT_EQ(outcome.firings, recorded.size());
}

INSTANTIATE_TEST_SUITE_P(
    Blocks, SubsystemRuns,
    ::testing::Values(Pair{"asynchronous", nets::async_sender, nets::async_receiver, asynchronous},
                      Pair{"nb_to_b", nets::nb_sender, nets::b_receiver, buffered},
                      Pair{"nb_to_b_timed", nets::nb_sender, nets::b_receiver_timed, buffered},
                      Pair{"b_to_nb", nets::b_sender, nets::nb_receiver_ack, acknowledged},
                      Pair{"b_to_b", nets::b_sender, nets::b_receiver_ack, acknowledged},
                      Pair{"b_timed_to_b_timed", nets::b_sender_timed, nets::b_receiver_ack_timed,
                           acknowledged},
                      Pair{"store", nets::store_sender, nets::store_receiver, nets::two_slots}),
    [](const auto& pair) { return pair.param.name; });

}  // namespace
}  // namespace tessera::testing
