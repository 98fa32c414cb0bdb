#include <gtest/gtest.h>

#include <tuple>

#include "../environment.hpp"
#include "explore/explore.hpp"
#include "formula_oracle.hpp"
#include "oracle/nets/of_net.hpp"

namespace tessera::explore {
namespace {

using Kind = Answer::Kind;
constexpr std::size_t most_naive_markings = 300;

Kind yes_if(bool truth) { return truth ? Kind::yes : Kind::no; }

/// Every question about one net, asked of the explorer and of the oracle.
class Comparison {
 public:
  Comparison(const net::Net& net, const ReachabilityGraph& naive, oracle::Random& random)
      : net_(net), compiled_(net), naive_(naive), random_(random) {}

  void run() {
    counts();
    finds();
    deadlocks();
    always_reaches();
    leads();
    obligations();
  }

 private:
  Formula formula() { return random_formula(random_, net_, 2); }

  /// The marking that the run leads to, fired on the net itself.
  std::size_t end_of(const Answer& answer) {
    Marking marking = naive_.marking(0);
    for (const TransitionId transition : answer.trace.firings) {
      const auto next = oracle::fired(net_, transition, marking);
      EXPECT_TRUE(next) << "the trace does not replay";
      if (!next) return 0;
      marking = *next;
    }
    EXPECT_EQ(marking, answer.trace.end);
    const auto index = naive_.find(marking);
    EXPECT_TRUE(index);
    return index.value_or(0);
  }

  void counts() {
    const Count counted = count(compiled_, limits_);
    EXPECT_TRUE(counted.complete) << counted.why;
    EXPECT_EQ(counted.markings, naive_.size());
    EXPECT_EQ(counted.edges, naive_.edges().size());
    EXPECT_EQ(counted.most_tokens, naive_.most_tokens());
  }

  void finds() {
    const Formula goal = formula();
    const Answer answer = find(compiled_, goal, limits_);
    const auto shortest = nearest(naive_, goal);
    ASSERT_EQ(answer.kind, yes_if(shortest.has_value()));
    if (answer.kind != Kind::yes) return;
    EXPECT_TRUE(holds(naive_, goal, end_of(answer)));
    EXPECT_EQ(answer.trace.firings.size(), *shortest);
  }

  void deadlocks() {
    const Formula is_final = oracle::below(random_, 2) == 0 ? Formula::never() : formula();
    const Formula unwanted = Formula::all({Formula::dead(), Formula::negation(is_final)});
    const Answer answer = find_deadlock(compiled_, is_final, limits_);
    const auto shortest = nearest(naive_, unwanted);
    ASSERT_EQ(answer.kind, yes_if(shortest.has_value()));
    if (answer.kind != Kind::yes) return;
    EXPECT_TRUE(holds(naive_, unwanted, end_of(answer)));
    if (answer.shortest) {
      EXPECT_EQ(answer.trace.firings.size(), *shortest);
    }
  }

  void always_reaches() {
    const Formula goal = formula();
    const Answer answer = always_reachable(compiled_, goal, limits_);
    ASSERT_EQ(answer.kind, yes_if(always_reachable(naive_, goal)));
    if (answer.kind == Kind::no) {
      EXPECT_FALSE(can_reach(naive_, end_of(answer), goal));
    }
  }

  void leads() {
    const Formula p = formula(), q = formula();
    const Answer answer = leads_to(compiled_, p, q, limits_);
    ASSERT_EQ(answer.kind, yes_if(leads_to(naive_, p, q)));
    if (answer.kind != Kind::no) return;
    EXPECT_FALSE(can_reach(naive_, end_of(answer), q));
    ASSERT_LE(answer.turn, answer.trace.firings.size());
    Marking marking = naive_.marking(0);
    for (std::size_t at = 0; at <= answer.trace.firings.size(); ++at) {
      const std::size_t index = naive_.find(marking).value();
      if (at == answer.turn) {
        EXPECT_TRUE(holds(naive_, p, index));
      }
      if (at >= answer.turn) {
        EXPECT_FALSE(holds(naive_, q, index));
      }
      if (at < answer.trace.firings.size())
        marking = oracle::fired(net_, answer.trace.firings[at], marking).value();
    }
  }

  void obligations() {
    std::vector<Obligation> wanted(2);
    for (Obligation& obligation : wanted) {
      if (oracle::below(random_, 2) == 0) obligation.unless = formula();
      const auto transitions = static_cast<std::uint32_t>(net_.transitions().size());
      for (std::uint32_t more = oracle::below(random_, 3); more > 0 && transitions > 0; --more)
        obligation.any_of.push_back(TransitionId{oracle::below(random_, transitions)});
    }
    const std::vector<Answer> answers = can_always_fire(compiled_, wanted, limits_);
    ASSERT_EQ(answers.size(), wanted.size());
    for (std::size_t at = 0; at < wanted.size(); ++at) {
      std::vector<Formula> ways{wanted[at].unless};
      for (const TransitionId transition : wanted[at].any_of) ways.push_back(Formula::enabled(transition));
      const Formula goal = Formula::any(std::move(ways));
      ASSERT_EQ(answers[at].kind, yes_if(always_reachable(naive_, goal)));
      if (answers[at].kind == Kind::no) {
        EXPECT_FALSE(can_reach(naive_, end_of(answers[at]), goal));
      }
    }
  }

  const net::Net& net_;
  const PtNet compiled_;
  const ReachabilityGraph& naive_;
  oracle::Random& random_;
  const Limits limits_;
};

struct Family {
  const char* name;
  net::Net (*draw)(oracle::Random&);
};

class RandomNets : public testing::TestWithParam<std::tuple<Family, std::uint32_t>> {};

TEST_P(RandomNets, EveryAnswerIsThatOfTheOracle) {
  const auto& [family, part] = GetParam();
  constexpr auto nets = static_cast<std::uint32_t>(share_of(1000));
  std::uint32_t compared = 0;
  for (std::uint32_t seed = part * nets; seed < (part + 1) * nets; ++seed) {
    SCOPED_TRACE(testing::Message() << family.name << " net of seed " << seed);
    oracle::Random random(seed);
    const net::Net net = family.draw(random);
    if (const auto naive = naive_graph(net, most_naive_markings)) {
      Comparison(net, *naive, random).run();
      ++compared;
    } else {
      Limits few;
      few.markings = most_naive_markings / 2;
      EXPECT_FALSE(count(PtNet(net), few).complete);
    }
    if (HasFailure()) return;
  }
  RecordProperty("compared", static_cast<int>(compared));
  EXPECT_GT(compared, nets / 4);
}

constexpr Family machines{"machines", random_machines}, weighted{"weighted", random_weighted},
    wild{"wild", random_wild};

std::string name_of_family(const testing::TestParamInfo<RandomNets::ParamType>& info) {
  return std::string(std::get<0>(info.param).name) + "_" + std::to_string(std::get<1>(info.param));
}

INSTANTIATE_TEST_SUITE_P(Explorer, RandomNets,
                         testing::Combine(testing::Values(machines, weighted, wild), testing::Range(0U, 10U)),
                         name_of_family);

}  // namespace
}  // namespace tessera::explore
