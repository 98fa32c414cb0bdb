#include "bag/action_feed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "bag/buffer_channel.hpp"
#include "ros2/codec/written_mapping.hpp"
#include "ros2/definitions/resolver.hpp"

namespace tessera::bag {
namespace {

/// The time of a life that is over: nobody waits in it.
constexpr ros2::GoalLife::Instant no_time{};

std::shared_ptr<const ros2::Structure> resolved(const std::string& type, const std::string& definition,
                                                std::string& error) {
  std::vector<ros2::Mistake> mistakes;
  auto message = ros2::resolve(type, ros2::DefinitionBundle(type, definition), mistakes);
  if (message == nullptr) error = mistakes.empty() ? "no definition of " + type : mistakes.front().shown();
  return message;
}

}  // namespace

ActionFeed::ActionFeed(const WantedInput& wanted, std::shared_ptr<const ros2::Structure> progress)
    : wanted_(wanted),
      names_(ros2::names_of_action(wanted.ros.topic, wanted.ros.type)),
      progress_(std::move(progress)),
      life_([this] { return id_; }) {}

std::unique_ptr<ActionFeed> ActionFeed::make(const WantedInput& wanted, std::string& error) {
  std::string why;
  auto progress = resolved(ros2::progress_type(wanted.ros.type), wanted.ros.definition, why);
  std::unique_ptr<ActionFeed> feed;
  if (progress) feed.reset(new ActionFeed(wanted, progress));
  if (feed && feed->use(std::move(progress), why)) return feed;
  error = fmt::format("cannot be read for {}: {}", wanted.ros.path, why);
  return nullptr;
}

bool ActionFeed::use(std::shared_ptr<const ros2::Structure> progress, std::string& error) {
  const auto value = ros2::parse_value_type(wanted_.type);
  if (!value) return error = "its type is none of a message", false;
  const ros2::Mapping mapping = ros2::mapping_of_action(
      ros2::written_mapping(wanted_.ros.fields, wanted_.ros.names, wanted_.ros.frame_id), /*is_goal=*/false,
      ros2::Direction::receive);
  std::vector<ros2::MappingProblem> problems;
  auto translator = ros2::Translator::make(progress, *value, mapping, ros2::Direction::receive, problems);
  if (!translator) return error = problems.empty() ? "it does not correspond" : problems.front().text, false;
  translator_ = std::move(translator);
  progress_ = std::move(progress);
  return true;
}

/// The feedback of the distribution that has written the bag may have other fields than that of the driver.
void ActionFeed::use_definition(const mcap::Schema& schema) {
  if (std::exchange(has_definition_, true) || schema.encoding != "ros2msg" || schema.data.empty()) return;
  std::string ignored;
  const auto message = resolved(names_.feedback_type, schema.data, ignored);
  if (message == nullptr || message->fields.size() != 2 || message->fields[1].type.structure == nullptr)
    return;
  ros2::Structure progress = *progress_;
  progress.fields[0].type.structure = message->fields[1].type.structure;
  static_cast<void>(use(std::make_shared<const ros2::Structure>(std::move(progress)), ignored));
}

std::string ActionFeed::take(const mcap::ReadMessage& one, const Give&) {
  const bool is_status = one.channel.topic == names_.status;
  const std::string& type = is_status ? names_.status_type : names_.feedback_type;
  if (std::string problem = wrong_type(one, type, wanted_.ros.path); !problem.empty()) return problem;
  if (!is_status) use_definition(*one.schema);
  ++(is_status ? status_ : feedback_).messages;
  const auto bytes = std::as_bytes(std::span(one.message.data));
  heard_.push_back({one.message.log_ns, is_status, {bytes.begin(), bytes.end()}});
  return {};
}

/// Both topics together, in the order of their times.
void ActionFeed::finish(const Give& give) {
  std::ranges::stable_sort(heard_, {}, &Heard::log_ns);
  for (const Heard& one : heard_) {
    const auto tell = [&] { give_events(one.log_ns, give); };
    if (one.is_status)
      hear_status(one.bytes, tell);
    else
      hear_feedback(one.bytes, tell);
    tell();
  }
}

/// tell: gives the events of the goal before it, which are forgotten now.
void ActionFeed::begin(const ros2::GoalId& id, const std::function<void()>& tell) {
  tell();
  id_ = id;
  last_ = GoalState::none;
  life_.order(++goals_, /*cancel=*/false, {}, no_time);
  life_.hear_of_server(true, no_time);
  static_cast<void>(life_.take_deeds());
  life_.hear_answer(id, /*accepted=*/true, no_time);
}

void ActionFeed::hear_status(const ros2::MessageBytes& message, const std::function<void()>& tell) {
  const auto goals = ros2::read_status(message);
  if (!goals) {
    ++status_.misfits;
    return;
  }
  for (const ros2::GoalStatus& one : *goals) {
    const auto state = static_cast<GoalState>(one.status);
    if (state < GoalState::accepted || state > GoalState::aborted) continue;
    if (known_.insert(one.info.id).second && !(is_first_ && is_end(state))) begin(one.info.id, tell);
    if (goals_ == 0 || one.info.id != id_) continue;
    life_.hear_status(id_, one.status, no_time);
    if (is_end(state) && !is_end(life_.state()))
      life_.hear_result(id_, one.status, ros2::ProgressType(progress_).empty_result(one.status), no_time);
  }
  is_first_ = false;
}

/// Feedback may overtake the state.
void ActionFeed::hear_feedback(const ros2::MessageBytes& message, const std::function<void()>& tell) {
  auto named = ros2::split_goal_id(message);
  if (!named) {
    ++feedback_.misfits;
    return;
  }
  if (known_.insert(named->id).second) begin(named->id, tell);
  life_.hear_feedback(named->id, std::move(named->message));
}

void ActionFeed::give_events(std::uint64_t log_ns, const Give& give) {
  const ros2::ProgressType type(progress_);
  while (auto event = life_.take_event()) {
    if (event->state == GoalState::ordered) continue;
    std::vector<std::byte> value;
    const std::array<std::uint64_t, 2> own{event->call, static_cast<std::uint64_t>(event->state)};
    const auto joined = type.join(event->feedback, event->result);
    const bool is_new_state = std::exchange(last_, event->state) != event->state;
    if (!joined || translator_->decode(*joined, value, own) != ros2::Translator::Outcome::good) {
      ++feedback_.misfits;
      if (!is_new_state) continue;
      value = translator_->empty_value(own);
    }
    give({log_ns, value, is_new_state});
  }
}

std::vector<std::string> ActionFeed::notes() const {
  std::vector<std::string> notes;
  if (const auto note = status_.note(names_.status, wanted_.ros.path)) notes.push_back(*note);
  if (feedback_.messages > 0)
    if (const auto note = feedback_.note(names_.feedback, wanted_.ros.path)) notes.push_back(*note);
  if (goals_ > 0)
    notes.push_back(fmt::format(
        "{} takes the {} goals of {} for its calls 1 to {}; results and rejections are in no topic",
        wanted_.ros.path, goals_, wanted_.ros.topic, goals_));
  return notes;
}

}  // namespace tessera::bag
