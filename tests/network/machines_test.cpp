#include <gtest/gtest.h>

#include <type_traits>
#include <vector>

#include "network/receiver.hpp"
#include "network/repetition.hpp"
#include "network/sender.hpp"

namespace tessera::network {
namespace {

using std::chrono::milliseconds;

TEST(Sender, WaitsUntilTheValueWasTaken) {
  Sender sender(Sending::blocking, {5});
  EXPECT_EQ(sender.write().send, (Data{{5}, {0}, {1}, false}));
  EXPECT_TRUE(sender.waiting());
  EXPECT_FALSE(sender.hear({{9}, {0}, {0}}).taken);
  EXPECT_EQ(sender.repeat().send, (Data{{5}, {9}, {1}, false}));
  EXPECT_TRUE(sender.hear({{9}, {5}, {1}}).taken);
  EXPECT_FALSE(sender.waiting());
  EXPECT_FALSE(sender.repeats());
}

TEST(Sender, CallsBackWhatItGaveUp) {
  Sender sender(Sending::blocking, {5});
  static_cast<void>(sender.write());
  EXPECT_EQ(sender.time_is_up().send, std::nullopt) << "no receiver is known that could have it";
  EXPECT_EQ(sender.repeat().send, std::nullopt);
  static_cast<void>(sender.hear({{9}, {0}, {0}}));
  EXPECT_EQ(sender.repeat().send, (Data{{5}, {9}, {1}, true}));
  EXPECT_EQ(sender.write().send, (Data{{5}, {9}, {2}, false})) << "a new value needs no recall of the old";
}

TEST(Sender, TellsThatItsClockWasSetBack) {
  Sender sender(Sending::non_blocking, {5});
  static_cast<void>(sender.write());
  EXPECT_TRUE(sender.hear({{9}, {6}, {3}}).superseded);
  EXPECT_FALSE(sender.hear({{9}, {5}, {0}}).superseded);
}

TEST(Receiver, DoesNotTouchTheSlotWhileItIsRead) {
  Receiver receiver(Receiving::once, {9});
  EXPECT_TRUE(receiver.hear({{5}, {9}, {1}, false}).keep);
  receiver.begin_read();
  EXPECT_TRUE(receiver.hear({{5}, {9}, {2}, false}).later);
  EXPECT_TRUE(receiver.hear({{5}, {9}, {1}, true}).later);
  EXPECT_EQ(receiver.end_read().answer, (State{{9}, {5}, {1}}));
  EXPECT_FALSE(receiver.full());
  EXPECT_TRUE(receiver.hear({{5}, {9}, {2}, false}).keep);
}

TEST(Receiver, DropsWhatNoSenderSends) {
  Receiver receiver(Receiving::once, {9});
  EXPECT_TRUE(receiver.hear({{0}, {9}, {1}, false}).malformed);
  EXPECT_TRUE(receiver.hear({{5}, {9}, {0}, false}).malformed);
  EXPECT_TRUE(receiver.hear({{5}, {9}, {0}, true}).malformed);
  EXPECT_EQ(receiver, Receiver(Receiving::once, {9}));
}

TEST(Receiver, EmptiesItsSlotWhenTheValueIsCalledBack) {
  Receiver receiver(Receiving::once, {9});
  EXPECT_TRUE(receiver.hear({{5}, {9}, {1}, false}).keep);
  EXPECT_FALSE(receiver.hear({{5}, {9}, {1}, true}).keep);
  EXPECT_FALSE(receiver.full());
  EXPECT_FALSE(receiver.hear({{5}, {9}, {1}, false}).keep) << "a late copy of it";
}

TEST(Repetition, ComesLessAndLessOften) {
  Repetition repetition;
  EXPECT_EQ(repetition.interval(), std::nullopt);
  repetition.start(false);
  std::vector<long> intervals;
  for (int time = 0; time < 7; ++time) {
    intervals.push_back(std::chrono::duration_cast<milliseconds>(repetition.interval().value()).count());
    repetition.again();
  }
  EXPECT_EQ(intervals, (std::vector<long>{20, 40, 80, 160, 320, 500, 500}));
  repetition.stop();
  EXPECT_EQ(repetition.interval(), std::nullopt);
}

TEST(Repetition, SendsARecallThreeTimesInAll) {
  Repetition repetition;
  repetition.start(true);
  int sent = 1;
  for (; repetition.interval(); repetition.again()) {
    EXPECT_EQ(repetition.interval(), milliseconds(20));
    ++sent;
  }
  EXPECT_EQ(sent, 3);
}

// A type that is copied as bytes and has no pointer cannot allocate.
static_assert(std::is_trivially_copyable_v<Sender> && std::is_trivially_copyable_v<Receiver>);
static_assert(std::is_trivially_copyable_v<Sender::Effects> &&
              std::is_trivially_copyable_v<Receiver::Effects>);

}  // namespace
}  // namespace tessera::network
