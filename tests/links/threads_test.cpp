// The two ends of a channel with the threads of a run: two that fire, two that serve, and a bad network between.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <random>
#include <thread>
#include <vector>

#include "links/links.hpp"
#include "links_nets.hpp"
#include "system/clock.hpp"

namespace tessera::testing {
namespace {

using namespace std::chrono_literals;

/// Messages of both directions. It loses, repeats and swaps some.
class Hub {
 public:
  struct Message {
    bool is_state = false;
    network::Data data{};
    network::State state{};
    std::vector<std::byte> bytes{};
  };
  class Socket final : public network::Carrier {
   public:
    Socket(Hub& hub, std::size_t own) : hub_(hub), own_(own) {}
    void send(network::ChannelNumber, const network::Data& data, const network::Value& value) override {
      hub_.put(1 - own_, {.data = data, .bytes = {value.bytes.begin(), value.bytes.end()}});
    }
    void send(network::ChannelNumber, const network::State& state) override {
      hub_.put(1 - own_, {.is_state = true, .state = state});
    }
    void receive(Listener& listener, std::chrono::nanoseconds longest) override {
      std::unique_lock lock(hub_.mutex_);
      hub_.news_.wait_for(lock, std::min<std::chrono::nanoseconds>(longest, 5ms),
                          [&] { return woken_ || !hub_.boxes_[own_].empty(); });
      woken_ = false;
      const std::deque<Message> messages = std::exchange(hub_.boxes_[own_], {});
      lock.unlock();
      for (const Message& message : messages)
        if (message.is_state)
          listener.heard(0, message.state);
        else
          listener.heard(0, message.data, {0ns, true, message.bytes});
    }
    void wake() override {
      const std::lock_guard lock(hub_.mutex_);
      woken_ = true;
      hub_.news_.notify_all();
    }

   private:
    Hub& hub_;
    std::size_t own_;
    bool woken_ = false;
  };
  Socket sockets[2]{{*this, 0}, {*this, 1}};

 private:
  void put(std::size_t to, Message message) {
    const std::lock_guard lock(mutex_);
    const auto draw = random_() % 10;
    if (draw == 0) return;
    if (draw == 1) boxes_[to].push_back(message);
    if (draw == 2 && !boxes_[to].empty())
      boxes_[to].push_front(std::move(message));
    else
      boxes_[to].push_back(std::move(message));
    news_.notify_all();
  }
  std::mutex mutex_;
  std::condition_variable news_;
  std::deque<Message> boxes_[2];
  std::mt19937_64 random_{1};
};

constexpr std::uint16_t idle = 1, sent = 2, more = 4, empty = 8, full = 16;

LinkedChannel channel(bool blocks) {
  LinkedChannel made;
  made.name = "a.x->b.x";
  made.receiver = 1;
  made.sender_blocks = blocks;
  made.idle = idle;
  made.sent = sent;
  made.more = more;
  made.empty = empty;
  made.full = full;
  return made;
}

/// Both ends of one channel, each served by a thread of its own.
struct Ends {
  explicit Ends(bool blocks)
      : sender_word(idle | empty, sizeof(std::uint64_t)),
        receiver_word(empty, sizeof(std::uint64_t)),
        here(clock, 1, [](std::string_view text, bool) { FAIL() << text; }),
        there(clock, 1, [](std::string_view text, bool) { FAIL() << text; }),
        sending(here.add_sender(channel(blocks), sender_word, *value_encoding_of<std::uint64_t>(), {5})),
        receiving(there.add_receiver(channel(blocks), receiver_word, *value_encoding_of<std::uint64_t>(),
                                     sizeof(std::uint64_t), nullptr, {9})) {
    here.connect(hub.sockets[0]);
    there.connect(hub.sockets[1]);
    for (Links* const links : {&here, &there})
      threads.emplace_back([this, links] {
        while (!over.load()) links->serve(clock.now() + 5ms);
      });
  }
  ~Ends() {
    over = true;
    for (std::thread& thread : threads) thread.join();
  }

