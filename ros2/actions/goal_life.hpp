#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "ros2/actions/goal.hpp"

namespace tessera::ros2 {

/// The goals of a client of an action, one after the other. Answers, results, states and feedback come on
/// different topics in any order; this makes one life of them, in which no state follows that may not follow
/// (`may_follow`). Whatever does not belong into it is dropped and counted.
///
/// It sends and receives nothing itself: `take_deeds` says what is to be sent.
///
/// Threads: one at a time.
class GoalLife {
 public:
  using Instant = std::chrono::steady_clock::time_point;
  using Bytes = std::vector<std::byte>;

  struct Times {
    /// For each stage: until the server is there and has answered a goal, until it has answered a cancel, until
    /// the result comes after its state, until a server that gives no sign of life has gone.
    std::chrono::nanoseconds timeout = std::chrono::seconds(2);
    /// Between questions for a sign of life.
    [[nodiscard]] std::chrono::nanoseconds between_probes() const { return timeout / 5; }
    [[nodiscard]] std::chrono::nanoseconds longest_silence() const { return timeout * 3 / 4; }
  };
  /// new_id: a name that no other goal has.
  explicit GoalLife(std::function<GoalId()> new_id) : new_id_(std::move(new_id)) {}
  void use(const Times& times) { times_ = times; }

  /// Takes the wish of the effector. A call that is not 0 and not that of the last goal orders a goal; the goal before it
  /// is cancelled and given up. The same call changes nothing, unless it asks to cancel. 0: no goal is wanted,
  /// so one that is under way is cancelled.
  void order(std::uint64_t call, bool cancel, std::span<const std::byte> goal, Instant now);

  // The messages of the server. `id` and `message` may be anything.
  /// is_there: a server can take goals.
  void hear_of_server(bool is_there, Instant now);
  void hear_sign_of_life() { probed_at_.reset(); }
  void hear_answer(const GoalId& id, bool accepted, Instant now);
  /// The result's message, as it came; status: none if it cannot be read.
  void hear_result(const GoalId& id, std::optional<std::int8_t> status, Bytes message, Instant now);
  void hear_status(const GoalId& id, std::int8_t status, Instant now);
  void hear_feedback(const GoalId& id, Bytes message);
  void hear_of_cancel(const GoalId& id, CancelCode code, Instant now);
  /// Lets the time go on.
  void tick(Instant now);

  struct Deed {
    enum class Kind : std::uint8_t {
      send_goal,
      ask_result,
      cancel,
      probe  ///< something that every server answers
    } kind{};
    GoalId id{};
    Bytes goal{};
  };
  /// Gives the messages to send since the last call, in order.
  [[nodiscard]] std::vector<Deed> take_deeds();

  /// A change of the state, or feedback.
  struct Event {
    std::uint64_t call = 0;
    GoalState state = GoalState::none;
    Bytes feedback{}, result{};  ///< messages; empty: there is none
  };
  /// The next one for the receptor, which gets all states of the newest goal; of feedback, the newest.
  [[nodiscard]] std::optional<Event> take_event();

  [[nodiscard]] GoalState state() const { return state_; }
  /// Whether a goal is not over, or was given up and may still be at work.
  [[nodiscard]] bool is_busy() const;

  /// The numbers of messages that were dropped, and of what went wrong.
  struct Counts {
    std::uint64_t disorder = 0;         ///< results before acceptance, second results, second answers ...
    std::uint64_t given_up = 0;         ///< words about goals that were given up
    std::uint64_t unknown = 0;          ///< words about goals of others
    std::uint64_t late_acceptance = 0;  ///< goals that are cancelled since they were accepted too late
    std::uint64_t repeated = 0;  ///< goals that are cancelled since they were accepted again after their end
    std::uint64_t unserved = 0;  ///< goals that were not sent: no server was there
    std::uint64_t unanswered = 0;   ///< goals and cancels without an answer
    std::uint64_t lost = 0;         ///< goals whose server vanished
    std::uint64_t uncancelled = 0;  ///< cancels that the server refused
    std::uint64_t unreadable = 0;   ///< results without a state that an end can have
  };
  [[nodiscard]] const Counts& counts() const { return counts_; }

 private:
  /// A goal that is no longer wanted. It is cancelled whenever the server says that it works for it.
  struct Former {
    GoalId id{};
    bool cancelled = false;
  };
  void change(GoalState state, Bytes result = {});
  void begin(std::uint64_t call, std::span<const std::byte> goal, Instant now);
  void give_up(bool cancelled);
  void lose();
  void ask_to_cancel(Instant now);
  void cancel(Former& former);
  Former* former(const GoalId& id);
  void apply_status(std::int8_t status, Instant now);
  void do_it(Deed::Kind kind, const GoalId& id, Bytes goal = {}) {
    deeds_.push_back({kind, id, std::move(goal)});
  }

  std::function<GoalId()> new_id_;
  Times times_;
  Counts counts_;
  std::vector<Deed> deeds_;
  std::deque<Event> events_;
  std::deque<Former> formers_;

  // The newest goal.
  std::uint64_t call_ = 0;
  GoalId id_{};
  GoalState state_ = GoalState::none;
  Bytes goal_, feedback_;
  bool is_sent_ = false, wants_cancel_ = false, has_cancelled_ = false;
  std::int8_t early_status_ = 0;  ///< that came before the acceptance
  std::optional<Instant> answer_until_, cancel_until_, result_until_;
  bool is_there_ = false;
  std::optional<Instant> probed_at_;
  Instant next_probe_{};
};

}  // namespace tessera::ros2
