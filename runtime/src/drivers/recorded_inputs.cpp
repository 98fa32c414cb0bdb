#include "drivers/recorded_inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <stdexcept>
#include <utility>

#include "tessera/recording.hpp"

namespace tessera {
namespace {

constexpr const char* clock_of_bags = "bag";

/// Accepts every command.
class CommandsGoNowhere final : public RealEffector {
  bool write(std::span<const std::byte>) override { return true; }
};

}  // namespace

std::unique_ptr<RecordedInputs> RecordedInputs::read(const std::string& file, std::string& error) {
  const std::optional<Recording> recording = read_recording(file, error);
  if (!recording) return nullptr;
  const auto refuse = [&](const std::string& why) {
    error = fmt::format("cannot take inputs from '{}': {}", file, why);
    return nullptr;
  };
  if (recording->buffers.empty())
    return refuse("it holds no values of buffers: record the run with --record-values small or all");
  if (lacks_beginning(*recording)) return refuse(note_on_beginning(*recording));
  auto inputs = std::make_unique<RecordedInputs>();
  std::vector<std::shared_ptr<Input>> of_buffer;
  for (const Recording::Buffer& buffer : recording->buffers) {
    of_buffer.push_back(nullptr);
    if (buffer.direction != Recording::Direction::real_input) continue;
    of_buffer.back() = inputs->inputs_[buffer.path] = std::make_shared<Input>();
    of_buffer.back()->type = buffer.type;
    of_buffer.back()->are_messages = recording->clock == clock_of_bags;
  }
  for (const Recording::Entry& entry : recording->entries) {
    if (entry.event.kind() != Event::Kind::value) continue;
    const ValueEvent value = value_of(entry);
    Input* const input = of_buffer[value.buffer].get();
    if (input == nullptr) continue;
    if (value.has(ValueFlags::hashed))
      return refuse(
          fmt::format("the values of {} are too large and not in it: record with --record-values all",
                      recording->buffers[value.buffer].path));
    Value one{entry.event.time_ns, std::string(value.bytes), value.has(ValueFlags::silent),
              value.has(ValueFlags::failed), value.has(ValueFlags::queued)};
    if (value.has(ValueFlags::same))
      for (auto before = input->values.rbegin(); before != input->values.rend(); ++before)
        if (!before->silent && !before->failed) {
          one.bytes = before->bytes;
          break;
        }
    input->values.push_back(std::move(one));
  }
  for (auto& [path, input] : inputs->inputs_) std::ranges::stable_sort(input->values, {}, &Value::time_ns);
  return inputs;
}

std::unique_ptr<Subsystem> RecordedInputs::subsystem(std::uint32_t, std::unique_ptr<Subsystem> own,
                                                     bool& scripted) {
  scripted = false;
  return own;
}

std::unique_ptr<RealReceptor> RecordedInputs::receptor(const std::string& path) {
  const auto found = inputs_.find(path);
  return std::make_unique<RecordedReceptor>(found == inputs_.end() ? std::make_shared<Input>()
                                                                   : found->second);
}

std::unique_ptr<RealEffector> RecordedInputs::effector(const std::string&) {
  return std::make_unique<CommandsGoNowhere>();
}

std::optional<Problem> RecordedReceptor::follow(const Clock& clock, const std::string& path,
                                                const ValueEncoding* encoding) {
  clock_ = &clock;
  encoding_ = encoding;
  const std::string type = encoding == nullptr ? "of no fixed extent" : encoding->type();
  if (input_->values.empty() || type == input_->type) return std::nullopt;
  return Problem{
      fmt::format("{} is {} in the recorded inputs, and {} in this controller", path, input_->type, type)};
}

bool RecordedReceptor::read(std::span<std::byte> value) {
  const std::size_t before = next_;
  const std::int64_t now_ns = clock_->now().time_since_epoch().count();
  while (next_ < input_->values.size() && input_->values[next_].time_ns <= now_ns)
    if (input_->values[next_++].queued) break;
  if (next_ == 0 || (input_->are_messages && next_ == before)) return false;
  const RecordedInputs::Value& newest = input_->values[next_ - 1];
  if (newest.failed && next_ != before) throw std::runtime_error("it threw in the recorded run");
  if (newest.silent || newest.failed) return false;
  return encoding_->take(value.data(), std::as_bytes(std::span(newest.bytes)));
}

}  // namespace tessera
