#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "ros2/actions/goal_life.hpp"
#include "ros2/dds/run_identity.hpp"
#include "ros2/drivers/action_ends.hpp"

namespace tessera::ros2 {

/// Orders one goal at a time of a server, and follows its life (GoalLife).
///
/// Threads: any.
class ActionClient : public Shared<ActionEnds> {
 public:
  explicit ActionClient(const ServiceSetup& setup);

  /// The close of the last driver cancels the goal that is under way, and waits up to half a second for it.
  void close();
  /// Whether a server is found within this time.
  [[nodiscard]] bool await_server(Duration timeout);

  /// Takes the wish of the effector (GoalLife::order). goal: with encapsulation. false: DDS refused.
  [[nodiscard]] bool order(std::uint64_t call, bool cancel, const std::vector<std::byte>& goal);
  /// The beginning of the names of the next goals.
  void use_names(const GoalPrefix& prefix);
  /// From this call on, events are kept for `take_event`.
  void keep_events();
  [[nodiscard]] std::optional<GoalLife::Event> take_event();

  /// For a process that is about to end: cancels all goals with such names that the server still works for.
  /// Whether none is left within this time.
  [[nodiscard]] bool cancel_goals_of(const GoalPrefix& prefix, Duration timeout);

 private:
  /// The goals of sent requests, by the numbers of these.
  class Sent {
   public:
    void add(std::int64_t number, const GoalId& id);
    [[nodiscard]] std::optional<GoalId> find(std::int64_t number) const;

   private:
    std::deque<std::pair<std::int64_t, GoalId>> all_;
  };

  void progress();
  void look_for_servers(GoalLife::Instant now);
  void hear(GoalLife::Instant now);
  void hear_topics(GoalLife::Instant now);
  template <class Hear>
  void hear_replies(ServiceEnds& service, const Sent& sent, Hear hear);
  void act();
  void tell_of_losses();

  GoalPrefix prefix_{};
  GoalLife life_;
  GoalLife::Counts told_;
  Sent goals_, results_, cancels_;
  bool keeps_events_ = false, refused_ = false, probes_ = false;
  std::size_t ready_ = 0;
  GoalLife::Instant next_look_{};
  std::uint64_t foreign_ = 0, several_ = 0, strange_ = 0, malformed_ = 0;
};

}  // namespace tessera::ros2
