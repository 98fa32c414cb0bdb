#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ros2/actions/goal_life.hpp"
#include "ros2/actions/messages.hpp"
#include "ros2/actions/served_goals.hpp"
#include "ros2/codec/translator.hpp"
#include "ros2/codec/value_type.hpp"
#include "ros2/codec/written_mapping.hpp"
#include "ros2/definitions/resolver.hpp"
#include "ros2/parameters/node_parameters.hpp"

/// Whatever comes on the topics of an action and on the services of parameters, in any order: no harm is done, a goal
/// has one life, and what was read is written as it was.
namespace {

using namespace tessera;
using namespace tessera::ros2;
using Bytes = std::vector<std::byte>;
using Instant = GoalLife::Instant;

void require(bool holds) {
  if (!holds) std::abort();
}

class Script {
 public:
  explicit Script(std::span<const std::byte> bytes) : bytes_(bytes) {}
  [[nodiscard]] bool any() const { return !bytes_.empty(); }
  std::uint8_t take() {
    if (bytes_.empty()) return 0;
    const auto one = static_cast<std::uint8_t>(bytes_.front());
    bytes_ = bytes_.subspan(1);
    return one;
  }
  Bytes take_some() {
    const std::size_t count = std::min<std::size_t>(take(), bytes_.size());
    const Bytes some(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(count));
    bytes_ = bytes_.subspan(count);
    return some;
  }

 private:
  std::span<const std::byte> bytes_;
};

/// Few names, so that they meet again.
GoalId name_of(std::uint8_t number) {
  GoalId id{};
  id[0] = static_cast<std::byte>(number % 12);
  return id;
}

constexpr const char* progress_text = R"(Feedback feedback
Result result
================================================================================
MSG: fuzz/Feedback
string[] joint_names
float64[] actual
Step[] steps
================================================================================
MSG: fuzz/Step
int8 a
float64[] values
string[<=2] words
================================================================================
MSG: fuzz/Result
int32 code
string text
)";
constexpr const char* progress_value =
    "{call: uint32, state: uint8, actual: float64[<=2], text: string(8), code: int32, steps: {a: int8, "
    "values: "
    "float64[<=3], words: string(4)[<=2]}[<=3]}";
constexpr const char* progress_fields =
    "feedback.actual=actual, feedback.steps=steps, result.text=text, result.code=code";

std::shared_ptr<const Structure> progress_message() {
  static const auto message = [] {
    std::vector<Mistake> mistakes;
    auto made = resolve("fuzz/msg/Progress", DefinitionBundle("fuzz/msg/Progress", progress_text), mistakes);
    require(made != nullptr);
    return made;
  }();
  return message;
}

Translator plan_of(const std::string& names, Direction direction) {
  std::vector<MappingProblem> problems;
  auto made = Translator::make(
      progress_message(), *parse_value_type(progress_value),
      mapping_of_action(written_mapping(progress_fields, names, ""), /*is_goal=*/false, direction), direction,
      problems);
  require(made.has_value());
  return *made;
}

/// A progress message that is accepted gives a value of the buffer, which can be sent and comes back.
void try_progress(std::span<const std::byte> bytes) {
  static const Translator by_name = plan_of("left, right", Direction::receive);
  static const Translator plain = plan_of("", Direction::receive), sends = plan_of("", Direction::send);
  const std::array<std::uint64_t, 2> own{7, 2};
  Bytes value, message, again;
  if (by_name.decode(bytes, value, own) == Translator::Outcome::good)
    require(sends.encode(value, {}, message));
  if (plain.decode(bytes, value, own) != Translator::Outcome::good) return;
  require(plain.own_number(value, call_field) == 7 && sends.encode(value, {}, message));
  require(plain.decode(message, again, own) == Translator::Outcome::good && again == value);
  const ProgressType type(progress_message());
  const auto parts = type.split(message, 4);
  require(parts && read_result_status(parts->result) == 4);
  const auto joined = type.join(parts->feedback, parts->result);
  require(joined && plain.decode(*joined, again, own) == Translator::Outcome::good && again == value);
}

