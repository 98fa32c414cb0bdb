// Faults planted in the protocol. Each takes one decision otherwise; the explorer must find it.
#include <gtest/gtest.h>

#include <string>

#include "explorer.hpp"

namespace tessera::test {
namespace {

using network::Data;
using network::Incarnation;
using network::Number;
using network::ReceiverRules;
using network::SenderRules;
using network::State;

constexpr layers::SideMode free_side{false, false}, strict_side{true, false};
constexpr Sides free_to_strict{free_side, strict_side}, strict_to_strict{strict_side, strict_side};
constexpr Sides latest{free_side, free_side, true};
constexpr Bounds both_restart{.writes = 2, .sender_restarts = 1, .receiver_restarts = 1};

template <class Sending, class Receiving>
std::string found(const Sides& sides, const Bounds& bounds) {
  return Explorer<network::BasicSender<Sending>, network::BasicReceiver<Receiving>>(sides, bounds).run();
}
template <class Sending>
std::string sender_fault(const Sides& sides, const Bounds& bounds = both_restart) {
  return found<Sending, ReceiverRules>(sides, bounds);
}
template <class Receiving>
std::string receiver_fault(const Sides& sides, const Bounds& bounds = both_restart) {
  return found<SenderRules, Receiving>(sides, bounds);
}

TEST(PlantedFault, AnyAcknowledgementEndsTheWait) {
  struct Rules : SenderRules {
    static bool acknowledges(const State& state, Incarnation me, Number /*number*/) {
      return state.peer == me && state.taken.any();
    }
  };
  EXPECT_NE(sender_fault<Rules>(strict_to_strict), "");
}

TEST(PlantedFault, TheSenderIgnoresForWhichOfItsIncarnationsAnAcknowledgementIs) {
  struct Rules : SenderRules {
    static bool acknowledges(const State& state, Incarnation /*me*/, Number number) {
      return state.taken == number && number.any();
    }
  };
  EXPECT_NE(sender_fault<Rules>(strict_to_strict), "");
}

TEST(PlantedFault, DataDoesNotNameTheIncarnationItIsFor) {
  struct Sending : SenderRules {
    static Incarnation target(Incarnation /*peer*/) { return {}; }
  };
  struct Receiving : ReceiverRules {
    static bool is_for(const Data& /*data*/, Incarnation /*me*/) { return true; }
  };
  EXPECT_NE((found<Sending, Receiving>(strict_to_strict, both_restart)), "");
}

TEST(PlantedFault, ARepeatedValueThatWasTakenIsNotAcknowledgedAgain) {
  struct Rules : ReceiverRules {
    static bool answers_repetition() { return false; }
  };
  EXPECT_EQ(receiver_fault<Rules>(strict_to_strict, {.writes = 1}), "a blocking sender waits for ever");
}

TEST(PlantedFault, AValueIsAcknowledgedWhenItArrives) {
  struct Rules : ReceiverRules {
    static bool acknowledges_arrival() { return true; }
  };
  EXPECT_EQ(receiver_fault<Rules>(strict_to_strict), "a blocking send ended, and its value was not read");
}

TEST(PlantedFault, AnyOtherIncarnationOfTheSenderIsTakenForANewerOne) {
  struct Rules : ReceiverRules {
    static bool is_newer(Incarnation from, Incarnation peer) { return from != peer; }
  };
  EXPECT_NE(receiver_fault<Rules>(free_to_strict), "");
}

/// Its repetition stops when the value arrives, not when it is taken.
class EasilyContent : public network::BasicSender<> {
 public:
  using network::BasicSender<>::BasicSender;
  void stop_repeating() { pending_ = false; }
};

TEST(PlantedFault, RepetitionStopsWhenTheValueArrives) {
  Explorer<EasilyContent, network::Receiver> explorer(free_to_strict, {.writes = 1, .receiver_restarts = 1});
  EXPECT_EQ(explorer.run(), "the newest value is never read");
}

TEST(PlantedFault, ANewSenderIsComparedWithTheNumbersOfTheOldOne) {
  struct Rules : ReceiverRules {
    static Number taken_of_new_sender(Number taken) { return taken; }
  };
  EXPECT_NE(receiver_fault<Rules>(strict_to_strict), "");
}

TEST(PlantedFault, NumbersAreNotCompared) {
  struct Rules : ReceiverRules {
    static bool was_taken(Number /*number*/, Number /*taken*/) { return false; }
    static bool is_duplicate(Number /*number*/, Number /*in_slot*/) { return false; }
  };
  EXPECT_NE(receiver_fault<Rules>(free_to_strict), "");
}

TEST(PlantedFault, StatesOfAnOlderIncarnationOfTheReceiverCount) {
  struct Rules : SenderRules {
    static bool counts(const State& /*state*/, Incarnation /*peer*/) { return true; }
    static Incarnation followed(const State& state, Incarnation peer) { return std::max(state.from, peer); }
  };
  EXPECT_NE(sender_fault<Rules>(strict_to_strict), "");
}

TEST(PlantedFault, AnyAcknowledgementEndsTheRepetition) {
  struct Rules : SenderRules {
    static bool ends_repetition(const State& state, Incarnation me, Number /*number*/) {
      return state.peer == me && state.taken.any();
    }
  };
  EXPECT_EQ(sender_fault<Rules>(free_to_strict, {.writes = 2}), "an acknowledged value is read again");
}

TEST(PlantedFault, DataForAnotherIncarnationIsDroppedSilently) {
  struct Rules : ReceiverRules {
    static bool answers_strangers() { return false; }
  };
  EXPECT_EQ(receiver_fault<Rules>(strict_to_strict, {.writes = 1, .sender_restarts = 1}),
            "a blocking sender waits for ever");
}

TEST(PlantedFault, TheSenderFollowsTheReceiverItHeardOfLast) {
  struct Rules : SenderRules {
    static bool counts(const State& /*state*/, Incarnation /*peer*/) { return true; }
  };
  EXPECT_NE(sender_fault<Rules>(strict_to_strict), "");
}

TEST(PlantedFault, ARepeatedValueInTheSlotIsAcknowledged) {
  struct Rules : ReceiverRules {
    static bool acknowledges_duplicates() { return true; }
  };
  EXPECT_EQ(receiver_fault<Rules>(strict_to_strict), "a blocking send ended, and its value was not read");
}

TEST(PlantedFault, ANewReceiverDoesNotSayThatItIsThere) {
  struct Rules : ReceiverRules {
    static bool announces_itself() { return false; }
  };
  EXPECT_EQ(receiver_fault<Rules>(latest, {.writes = 1, .receiver_restarts = 1}),
            "the newest value is never read");
}

}  // namespace
}  // namespace tessera::test
