#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "ros2/actions/goal.hpp"
#include "ros2/actions/messages.hpp"

namespace tessera::ros2 {

/// The goals of a server of an action: those that wait for a decision, those that it works for, and those that
/// have ended and whose results may be asked for. It gives the receptor one undecided goal after the other, and
/// any number of goals may be under way.
///
/// It sends and receives nothing itself: `take_deeds` says what is to be sent.
///
/// Threads: one at a time.
class ServedGoals {
 public:
  using Instant = std::chrono::steady_clock::time_point;
  static constexpr std::size_t most_open = 16;   ///< undecided or under way; more are rejected
  static constexpr std::size_t most_ended = 64;  ///< whose results are kept
  static constexpr std::chrono::minutes keeps_results{15};

  /// Names a question of a client, for its answer.
  using Question = std::uint64_t;

  /// How long a goal may wait for a decision before it is rejected.
  void use_timeout(std::chrono::nanoseconds timeout) { timeout_ = timeout; }
  /// The control does not learn of cancels, which are refused then.
  void refuse_cancels() { takes_cancels_ = false; }
  /// A result of zeros, for goals without one of their own; its state is set here.
  void use_empty_result(MessageBytes result) { empty_result_ = std::move(result); }

  // The questions of clients.
  void hear_goal(Question question, const GoalId& id, MessageBytes goal, Stamp at, Instant now);
  void hear_result_question(Question question, const GoalId& id);
  void hear_cancel(Question question, const CancelRequest& request);
  /// Lets the time go on.
  void tick(Stamp at, Instant now);

  /// Takes the word of the effector about the goal of that number. 0 says nothing. The same may be said several times.
  ///
  /// state: 1 or 2 accepts, 7 rejects, 4, 5 and 6 end. feedback, result: as ProgressType::split makes them.
  void say(std::uint64_t number, GoalState state, const MessageBytes& feedback, const MessageBytes& result,
           Stamp at, Instant now);
  /// The goal does not have the type of the action: it is rejected.
  void refuse(std::uint64_t number, Stamp at);
  /// The server ends: what waits is rejected, and what is under way is aborted.
  void end_all(Stamp at, Instant now);

  /// A new goal, or one that is to be cancelled.
  struct Event {
    std::uint64_t number = 0;  ///< 1, 2, 3 ...
    bool cancel = false;
    MessageBytes goal{};
  };
  /// The next one for the receptor; nullopt: there is none, or a goal waits for a decision.
  [[nodiscard]] std::optional<Event> take_event();

  struct Deed {
    enum class Kind : std::uint8_t { answer_goal, answer_result, answer_cancel, feedback, status } kind{};
    Question question = 0;  ///< for answers
    MessageBytes message{};
  };
  /// Gives the messages to send since the last call, in order.
  [[nodiscard]] std::vector<Deed> take_deeds();

  /// The numbers of what was dropped or refused.
  struct Counts {
    std::uint64_t crowded = 0;    ///< goals that were rejected, because too many are open
    std::uint64_t undecided = 0;  ///< goals that were rejected, because nobody decided in time
    std::uint64_t repeated = 0;   ///< goals with the name of another
    std::uint64_t useless = 0;    ///< words of the effector about goals that are over, or that do not exist
    std::uint64_t uncancelled =
        0;                    ///< goals that ended as cancelled, though nobody had asked: they are aborted
    std::uint64_t unfit = 0;  ///< goals that do not fit the buffer
  };
  [[nodiscard]] const Counts& counts() const { return counts_; }

 private:
  struct Goal {
    std::uint64_t number = 0;  ///< 0: it was not given yet
    GoalInfo info{};
    GoalState state = GoalState::none;  ///< none: undecided
    bool cancel_is_told = true;
    Question question = 0;
    MessageBytes message{}, feedback{}, result{};
    std::vector<Question> result_questions{};
    Instant until{};  ///< undecided: of the decision; ended: of its result
  };
  Goal* find(const GoalId& id);
  Goal* find(std::uint64_t number);
  void answer(Goal& goal, bool accepted, Stamp at);
  void reject(Goal& goal, Stamp at);
  void accept(Goal& goal, Stamp at);
  void end(Goal& goal, GoalState state, MessageBytes result, Instant now);
  void forget(Instant now);
  [[nodiscard]] MessageBytes empty_result(GoalState state) const;
  void tell_states();
  [[nodiscard]] static bool is_selected(const Goal& goal, const CancelRequest& request);

  std::chrono::nanoseconds timeout_ = std::chrono::seconds(10);
  bool takes_cancels_ = true;
  MessageBytes empty_result_;
  std::deque<Goal> goals_;  ///< in the order of their arrival
  std::uint64_t newest_ = 0;
  std::vector<Deed> deeds_;
  Counts counts_;
};

}  // namespace tessera::ros2
