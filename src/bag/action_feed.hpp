#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "bag/feed.hpp"
#include "ros2/actions/goal_life.hpp"
#include "ros2/actions/messages.hpp"
#include "ros2/codec/translator.hpp"
#include "ros2/naming/names.hpp"

namespace tessera::bag {

/// The progress of the goals of an action, out of its topics `status` and `feedback`. The first goal in the bag that
/// has not ended before it begins is call 1, the next one call 2. A bag has no results, whose fields are zero, and
/// no goals that were rejected.
class ActionFeed final : public Feed {
 public:
  /// wanted lives longer. nullptr and `error`: its definition and its buffer do not fit.
  [[nodiscard]] static std::unique_ptr<ActionFeed> make(const WantedInput& wanted, std::string& error);

  [[nodiscard]] bool reads(const std::string& topic) const override {
    return topic == names_.status || topic == names_.feedback;
  }
  [[nodiscard]] std::string take(const mcap::ReadMessage& one, const Give& give) override;
  void finish(const Give& give) override;
  [[nodiscard]] std::vector<std::string> notes() const override;

 private:
  struct Heard {
    std::uint64_t log_ns = 0;
    bool is_status = false;
    ros2::MessageBytes bytes;
  };
  ActionFeed(const WantedInput& wanted, std::shared_ptr<const ros2::Structure> progress);
  [[nodiscard]] bool use(std::shared_ptr<const ros2::Structure> progress, std::string& error);
  void use_definition(const mcap::Schema& schema);
  void hear_status(const ros2::MessageBytes& message, const std::function<void()>& tell);
  void hear_feedback(const ros2::MessageBytes& message, const std::function<void()>& tell);
  void begin(const ros2::GoalId& id, const std::function<void()>& tell);
  void give_events(std::uint64_t log_ns, const Give& give);

  const WantedInput& wanted_;
  ros2::ActionNames names_;
  std::shared_ptr<const ros2::Structure> progress_;
  std::optional<ros2::Translator> translator_;
  std::vector<Heard> heard_;
  bool has_definition_ = false;
  MessageCount status_, feedback_;

  // The goals.
  std::uint64_t goals_ = 0;
  ros2::GoalId id_{};  ///< of the newest
  std::set<ros2::GoalId> known_;
  GoalState last_ = GoalState::none;  ///< that was given of the newest
  bool is_first_ = true;              ///< no status was heard yet
  ros2::GoalLife life_;
};

}  // namespace tessera::bag
