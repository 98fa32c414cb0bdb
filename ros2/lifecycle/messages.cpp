#include "ros2/lifecycle/messages.hpp"

#include "ros2/codec/cdr_message.hpp"

namespace tessera::ros2 {
namespace {

constexpr std::size_t most_padding_of_request = 3;

void put_named(std::uint8_t id, const char* label, CdrWriter& writer) {
  writer.number(&id, sizeof id);
  writer.text(label);
}
void put_state(LifecycleState state, CdrWriter& writer) {
  put_named(static_cast<std::uint8_t>(state), label_of(state), writer);
}
void put_step(const LifecycleTransition& step, CdrWriter& writer) {
  put_named(step.id, step.label, writer);
  put_state(step.from, writer);
  put_state(step.to, writer);
}

}  // namespace

std::optional<ChangeRequest> read_change_request(std::span<const std::byte> message) {
  auto reader = CdrReader::open(message);
  if (!reader) return std::nullopt;
  ChangeRequest request;
  if (const auto id = reader->numbers(1, 1); !id.empty()) request.id = std::to_integer<std::uint8_t>(id[0]);
  request.label = std::string(reader->text());
  if (!reader->ok() || reader->left() > most_padding_of_request) return std::nullopt;
  return request;
}

std::vector<std::byte> change_answer(bool success) {
  return cdr_message([&](CdrWriter& writer) { writer.number(&success, sizeof success); });
}

std::vector<std::byte> state_answer(LifecycleState state) {
  return cdr_message([&](CdrWriter& writer) { put_state(state, writer); });
}

std::vector<std::byte> states_answer(std::span<const LifecycleState> states) {
  return cdr_message([&](CdrWriter& writer) {
    writer.length(static_cast<std::uint32_t>(states.size()));
    for (const LifecycleState state : states) put_state(state, writer);
  });
}

std::vector<std::byte> transitions_answer(std::span<const LifecycleTransition> transitions) {
  return cdr_message([&](CdrWriter& writer) {
    writer.length(static_cast<std::uint32_t>(transitions.size()));
    for (const LifecycleTransition& step : transitions) put_step(step, writer);
  });
}

std::vector<std::byte> transition_event(std::uint64_t time_ns, const LifecycleTransition& step) {
  return cdr_message([&](CdrWriter& writer) {
    writer.number(&time_ns, sizeof time_ns);
    put_step(step, writer);
  });
}

}  // namespace tessera::ros2
