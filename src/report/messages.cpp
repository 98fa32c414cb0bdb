#include "report/messages.hpp"

#include <algorithm>
#include <map>
#include <string_view>
#include <tuple>

#include "report/text.hpp"

namespace tessera::report {
namespace {

constexpr std::size_t most_bytes = 400, most_lines = 6;

using Entry = Recording::Entry;
using Weight = Message::Weight;

/// Equal messages of one subsystem.
struct Group {
  const Entry* first = nullptr;
  std::int64_t last_ns = 0;
  std::uint64_t count = 0;
};

/// Whether the event is a message: values and markings are not.
bool is_message(const Event& event) {
  return event.kind() == Event::Kind::log || event.kind() == Event::Kind::stop ||
         event.kind() == Event::Kind::fault || event.kind() == Event::Kind::safe;
}

Weight weight_of(const Event& event) {
  if (event.kind() == Event::Kind::safe)
    return event.version == static_cast<std::uint32_t>(SafeEvent::refused) ? Weight::bad : Weight::plain;
  if (event.kind() == Event::Kind::stop) return event.version == 0 ? Weight::plain : Weight::bad;
  if (event.is_told_fault()) return Weight::warning;
  if (event.kind() == Event::Kind::fault || event.version >= 2) return Weight::bad;
  return event.version == 1 ? Weight::warning : Weight::plain;
}

std::vector<Group> groups_of(const Recording& recording) {
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::string_view>, std::size_t> numbers;
  std::vector<Group> groups;
  for (const Entry& entry : recording.entries) {
    if (!is_message(entry.event)) continue;
    const auto [at, is_new] =
        numbers.try_emplace({entry.event.origin, entry.event.version, entry.text}, groups.size());
    if (is_new) groups.push_back({.first = &entry});
    Group& group = groups[at->second];
    group.last_ns = entry.event.time_ns;
    ++group.count;
  }
  std::ranges::stable_sort(groups, {}, [](const Group& group) { return group.first->event.time_ns; });
  return groups;
}

/// Selects the messages that are shown. The end has the same weight as faults.
std::vector<bool> chosen_of(const std::vector<Group>& groups, std::size_t most) {
  std::vector<bool> chosen(groups.size(), false);
  for (const Weight weight : {Weight::bad, Weight::warning, Weight::plain}) {
    std::vector<std::size_t> alike;
    for (std::size_t index = 0; index < groups.size(); ++index) {
      const Event& event = groups[index].first->event;
      const Weight its = event.kind() == Event::Kind::stop ? Weight::bad : weight_of(event);
      if (its == weight) alike.push_back(index);
    }
    const std::size_t count = std::min(most, alike.size());
    const std::size_t last = count / 2;
    for (std::size_t index = 0; index < count - last; ++index) chosen[alike[index]] = true;
    for (std::size_t index = alike.size() - last; index < alike.size(); ++index) chosen[alike[index]] = true;
    most -= count;
  }
  return chosen;
}

Message message_of(const Recording& recording, const Group& group) {
  const Event& event = group.first->event;
  const std::string text = shortened(group.first->text, most_bytes, most_lines);
  const std::string prefix = event.kind() == Event::Kind::stop ? "ended: "
                             : event.kind() == Event::Kind::fault
                                 ? "fault (" + std::string(name_of(event.fault())) + "): "
                                 : "";
  const bool by_subsystem = event.instance() < recording.instances.size();
  return {.first_ns = event.time_ns,
          .last_ns = group.last_ns,
          .count = group.count,
          .weight = weight_of(event),
          .who = by_subsystem ? recording.instances[event.instance()] : "system",
          .what = prefix + text};
}

}  // namespace

Messages messages_of(const Recording& recording, std::size_t most) {
  const std::vector<Group> groups = groups_of(recording);
  const std::vector<bool> chosen = chosen_of(groups, most);
  Messages messages;
  for (std::size_t index = 0; index < groups.size(); ++index) {
    if (chosen[index])
      messages.shown.push_back(message_of(recording, groups[index]));
    else
      messages.hidden += groups[index].count;
  }
  return messages;
}

}  // namespace tessera::report
