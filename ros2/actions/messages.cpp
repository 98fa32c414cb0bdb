#include "ros2/actions/messages.hpp"

#include <algorithm>
#include <cstring>

#include "ros2/codec/cdr_message.hpp"
#include "ros2/codec/message_copy.hpp"

namespace tessera::ros2 {
namespace {

constexpr std::size_t most_padding = 3, most_goals = 65'536;
constexpr std::size_t feedback_part = 0, result_part = 1;

template <class Number>
void write(Number number, CdrWriter& writer) {
  writer.number(&number, sizeof number);
}

GoalId read_id(CdrReader& reader) {
  GoalId id{};
  const auto bytes = reader.numbers(1, id.size());
  if (!bytes.empty()) std::ranges::copy(bytes, id.begin());
  return id;
}
void write(const GoalId& id, CdrWriter& writer) { std::ranges::copy(id, writer.numbers(1, id.size())); }

/// GoalInfo.
GoalInfo read_info(CdrReader& reader) {
  GoalInfo info;
  info.id = read_id(reader);
  info.stamp.sec = reader.number<std::int32_t>();
  info.stamp.nanosec = reader.number<std::uint32_t>();
  return info;
}
void write(const GoalInfo& info, CdrWriter& writer) {
  write(info.id, writer);
  write(info.stamp.sec, writer);
  write(info.stamp.nanosec, writer);
}

/// The data may be padded to four bytes.
bool is_read(const CdrReader& reader) { return reader.ok() && reader.left() <= most_padding; }

template <class Read>
auto read(std::span<const std::byte> message, Read read_data) {
  std::optional<decltype(read_data(std::declval<CdrReader&>()))> data;
  auto reader = CdrReader::open(message);
  if (!reader) return data;
  data = read_data(*reader);
  if (!is_read(*reader)) data.reset();
  return data;
}

}  // namespace

MessageBytes with_goal_id(const GoalId& id, std::span<const std::byte> message) {
  MessageBytes all(message.begin(), message.end());
  // Its size is a multiple of the largest alignment, so the data after it stays aligned.
  all.insert(all.begin() + encapsulation_size, id.begin(), id.end());
  return all;
}

std::optional<NamedMessage> split_goal_id(std::span<const std::byte> message) {
  auto reader = CdrReader::open(message);
  if (!reader) return std::nullopt;
  NamedMessage named{read_id(*reader), {message.begin(), message.end()}};
  if (!reader->ok()) return std::nullopt;
  const auto first = named.message.begin() + encapsulation_size;
  named.message.erase(first, first + named.id.size());
  return named;
}

MessageBytes goal_answer(bool accepted, const Stamp& at) {
  return cdr_message([&](CdrWriter& writer) {
    write(static_cast<std::uint8_t>(accepted), writer);
    write(at.sec, writer);
    write(at.nanosec, writer);
  });
}

std::optional<bool> read_goal_answer(std::span<const std::byte> message) {
  const auto accepted = read(message, [](CdrReader& reader) {
    const auto flag = reader.number<std::uint8_t>();
    if (flag > 1) reader.fail();
    static_cast<void>(reader.number<std::int32_t>());
    static_cast<void>(reader.number<std::uint32_t>());
    return flag;
  });
  return accepted ? std::optional(*accepted == 1) : std::nullopt;
}

MessageBytes result_request(const GoalId& id) {
  return cdr_message([&](CdrWriter& writer) { write(id, writer); });
}

std::optional<GoalId> read_result_request(std::span<const std::byte> message) {
  return read(message, read_id);
}

std::optional<std::int8_t> read_result_status(std::span<const std::byte> message) {
  auto reader = CdrReader::open(message);
  if (!reader) return std::nullopt;
  const auto status = reader->number<std::int8_t>();
  return reader->ok() ? std::optional(status) : std::nullopt;
}

MessageBytes cancel_request(const CancelRequest& request) {
  return cdr_message([&](CdrWriter& writer) { write(GoalInfo{request.id, request.stamp}, writer); });
}

std::optional<CancelRequest> read_cancel_request(std::span<const std::byte> message) {
  const auto info = read(message, read_info);
  return info ? std::optional(CancelRequest{info->id, info->stamp}) : std::nullopt;
}

MessageBytes cancel_answer(CancelCode code, std::span<const GoalInfo> canceling) {
  return cdr_message([&](CdrWriter& writer) {
    write(static_cast<std::int8_t>(code), writer);
    writer.length(static_cast<std::uint32_t>(canceling.size()));
    for (const GoalInfo& one : canceling) write(one, writer);
  });
}

std::optional<CancelCode> read_cancel_answer(std::span<const std::byte> message) {
  return read(message, [](CdrReader& reader) {
    const auto code = reader.number<std::int8_t>();
    const std::uint32_t count = reader.length();
    for (std::uint32_t index = 0; index < count && reader.ok(); ++index) static_cast<void>(read_info(reader));
    return static_cast<CancelCode>(code);
  });
}

MessageBytes status_message(std::span<const GoalStatus> goals) {
  return cdr_message([&](CdrWriter& writer) {
    writer.length(static_cast<std::uint32_t>(goals.size()));
    for (const GoalStatus& one : goals) {
      write(one.info, writer);
      write(one.status, writer);
    }
  });
}

std::optional<std::vector<GoalStatus>> read_status(std::span<const std::byte> message) {
  return read(message, [](CdrReader& reader) {
    std::vector<GoalStatus> goals;
    const std::uint32_t count = reader.length();
    if (count > most_goals) reader.fail();
    for (std::uint32_t index = 0; index < count && reader.ok(); ++index) {
      const GoalInfo info = read_info(reader);
      goals.push_back({info, reader.number<std::int8_t>()});
    }
    return goals;
  });
}

std::optional<MessageBytes> ProgressType::join(std::span<const std::byte> feedback,
                                               std::span<const std::byte> result) const {
  bool good = true;
  const auto add = [&](std::span<const std::byte> message, std::size_t index, CdrWriter& writer) {
    if (message.empty()) return write_empty_message(part(index), writer);
    auto reader = CdrReader::open(message);
    good = good && reader;
    if (!good) return;
    if (index == result_part) static_cast<void>(reader->number<std::int8_t>());
    copy_message(part(index), *reader, writer);
    good = is_read(*reader);
  };
  MessageBytes joined = cdr_message([&](CdrWriter& writer) {
    add(feedback, feedback_part, writer);
    add(result, result_part, writer);
  });
  return good ? std::optional(std::move(joined)) : std::nullopt;
}

std::optional<ProgressType::Parts> ProgressType::split(std::span<const std::byte> progress,
                                                       std::int8_t status) const {
  auto reader = CdrReader::open(progress);
  if (!reader) return std::nullopt;
  Parts parts;
  parts.feedback =
      cdr_message([&](CdrWriter& writer) { copy_message(part(feedback_part), *reader, writer); });
  parts.result = cdr_message([&](CdrWriter& writer) {
    write(status, writer);
    copy_message(part(result_part), *reader, writer);
  });
  return is_read(*reader) ? std::optional(std::move(parts)) : std::nullopt;
}

MessageBytes ProgressType::empty_result(std::int8_t status) const {
  return cdr_message([&](CdrWriter& writer) {
    write(status, writer);
    write_empty_message(part(result_part), writer);
  });
}

}  // namespace tessera::ros2
