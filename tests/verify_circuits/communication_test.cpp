#include <gtest/gtest.h>

#include <vector>

#include "verify_circuits/judged.hpp"
#include "verify_circuits/random_system.hpp"

namespace tessera::test {
namespace {

using verify::Side;

struct Mode {
  SystemBuilder::Ends ends;
  const char* sender;
  const char* receiver;
};

TEST(Communication, BlocksOfEveryModeAreRecognised) {
  const std::vector<Mode> modes{
      {{false, false, false, false}, "send 0", "receive 0"},
      {{false, true, false, false}, "send 0", "receive 0!"},
      {{false, true, false, true}, "send 0", "receive 0!~"},
      {{true, false, false, false}, "send 0!", "receive 0"},
      {{true, false, true, false}, "send 0!~", "receive 0"},
      {{true, true, false, false}, "send 0!", "receive 0!"},
      {{true, true, true, true}, "send 0!~", "receive 0!~"},
  };
  for (const Mode& mode : modes) {
    SystemBuilder system;
    const auto from = system.subsystem(), to = system.subsystem();
    const auto channel = system.channel(from, to, mode.ends);
    system.behaviour(from, {channel}, {});
    system.behaviour(to, {}, {channel});
    EXPECT_EQ(
        in_text(judge(system.result()).structure),
        std::string("a0.s0.b0: ") + mode.sender + ", repeats\na1.s1.b0: " + mode.receiver + ", repeats\n");
  }
}

TEST(Communication, OrderAndForksAreThoseOfThePages) {
  SystemBuilder system;
  const auto a = system.subsystem(), b = system.subsystem();
  const auto x = system.channel(a, b, {}), y = system.channel(a, b, {}), z = system.channel(b, a, {});
  system.behaviour(a, {y, x}, {z});
  system.behaviour(b, {z}, {x, y}, spec::Transfer::parallel);
  EXPECT_EQ(in_text(judge(system.result()).structure),
            "a0.s0.b0: send 0, send 1, receive 2, repeats\n"
            "a1.s1.b0: send 2, [receive 1 | receive 0], repeats\n");
}

TEST(Communication, ReceivesComeFirstWhereTheSubsystemReceivesFirst) {
  SystemBuilder system;
  const auto a = system.subsystem(), b = system.subsystem();
  const auto x = system.channel(a, b, {}), y = system.channel(a, b, {}), z = system.channel(b, a, {});
  const auto first = system.behaviour(a, {y, x}, {z}), second = system.behaviour(a, {}, {z});
  system.leave(a, first, false, {second});
  system.behaviour(b, {z}, {x, y}, spec::Transfer::parallel);
  system.receive_first(a);
  system.receive_first(b);
  EXPECT_EQ(in_text(judge(system.result()).structure),
            "a0.s0.b0: receive 0, send 1, send 2, repeats -> a0.s0.b1\n"
            "a0.s0.b1: receive 0, repeats\n"
            "a1.s1.b0: [receive 2 | receive 1], send 0, repeats\n");
}

TEST(Communication, ConstantConditionsDecideWhatMayFollow) {
  SystemBuilder system;
  const auto a = system.subsystem();
  const auto first = system.behaviour(a, {}, {}), second = system.behaviour(a, {}, {});
  system.behaviour(a, {}, {});  // no behaviour leads there
  system.leave(a, first, true, {second});
  system.leave(a, second, false, {first, {}});
  EXPECT_EQ(in_text(judge(system.result()).structure),
            "a0.s0.b0: -> a0.s0.b1\na0.s0.b1: repeats -> a0.s0.b0 -> end\n");
}

TEST(Communication, ExceptionsAddErrorsThatConditionsRuleOut) {
  SystemBuilder system;
  const auto a = system.subsystem();
  system.behaviour(a, {}, {});
  const spec::Model model = system.result();
  EXPECT_EQ(in_text(judge(model).structure), "a0.s0.b0: repeats\n");
  EXPECT_EQ(in_text(judge(model, verify::Assume::exceptions).structure), "a0.s0.b0: repeats -> end\n");
}

TEST(Communication, ABehaviourWithoutAnEntryForAllOtherCasesIsIncomplete) {
  SystemBuilder system;
  const auto a = system.subsystem();
  const auto first = system.behaviour(a, {}, {});
  spec::Model model = system.result();
  spec::Behaviour& behaviour = model.definitions.front().subsystems.front().behaviours.front();
  behaviour.terminal.kind = spec::Condition::Kind::always;
  behaviour.next.front().behaviour = first;
  behaviour.next.front().when.kind = spec::When::Kind::expression;
  behaviour.next.front().when.text.text = "in.ready";
  const Judged judged = judge(model);
  EXPECT_EQ(in_text(judged.structure), "a0.s0.b0: -> a0.s0.b0 -> nowhere\n");
  EXPECT_EQ(judged.report.goes_on, verify::Answer::unknown);
  EXPECT_EQ(judged.report.groups.front().why_not,
            "'a0.s0': after 'a0.s0.b0' none of the initial conditions may hold");
}

/// Copies a net with one transition changed.
net::Net changed(const net::Net& net, const std::string& transition, net::PlaceId also_into) {
  net::Net copy(net.shared_parts());
  for (const net::Place& place : net.places()) copy.add(place);
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
    const net::TransitionId id{index};
    std::vector<net::Arc> outputs(net.postset(id).begin(), net.postset(id).end());
    if (net[id].name == transition) outputs.push_back({also_into});
    copy.add(net[id], net.preset(id), outputs);
  }
  return copy;
}

TEST(Communication, ANetOfAnotherShapeIsRefusedWithTheReason) {
  SystemBuilder system;
  const auto a = system.subsystem(), b = system.subsystem();
  const auto channel = system.channel(a, b, {true, true});
  system.behaviour(a, {channel}, {});
  system.behaviour(b, {}, {channel});
  const net::Net net = flat_net(system.result());
  net::PlaceId ack, other;
  for (std::uint32_t place = 0; place < net.places().size(); ++place) {
    if (net.places()[place].name.ends_with(".ack")) ack = {place};
    if (net.places()[place].name == "a1.s1.out") other = {place};
  }
  ASSERT_TRUE(verify::communication_structure(net).structure);
  const auto odd = verify::communication_structure(changed(net, "a0.s0.b0.snd.y0.t2", ack)).structure;
  ASSERT_TRUE(odd);
  EXPECT_TRUE(odd->channels.front().own_model);
  EXPECT_EQ(verify::communication_structure(changed(net, "a0.s0.b0.t2", other)).why_not,
            "'a0.s0.b0.t2' joins more than a subsystem and a channel");
  EXPECT_EQ(verify::communication_structure(changed(net, "a0.t_in", ack)).why_not,
            "'a0.t_in' of the upper layers uses a channel");
}

}  // namespace
}  // namespace tessera::test