/// Both halves as they come from a server.
void try_parts(Script script) {
  static const Translator plan = plan_of("left, right", Direction::receive);
  const ProgressType type(progress_message());
  const Bytes feedback = script.take_some(), result = script.take_some();
  const std::array<std::uint64_t, 2> own{1, 2};
  Bytes value;
  if (const auto joined = type.join(feedback, result)) static_cast<void>(plan.decode(*joined, value, own));
  if (const auto parts = type.split(feedback, 6))
    require(type.join(parts->feedback, parts->result).has_value());
}

/// Each message of an action, read and written.
void try_messages(std::span<const std::byte> bytes) {
  if (const auto named = split_goal_id(bytes))
    require(with_goal_id(named->id, named->message) == Bytes(bytes.begin(), bytes.end()));
  if (const auto accepted = read_goal_answer(bytes))
    require(read_goal_answer(goal_answer(*accepted, {1, 2})) == accepted);
  if (const auto id = read_result_request(bytes)) require(read_result_request(result_request(*id)) == id);
  static_cast<void>(read_result_status(bytes));
  static_cast<void>(read_cancel_answer(bytes));
  if (const auto request = read_cancel_request(bytes)) {
    const auto again = read_cancel_request(cancel_request(*request));
    require(again && again->id == request->id);
  }
  if (const auto goals = read_status(bytes)) {
    const auto again = read_status(status_message(*goals));
    require(again && again->size() == goals->size());
  }
}

/// The states that a receptor sees are one life after the other.
class WatchedLife {
 public:
  void play(Script script) {
    while (script.any()) {
      step(script);
      look();
    }
    // However it was, a goal ends.
    life_.order(call_, false, {}, now_);
    for (int round = 0; round < 40; ++round) {
      now_ += std::chrono::milliseconds(400);
      life_.tick(now_);
      look();
    }
    require(life_.state() == GoalState::none || life_.state() >= GoalState::succeeded || is_alive_);
  }

 private:
  void step(Script& script) {
    const std::uint8_t kind = script.take();
    const GoalId id = name_of(script.take());
    now_ += std::chrono::milliseconds(kind);
    is_alive_ = false;
    switch (kind % 9) {
      case 0:
        call_ = script.take() % 5;
        return life_.order(call_, script.take() % 2 == 1, script.take_some(), now_);
      case 1:
        return life_.hear_of_server(script.take() % 4 != 0, now_);
      case 2:
        return life_.hear_sign_of_life();
      case 3:
        return life_.hear_answer(id, script.take() % 2 == 1, now_);
      case 4: {
        const Bytes result = script.take_some();
        return life_.hear_result(id, read_result_status(result), result, now_);
      }
      case 5: {
        const Bytes states = script.take_some();
        for (const GoalStatus& one : read_status(states).value_or(std::vector<GoalStatus>{}))
          life_.hear_status(one.info.id, one.status, now_);
        return life_.hear_status(id, static_cast<std::int8_t>(script.take()), now_);
      }
      case 6:
        return life_.hear_feedback(id, script.take_some());
      case 7:
        return life_.hear_of_cancel(id, static_cast<CancelCode>(script.take()), now_);
      default:
        return life_.tick(now_);
    }
  }

  void look() {
    for (const GoalLife::Deed& deed : life_.take_deeds())
      require(deed.kind == GoalLife::Deed::Kind::probe || deed.id[0] < std::byte{12});
    while (const auto event = life_.take_event()) {
      if (event->call != shown_call_) {
        shown_call_ = event->call;
        shown_ = GoalState::none;
      }
      require(event->state == shown_ || may_follow(shown_, event->state));
      require(event->result.empty() || event->state >= GoalState::succeeded);
      shown_ = event->state;
    }
  }

  std::uint8_t next_ = 0;
  GoalLife life_{[this] { return name_of(next_++); }};
  Instant now_{};
  std::uint64_t call_ = 0, shown_call_ = 0;
  GoalState shown_ = GoalState::none;
  bool is_alive_ = false;
};

