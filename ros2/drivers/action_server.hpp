#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "ros2/actions/served_goals.hpp"
#include "ros2/drivers/action_ends.hpp"

namespace tessera::ros2 {

/// Serves the goals of any number of clients (ServedGoals).
///
/// Threads: any.
class ActionServer : public Shared<ActionEnds> {
 public:
  explicit ActionServer(const ServiceSetup& setup) : Shared(setup, std::chrono::seconds(10)) {}

  /// The close of the last driver aborts the goals that are under way, and waits up to half a second until the
  /// clients have received that.
  void close();
  void refuse_cancels();
  void use_empty_result(MessageBytes result);
  /// The next goal, or one that is to be cancelled.
  [[nodiscard]] std::optional<ServedGoals::Event> next_event();
  /// The goal does not have the type of the action: it is rejected.
  void refuse(std::uint64_t number);
  /// Takes the word of the effector (ServedGoals::say). false: DDS refused.
  [[nodiscard]] bool say(std::uint64_t number, GoalState state, const MessageBytes& feedback,
                         const MessageBytes& result);

 private:
  using Instant = ServedGoals::Instant;
  enum class Part : std::uint8_t { goal, result, cancel };
  /// The origin of a question.
  struct Asked {
    Part part{};
    ServiceEnds::Asker asker{};
  };
  struct Answer {
    Asked to{};
    MessageBytes message{};
    Instant until{};
  };
  ServiceEnds& service(Part part);
  void progress();
  void take_questions(Instant now);
  template <class Take>
  void take_from(Part part, Take take);
  void act(Instant now);
  void send_answers(Instant now);
  void tell_of_losses();

  ServedGoals goals_;
  ServedGoals::Counts told_;
  std::map<ServedGoals::Question, Asked> asked_;
  ServedGoals::Question newest_ = 0;
  std::deque<Answer> answers_;
  bool refused_ = false;
  std::uint64_t foreign_ = 0, malformed_ = 0, unheard_ = 0, several_ = 0, crowded_ = 0;
};

}  // namespace tessera::ros2
