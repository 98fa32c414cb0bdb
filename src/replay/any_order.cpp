#include <fmt/core.h>

#include <algorithm>
#include <iterator>

#include "replay/judge.hpp"

namespace tessera::replay {

using net::ChannelId;

std::vector<NetPlay::Start> AnyOrder::starts() const {
  std::vector<NetPlay::Start> all;
  for (const Source& source : sources_) {
    const auto& process = source.recording().process;
    all.push_back(process ? NetPlay::Start{.process = {process->number}, .incarnation = process->incarnation}
                          : NetPlay::Start{});
  }
  return all;
}

Judge::StartId AnyOrder::start_of(std::size_t recording, ProcessId) const {
  return {static_cast<std::uint32_t>(recording)};
}

Outcome AnyOrder::play() {
  waiting_.resize(net_.channel_count());
  for (std::size_t number = 0; number < sources_.size(); ++number) {
    const std::size_t first = lanes_.size();
    parts_.push_back({.first = first, .last = first + recording(number).instances.size()});
    parts_.back().next = recording(number).entries.begin();
    lanes_.resize(parts_.back().last + 1);
    for (std::size_t lane = first; lane < lanes_.size(); ++lane) lanes_[lane].recording = number;
  }
  if (recording(0).process) play_->start_system();
  for (std::size_t number = 0; number < sources_.size(); ++number)
    if (is_first(number))
      if (Outcome outcome = begin(number)) return outcome;
  for (bool goes_on = true; goes_on;) {
    while (!ready_.empty()) {
      const std::size_t lane = ready_.front();
      ready_.pop_front();
      if (Outcome outcome = play_lane(lane)) return outcome;
    }
    if (Outcome outcome = judge_rest(/*of_whole=*/false)) return outcome;
    if (Outcome outcome = give_up(goes_on)) return outcome;
  }
  return judge_rest(/*of_whole=*/true);
}

/// No other given start of its process comes before; they stand side by side.
bool AnyOrder::is_first(std::size_t number) const {
  return number == 0 || recording(number - 1).process->number != recording(number).process->number;
}

// ------------------------------------------------------------------------------------------------- parts

Outcome AnyOrder::begin(std::size_t number) {
  Part& part = parts_[number];
  const std::vector<Recording::Entry>& entries = recording(number).entries;
  part.begun = true;
  if (!lacks_beginning(recording(number))) return begin_part(number);
  part.is_whole = false;
  part.next = std::ranges::find_if(entries, is_known_marking, &Recording::Entry::event);
  if (part.next == entries.end())
    note((recording(number).process ? recording(number).process->name + ": " : "") +
         "its beginning is gone, and the marking after that is not known");
  return end_part(number);
}

Outcome AnyOrder::begin_part(std::size_t number) {
  Outcome outcome = load_part(number);
  if (outcome || parts_[number].unplayed > 0) return outcome;
  return end_part(number);
}

/// Fills the lanes up to the next marking.
Outcome AnyOrder::load_part(std::size_t number) {
  Part& part = parts_[number];
  const std::vector<Recording::Entry>& entries = recording(number).entries;
  part.is_whole = true;
  for (; part.next != entries.end() && !is_known_marking(part.next->event); ++part.next)
    if (Outcome outcome = take(number, *part.next)) return outcome;
  if (part.next == entries.end()) end_loading(number);
  if (part.guesses) guess_versions(part);
  ready_.push_back(part.last);  // the upper layers begin first
  for (std::size_t lane = part.first; lane < part.last; ++lane) ready_.push_back(lane);
  return {};
}

Outcome AnyOrder::take(std::size_t number, const Recording::Entry& entry) {
  const Event& event = entry.event;
  if (!is_counted(event)) return {};
  const Source& source = sources_[number];
  if (const auto wrong = source.stranger(event, net_)) return illegal(wrong->text);
  Part& part = parts_[number];
  Lane& lane = lanes_[std::min<std::size_t>(part.first + event.instance(), part.last)];
  const std::uint32_t due = lane.sequence.next;
  const Sequence::Turn turn = lane.sequence.follow(event);
  if (turn == Sequence::Turn::back) return illegal(source.twice(event));
  if (turn == Sequence::Turn::gap) {
    lane.gap = true;
    part.is_whole = false;
    part.lost += event.sequence - due;
    note(source.missing(event));
  }
  if (!is_played(event) || lane.gap) return {};
  if (lane.left.empty()) ++part.unplayed;
  lane.left.push_back(&entry);
  return {};
}

/// Lost events that were not missed in between are missed at the end of a subsystem.
void AnyOrder::end_loading(std::size_t number) {
  const Recording& run = recording(number);
  if (run.truncated || run.lost > parts_[number].lost) parts_[number].is_whole = false;
  if (run.truncated)
    note(fmt::format("the recording {}is cut off at its end",
                     run.process ? "of " + run.process->name + " " : ""));
  if (run.lost > 0)
    note(fmt::format("{} events of {} are missing", run.lost, run.process ? run.process->name : "the run"));
}

/// Behind a marking the first version of each channel is the lowest that is there.
void AnyOrder::guess_versions(const Part& part) {
  std::unordered_map<std::uint32_t, std::uint32_t> lowest;  // by channel
  for (std::size_t lane = part.first; lane <= part.last; ++lane)
    for (const Recording::Entry* entry : lanes_[lane].left) {
      const Event& event = entry->event;
      if (event.kind() != Event::Kind::firing || event.version == 0) continue;
      const ChannelId channel = channel_of(lanes_[lane].recording, event);
      if (!channel.valid() || net_[channel].networked || !play_->lacks_version(channel)) continue;
      const auto [first, is_new] = lowest.try_emplace(channel.value, event.version);
      if (!is_new && is_before(event.version, first->second)) first->second = event.version;
    }
  for (const auto& [channel, version] : lowest) play_->guess_version({channel}, version);
}

/// All of the part has been played, or given up.
Outcome AnyOrder::end_part(std::size_t number) {
  Part& part = parts_[number];
  const StartId whose = recording(number).process ? start_of(number, {}) : StartId{};
  do {
    if (!part.is_whole) {
      play_->assume_rest(start_of(number, {}));
      for (std::vector<std::size_t>& lanes : waiting_) wake(lanes);
    }
    if (part.next == recording(number).entries.end()) return end(number);
    const Recording::Entry& marking = *part.next++;
    const std::optional<Problem> wrong =
        part.is_whole ? play_->compare(marking.text, whose) : play_->start_from(marking.text, whose);
    if (wrong) return illegal(sources_[number].place_of(marking.event) + wrong->text);
    if (part.is_whole) {
      play_->confirm_versions(whose);
    } else {
      part.guesses = true;
      for (std::size_t lane = part.first; lane <= part.last; ++lane) {
        lanes_[lane].sequence.begun = false;
        lanes_[lane].gap = false;
      }
    }
    if (Outcome outcome = load_part(number)) return outcome;
  } while (part.unplayed == 0);
  return {};
}

/// All that is recorded of a start has been played.
Outcome AnyOrder::end(std::size_t number) {
  parts_[number].ended = true;
  const std::size_t next = number + 1;
  if (next == sources_.size() || is_first(next)) return {};
  play_->restart(start_of(next, {}));
  return begin(next);
}

// ------------------------------------------------------------------------------------------------- lanes

ChannelId AnyOrder::channel_of(std::size_t recording, const Event& event) const {
  if (event.kind() != Event::Kind::firing) return {};
  return net_[sources_[recording].transition(event)].channel;
}

void AnyOrder::wake(std::vector<std::size_t>& lanes) {
  std::ranges::copy(lanes, std::back_inserter(ready_));
  lanes.clear();
}

/// Plays as far as possible. A lane that waits for a channel of the firing is ready again.
Outcome AnyOrder::play_lane(std::size_t number) {
  Lane& lane = lanes_[number];
  Part& part = parts_[lane.recording];
  bool moved = false;
  while (!lane.left.empty()) {
    const Recording::Entry& entry = *lane.left.front();
    bool performed = true;
    if (Outcome outcome = perform(lane.recording, entry, performed)) return outcome;
    if (!performed) break;
    lane.left.pop_front();
    moved = true;
    if (const ChannelId channel = channel_of(lane.recording, entry.event); channel.valid())
      wake(waiting_[channel.value]);
  }
  // The upper layers and the subsystems wait for each other at the start and at the end only.
  if (moved && number == part.last)
    for (std::size_t other = part.first; other < part.last; ++other) ready_.push_back(other);
  if (!lane.left.empty()) {
    const ChannelId channel = channel_of(lane.recording, lane.left.front()->event);
    if (channel.valid()) waiting_[channel.value].push_back(number);
  } else if (moved) {
    ready_.push_back(part.last);
    if (--part.unplayed == 0) return end_part(lane.recording);
  }
  return {};
}

// ------------------------------------------------------------------------------------------------- the rest

/// The first event that no further event can make legal. of_whole: any that is left, since nothing more comes.
Outcome AnyOrder::judge_rest(bool of_whole) const {
  const Lane* wrong = nullptr;
  bool certain = false;
  for (const Lane& lane : lanes_) {
    if (lane.left.empty() || !parts_[lane.recording].begun) continue;
    const Event& event = lane.left.front()->event;
    const Obstacle found = play_->obstacle(firing_of(lane.recording, event));
    const bool never = found.kind == Obstacle::Kind::never || never_comes(found);
    const bool earlier = wrong == nullptr || event.time_ns < wrong->left.front()->event.time_ns;
    if (never == certain ? !earlier : !never) continue;
    wrong = &lane;
    certain = never;
  }
  if (wrong == nullptr || (!certain && !of_whole)) return {};
  return illegal(complaint(wrong->recording, wrong->left.front()->event));
}

/// The recording that it waits for is whole, and everything in it has been played.
bool AnyOrder::never_comes(const Obstacle& waits) const {
  const Part& awaited = parts_[waits.awaited.value];
  return awaited.is_whole && awaited.ended;
}

/// Leaves the parts that do not go on because events are missing in them. any: there were some.
Outcome AnyOrder::give_up(bool& any) {
  any = false;
  for (std::size_t number = 0; number < parts_.size(); ++number) {
    Part& part = parts_[number];
    const Event* first = nullptr;
    if (part.is_whole || !part.begun || part.unplayed == 0 || !waits_for_missing(part, first)) continue;
    note(sources_[number].missing(*first));
    for (std::size_t lane = part.first; lane <= part.last; ++lane) lanes_[lane].left.clear();
    part.unplayed = 0;
    any = true;
    if (Outcome outcome = end_part(number)) return outcome;
  }
  return {};
}

/// first: the earliest event that does not go on.
bool AnyOrder::waits_for_missing(const Part& part, const Event*& first) const {
  bool waits = false;
  for (std::size_t number = part.first; number <= part.last; ++number) {
    const Lane& lane = lanes_[number];
    if (lane.left.empty()) continue;
    const Event& event = lane.left.front()->event;
    const Firing firing = firing_of(lane.recording, event);
    const Obstacle found = play_->obstacle(firing);
    if (first == nullptr || event.time_ns < first->time_ns) first = &event;
    waits = waits || found.reason != Obstacle::Reason::version ||
            !is_left(part, net_[firing.transition].channel, found.due);
  }
  return waits;
}

/// Another firing of that channel, with that version, has not been played either.
bool AnyOrder::is_left(const Part& part, ChannelId channel, std::uint32_t version) const {
  return std::any_of(lanes_.begin() + static_cast<std::ptrdiff_t>(part.first),
                     lanes_.begin() + static_cast<std::ptrdiff_t>(part.last) + 1, [&](const Lane& lane) {
                       return std::ranges::any_of(lane.left, [&](const Recording::Entry* entry) {
                         return entry->event.version == version &&
                                channel_of(lane.recording, entry->event) == channel;
                       });
                     });
}

}  // namespace tessera::replay