/// A server answers each question at most once, and each goal at its end.
void try_server(Script script) {
  ServedGoals goals;
  const ProgressType type(progress_message());
  goals.use_empty_result(type.empty_result(0));
  if (script.take() % 4 == 0) goals.refuse_cancels();
  Instant now{};
  ServedGoals::Question question = 0;
  std::vector<std::uint8_t> answers;
  const auto look = [&] {
    for (const ServedGoals::Deed& deed : goals.take_deeds()) {
      using Kind = ServedGoals::Deed::Kind;
      if (deed.kind == Kind::status) require(read_status(deed.message).has_value());
      if (deed.kind == Kind::feedback || deed.kind == Kind::status) continue;
      require(deed.question < answers.size() && ++answers[deed.question] == 1);
    }
  };
  const auto asked = [&] {
    answers.push_back(0);
    return question++;
  };
  while (script.any()) {
    const std::uint8_t kind = script.take();
    now += std::chrono::milliseconds(20 * kind);
    const GoalId id = name_of(script.take());
    if (kind % 7 == 0) goals.hear_goal(asked(), id, script.take_some(), {}, now);
    if (kind % 7 == 1) goals.hear_result_question(asked(), id);
    if (kind % 7 == 2) {
      const auto request = read_cancel_request(script.take_some());
      goals.hear_cancel(asked(), request.value_or(CancelRequest{id, {}}));
    }
    if (kind % 7 == 3) goals.tick({}, now);
    if (kind % 7 == 4 || kind % 7 == 5) {
      const std::uint8_t number = script.take() % 12;
      const auto state = static_cast<GoalState>(script.take() % 10);
      Bytes feedback{std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}};
      std::ranges::copy(script.take_some(), std::back_inserter(feedback));
      goals.say(number, state, feedback, type.empty_result(static_cast<std::int8_t>(state)), {}, now);
    }
    if (kind % 7 == 6) goals.refuse(script.take() % 12, {});
    while (goals.take_event()) {
    }
    look();
  }
  goals.end_all({}, now);
  look();
}

/// A run that keeps what was set.
class Robots final : public Ros2Host {
 public:
  [[nodiscard]] std::vector<Ros2Parameter> parameters() const override { return all_; }
  [[nodiscard]] std::optional<std::string> set(std::span<const Change> changes) override {
    for (const Change& change : changes) {
      const auto one = std::ranges::find(all_, change.first, &Ros2Parameter::path);
      require(one != all_.end() && change.second.size() < 100'000);
      one->value = change.second;
    }
    return std::nullopt;
  }
  [[nodiscard]] std::vector<Ros2Status> statuses() override { return {}; }
  [[nodiscard]] std::string system() const override { return "fuzz"; }

 private:
  std::vector<Ros2Parameter> all_{
      {.path = "robot.control.gain", .value = "0.5", .minimum = 0, .maximum = 10},
      {.path = "robot.control.tries", .kind = Ros2Parameter::Kind::integer, .value = "3"},
      {.path = "robot.control.on", .kind = Ros2Parameter::Kind::boolean, .value = "true"},
      {.path = "robot.control.label", .kind = Ros2Parameter::Kind::text, .value = "a", .longest = 16},
      {.path = "robot.control.points", .kind = Ros2Parameter::Kind::reals, .value = "[1, 2]", .elements = 2}};
};

void try_parameters(std::uint8_t which, std::span<const std::byte> bytes) {
  Robots robots;
  NodeParameters node(robots, "/robot", {"robot"});
  static_cast<void>(node.answer(static_cast<ParameterService>(which % parameter_services.size()), bytes));
  static_cast<void>(node.event({1, 2}));
}

}  // namespace

/// The first byte chooses: feedback and result in one message or as they come, the messages of an action, the life of
/// a goal, a server, or a request for parameters.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const std::span<const std::byte> bytes(reinterpret_cast<const std::byte*>(data) + 1, size - 1);
  switch (data[0] % 6) {
    case 0:
      try_progress(bytes);
      break;
    case 1:
      try_parts(Script(bytes));
      break;
    case 2:
      try_messages(bytes);
      break;
    case 3:
      WatchedLife().play(Script(bytes));
      break;
    case 4:
      try_server(Script(bytes));
      break;
    default:
      try_parameters(data[1], bytes.subspan(1));
  }
  return 0;
}
