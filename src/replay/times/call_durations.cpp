#include "replay/times/call_durations.hpp"

#include <algorithm>
#include <utility>

#include "replay/source.hpp"
#include "tessera/transition_role.hpp"

namespace tessera::replay {

CallDurations joined(const CallDurations& one, const CallDurations& other) {
  CallDurations result = one.count == 0 || (other.count > 0 && other.most_ns > one.most_ns) ? other : one;
  if (one.count > 0 && other.count > 0) result.least_ns = std::min(one.least_ns, other.least_ns);
  result.count = one.count + other.count;
  result.failed = one.failed + other.failed;
  return result;
}

std::optional<FinishedCall> CallReader::follow(const Recording& header, const Recording::Entry& entry) {
  const Event& event = entry.event;
  if (event.instance() >= header.instances.size()) return std::nullopt;
  open_.resize(header.instances.size());
  OpenCall& call = open_[event.instance()];
  if (is_counted(event)) {
    if (call.next_sequence && *call.next_sequence != event.sequence) call.since_ns.reset();
    call.next_sequence = event.sequence + 1;
  }
  if (event.kind() == Event::Kind::call) {
    call.since_ns = event.time_ns;
    call.behaviour = event.subject;
    call.failed = false;
  } else if (event.kind() == Event::Kind::fault) {
    call.failed = call.failed || !event.is_told_fault();
  } else if (event.kind() == Event::Kind::firing && call.since_ns &&
             header.transitions[event.subject].role.step == Step::begin_sending) {
    const std::int64_t since_ns = *std::exchange(call.since_ns, std::nullopt);
    const std::vector<std::string>& names = header.behaviours[event.instance()];
    if (call.behaviour < names.size())
      return FinishedCall{event.instance(), names[call.behaviour], since_ns, event.time_ns - since_ns,
                          call.failed};
  }
  return std::nullopt;
}

void add_durations(const Recording& recording, DurationsOfBehaviours& to) {
  CallReader reader;
  for (const Recording::Entry& entry : recording.entries) {
    const std::optional<FinishedCall> call = reader.follow(recording, entry);
    if (!call) continue;
    CallDurations one{1, 0, call->took_ns, call->took_ns, call->since_ns};
    if (call->failed) one = {0, 1};
    CallDurations& all = to[{recording.instances[call->instance], std::string(call->behaviour)}];
    all = joined(all, one);
  }
}

}  // namespace tessera::replay