  /// Fires t2, t2n or t2m, whichever is enabled.
  void send(std::uint64_t value) {
    sending.write(&value, clock.now(), true);
    for (;;)
      for (const std::uint16_t before : {idle, sent, more}) {
        const std::uint16_t after = before == idle ? sent : more;
        if (sender_word.fire(Side::send, before, after) == 0) continue;
        static_cast<void>(sending.fired({before, after, false}, clock.now(), nullptr));
        return;
      }
  }
  /// t3.
  [[nodiscard]] bool acknowledged() {
    constexpr std::uint16_t taken = idle | empty;
    if (sender_word.fire(Side::send, taken, taken) == 0) return false;
    static_cast<void>(sending.fired({taken, taken, false}, clock.now(), nullptr));
    return true;
  }
  void give_up() {
    static_cast<void>(sender_word.fire(Side::send, 0, 0));
    static_cast<void>(sending.fired({0, 0, true}, clock.now(), nullptr));
  }
  /// t1, the read, and t2; nullopt: the slot is empty.
  [[nodiscard]] std::optional<std::uint64_t> read() {
    if (receiver_word.fire(Side::receive, full, 0) == 0) return std::nullopt;
    static_cast<void>(receiving.fired({full, 0, false}, clock.now(), nullptr));
    std::uint64_t value = 0;
    std::memcpy(&value, receiver_word.memory().bytes.data(), sizeof value);
    static_cast<void>(receiver_word.fire(Side::receive, 0, empty));
    static_cast<void>(receiving.fired({0, empty, false}, clock.now(), nullptr));
    return value;
  }

  SteadyClock clock;
  Hub hub;
  SharedChannel sender_word, receiver_word;
  Links here, there;
  SendingEnd& sending;
  ReceivingEnd& receiving;
  std::atomic<bool> over{false};
  std::vector<std::thread> threads;
};

TEST(Threads, ASendEndsOnlyWhenItsValueWasTaken) {
  constexpr std::uint64_t most = 400;
  Ends ends(true);
  std::atomic<std::uint64_t> last{0};
  std::thread reader([&] {
    while (last.load() < most)
      if (const auto value = ends.read()) {
        EXPECT_EQ(*value, last.load() + 1) << "a value twice, or left out";
        last = *value;
      } else {
        std::this_thread::yield();
      }
  });
  for (std::uint64_t value = 1; value <= most; ++value) {
    ends.send(value);
    while (!ends.acknowledged()) std::this_thread::yield();
    ASSERT_GE(last.load() + 1, value) << "the end of its read may not have been seen yet, but no more";
  }
  reader.join();
}

/// The send is given up at the very time when the acknowledgement comes.
TEST(Threads, AnAcknowledgementNeverEndsALaterSend) {
  constexpr std::uint64_t most = 1'500;
  Ends ends(true);
  std::atomic<bool> over{false};
  std::vector<std::uint64_t> read;
  std::thread reader([&] {
    while (!over.load())
      if (const auto value = ends.read())
        read.push_back(*value);
      else
        std::this_thread::yield();
  });
  std::vector<std::uint64_t> taken;
  std::mt19937_64 random(3);
  for (std::uint64_t value = 1; value <= most; ++value) {
    ends.send(value);
    const Time until = ends.clock.now() + std::chrono::microseconds(random() % 400);
    bool acknowledged = false;
    while (!(acknowledged = ends.acknowledged()) && ends.clock.now() < until) std::this_thread::yield();
    if (acknowledged)
      taken.push_back(value);
    else
      ends.give_up();
  }
  over = true;
  reader.join();
  EXPECT_EQ(std::ranges::adjacent_find(read, [](auto a, auto b) { return a >= b; }), read.end());
  for (const std::uint64_t value : taken) ASSERT_TRUE(std::ranges::binary_search(read, value)) << value;
  EXPECT_FALSE(taken.empty());
  EXPECT_LT(taken.size(), most);
}

}  // namespace
}  // namespace tessera::testing
