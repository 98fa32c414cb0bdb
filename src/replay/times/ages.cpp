#include "replay/times/ages.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tessera::replay {
namespace {

constexpr std::size_t age_steps = 24;

std::unordered_map<std::string, std::uint32_t> numbered_names(const std::vector<std::string>& names) {
  std::unordered_map<std::string, std::uint32_t> numbers;
  for (std::size_t index = 0; index < names.size(); ++index)
    numbers.emplace(names[index], static_cast<std::uint32_t>(index));
  return numbers;
}

/// Each reading with the first command that reflects a later one: from just after the reading to the end of that
/// command. `found(reading, command)`.
///
/// A command of an unknown reading may be the first, so that nothing is known of the readings before it.
template <class Found>
void for_reactions(const std::vector<ReadingCommand>& readings, const std::vector<ReadingCommand>& commands,
                   Found&& found) {
  std::size_t next = 0;
  for (const ReadingCommand& reading : readings) {
    const auto is_too_early = [&](const ReadingCommand& command) {
      if (command.start != reading.start) return command.start < reading.start;
      if (command.reading == unknown_reading) return command.time_ns < reading.time_ns;
      return command.withheld || command.reading <= reading.time_ns;
    };
    while (next < commands.size() && is_too_early(commands[next])) ++next;
    if (next == commands.size()) return;
    if (commands[next].start == reading.start && is_known(commands[next].reading))
      found(reading, commands[next]);
  }
}

}  // namespace

Ages::Ages(std::vector<MeasuredChain> chains) : chains_(std::move(chains)) {
  std::unordered_map<std::string, std::size_t> group_of;
  for (const MeasuredChain& chain : chains_) {
    const auto [at, is_new] = group_of.try_emplace(chain.group, groups_.size());
    if (is_new) groups_.push_back({chain.group, 0, 0, {}, {}, {}});
    ++groups_[at->second].chains;
    group_of_.push_back(at->second);
  }
}

void Ages::add(const Recording& recording) {
  begin(recording);
  for (const Recording::Entry& entry : recording.entries) take(recording, entry);
  end();
}

void Ages::begin(const Recording& header) {
  reading_ = {numbered_names(header.instances),
              numbered_names(header.channels),
              {header.networked.begin(), header.networked.end()},
              {}};
  for (const MeasuredChain& chain : chains_)
    for (const std::string& subsystem : chain.subsystems)
      if (const auto found = reading_.instances.find(subsystem); found != reading_.instances.end())
        reading_.readers[found->second];
}

void Ages::take(const Recording& header, const Recording::Entry& entry) {
  if (const auto reader = reading_.readers.find(entry.event.instance()); reader != reading_.readers.end())
    reader->second.take(header, entry);
}

void Ages::end() {
  const std::uint32_t number = recordings_++;
  const auto& [instances, channels, networked, readers] = reading_;
  std::unordered_map<std::uint32_t, Steps> steps;
  for (auto& [instance, reader] : reading_.readers) steps.emplace(instance, reader.finish());

  for (std::uint32_t index = 0; index < chains_.size(); ++index) {
    const MeasuredChain& chain = chains_[index];
    Group& group = groups_[group_of_[index]];
    const auto explain = [&](std::string why) {
      if (group.why.empty()) group.why = std::move(why);
    };
    std::vector<const Steps*> lanes;
    for (const std::string& subsystem : chain.subsystems) {
      const auto found = instances.find(subsystem);
      if (found == instances.end())
        explain("the recording has no subsystem " + subsystem);
      else
        lanes.push_back(&steps.at(found->second));
    }
    if (lanes.size() != chain.subsystems.size()) continue;
    if (!lanes.front()->has_calls && !lanes.front()->all.empty()) {
      explain("the recording does not tell when devices are read: record with --record-values small");
      continue;
    }
    for (const std::vector<std::string>& way : chain.ways) {
      std::vector<std::uint32_t> hops;
      for (const std::string& channel : way) {
        const auto found = channels.find(channel);
        if (found == channels.end())
          explain("the recording has no channel " + channel);
        else if (networked.contains(channel))
          explain(channel + " is between processes");
        else
          hops.push_back(found->second);
      }
      if (hops.size() != way.size() || hops.size() + 1 != lanes.size()) continue;
      std::vector<ReadingCommand> readings;
      SentReadings sent = readings_sent(*lanes[0], hops[0], readings);
      for (std::size_t hop = 1; hop < hops.size(); ++hop)
        sent = readings_sent_on(*lanes[hop], hops[hop - 1], sent, hops[hop]);
      const std::vector<ReadingCommand> commands = commands_of(*lanes.back(), hops.back(), sent);
      for (const ReadingCommand& command : commands) {
        group.withheld += static_cast<std::uint64_t>(command.withheld);
        if (!command.withheld && is_known(command.reading))
          group.ages.push_back({command.reading, command.time_ns, index, number});
      }
      for_reactions(readings, commands, [&](const ReadingCommand& reading, const ReadingCommand& command) {
        group.reactions.push_back({reading.time_ns, command.time_ns, index, number});
      });
    }
  }
}

MeasuredTimes Ages::times_of(const std::vector<Sample>& samples) const {
  MeasuredTimes result;
  result.count = samples.size();
  if (samples.empty()) return result;
  std::vector<std::int64_t> times;
  times.reserve(samples.size());
  const auto length = [](const Sample& sample) { return sample.to_ns - sample.from_ns; };
  for (const Sample& sample : samples) times.push_back(length(sample));
  const Sample& worst = *std::ranges::max_element(samples, {}, length);
  std::ranges::sort(times);
  const auto quantile = [&](double share) {
    const double rank = std::ceil(share * static_cast<double>(times.size())) - 1;
    return times[static_cast<std::size_t>(std::max(rank, 0.0))];
  };
  result.least = times.front();
  result.median = quantile(0.5);
  result.p95 = quantile(0.95);
  result.p99 = quantile(0.99);
  result.most = times.back();
  if (result.most > result.least) {
    result.histogram.resize(age_steps);
    const double width = static_cast<double>(result.most - result.least);
    for (const std::int64_t time : times) {
      const double share = static_cast<double>(time - result.least) / width;
      ++result.histogram[std::min(static_cast<std::size_t>(share * age_steps), age_steps - 1)];
    }
  }
  result.worst_chain = chains_[worst.chain].name;
  result.worst_recording = worst.recording;
  result.worst_from_ns = worst.from_ns;
  result.worst_to_ns = worst.to_ns;
  return result;
}

std::vector<ChainAges> Ages::finish() const {
  std::vector<ChainAges> all;
  for (const Group& group : groups_) {
    ChainAges& one = all.emplace_back();
    one.group = group.name;
    one.chains = group.chains;
    one.withheld = group.withheld;
    one.age = times_of(group.ages);
    one.reaction = times_of(group.reactions);
    if (group.ages.empty()) one.why = group.why.empty() ? "no command reflects a reading" : group.why;
  }
  return all;
}

}  // namespace tessera::replay
