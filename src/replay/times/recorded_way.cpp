#include "replay/times/recorded_way.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "replay/source.hpp"

namespace tessera::replay {
namespace {

using Moved = Steps::Step::Kind;

/// The last step before `at` of which this is true, since the subsystem has started.
template <class Is>
std::optional<std::size_t> last_before(const Steps& steps, std::size_t at, Is&& is) {
  while (at-- > 0) {
    if (is(steps.all[at])) return at;
    if (steps.all[at].kind == Moved::started || steps.all[at].kind == Moved::lost) return std::nullopt;
  }
  return std::nullopt;
}

/// A call whose outputs are new.
bool is_done(const Steps::Step& step) {
  return (step.kind == Moved::finished || step.kind == Moved::withheld) && !step.failed;
}

}  // namespace

RecordedWayReader::RecordedWayReader(const Recording& header, MeasuredChain chain, const ExplainedTime& time)
    : chain_(std::move(chain)), time_(time) {
  for (std::uint32_t index = 0; index < header.channels.size(); ++index)
    channels_.emplace(header.channels[index], index);
  for (const std::string& subsystem : chain_.subsystems) {
    const auto found = std::ranges::find(header.instances, subsystem);
    if (found == header.instances.end()) return;
    lanes_.push_back(static_cast<std::uint32_t>(found - header.instances.begin()));
    readers_[lanes_.back()];
  }
}

void RecordedWayReader::take(const Recording& header, const Recording::Entry& entry) {
  const auto reader = readers_.find(entry.event.instance());
  if (reader == readers_.end()) return;
  reader->second.take(header, entry);
  const std::optional<FinishedCall> call = calls_.follow(header, entry);
  if (!call) return;
  const std::int64_t end_ns = call->since_ns + call->took_ns;
  if (end_ns >= time_.from_ns && call->since_ns <= time_.to_ns)
    way_.calls.push_back(
        {header.instances[call->instance], std::string(call->behaviour), call->since_ns, end_ns});
}

std::vector<RecordedWay::Hop> RecordedWayReader::hops_along(
    const std::vector<std::uint32_t>& channels, const std::vector<std::string>& names,
    const std::unordered_map<std::uint32_t, Steps>& steps) const {
  const Steps* now = &steps.at(lanes_.back());
  const auto command = std::ranges::find_if(now->all, [&](const Steps::Step& step) {
    return step.kind == Moved::finished && step.time_ns == time_.to_ns;
  });
  if (command == now->all.end()) return {};
  auto done = static_cast<std::size_t>(command - now->all.begin());
  std::vector<RecordedWay::Hop> hops;
  for (std::size_t hop = channels.size(); hop-- > 0;) {
    const auto is_over = [&](const Steps::Step& step) {
      return step.kind == Moved::transferred && step.channel == channels[hop];
    };
    const std::optional<std::size_t> read = last_before(*now, done, is_over);
    if (!read) return {};
    const Steps::Step& reading = now->all[*read];
    const Steps& sender = steps.at(lanes_[hop]);
    const auto later = std::ranges::upper_bound(sender.all, reading.time_ns, {}, &Steps::Step::time_ns);
    const std::optional<std::size_t> written = last_before(
        sender, static_cast<std::size_t>(later - sender.all.begin()),
        [&](const Steps::Step& step) { return is_over(step) && is_before(step.version, reading.version); });
    if (!written) return {};
    hops.push_back({names[hop], chain_.subsystems[hop], chain_.subsystems[hop + 1],
                    sender.all[*written].time_ns, reading.time_ns});
    const std::optional<std::size_t> calculated = last_before(sender, *written, is_done);
    if (!calculated) return {};
    now = &sender;
    done = *calculated;
  }
  const std::optional<std::size_t> called =
      last_before(*now, done, [](const Steps::Step& step) { return step.kind == Moved::called; });
  if (!called) return {};
  const std::int64_t read_ns = now->all[*called].time_ns;
  if (time_.of == ExplainedTime::Of::age ? read_ns != time_.from_ns : read_ns <= time_.from_ns) return {};
  std::ranges::reverse(hops);
  return hops;
}

RecordedWay RecordedWayReader::finish() {
  std::ranges::stable_sort(way_.calls, {}, &RecordedWay::Call::begin_ns);
  if (lanes_.size() != chain_.subsystems.size()) return std::move(way_);
  std::unordered_map<std::uint32_t, Steps> steps;
  for (auto& [instance, reader] : readers_) steps.emplace(instance, reader.finish());
  for (const std::vector<std::string>& way : chain_.ways) {
    std::vector<std::uint32_t> channels;
    for (const std::string& channel : way)
      if (const auto found = channels_.find(channel); found != channels_.end())
        channels.push_back(found->second);
    if (channels.size() != way.size() || channels.size() + 1 != lanes_.size()) continue;
    way_.hops = hops_along(channels, way, steps);
    if (!way_.hops.empty()) break;
  }
  return std::move(way_);
}

}  // namespace tessera::replay
