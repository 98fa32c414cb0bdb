#include "replay/joint_legality.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <deque>
#include <iterator>
#include <unordered_map>
#include <utility>
#include <vector>

#include "replay/joint_play.hpp"
#include "replay/joint_source.hpp"
#include "replay/net_play.hpp"
#include "replay/process_starts.hpp"

namespace tessera::replay {
namespace {

using net::ChannelId;
using net::TransitionId;
using StartId = JointPlay::StartId;
using JointVerdict = Legality::Verdict;
using Firing = JointPlay::Firing;
using Obstruction = JointPlay::Obstacle;

struct JointJudgement {
  JointVerdict verdict;
  std::string why;
};
using JointOutcome = std::optional<JointJudgement>;

/// The events of one subsystem, or of the upper layers, in one recording.
struct JointLane {
  std::deque<const Recording::Entry*> left;  ///< firings, and changes of peers
  std::size_t recording = 0;
  std::uint32_t next_sequence = 0;
  bool gap = false;  ///< events are missing behind `left`
};

class JointOrder {
 public:
  JointOrder(std::span<const Recording> recordings, const net::Net& net, const ProcessMap& processes)
      : processes_(processes), net_(net, processes), one_run_(!recordings.front().process) {
    std::unordered_map<std::string_view, std::uint32_t> transitions;
    for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
      transitions.emplace(net.transitions()[index].name, index);
    for (std::uint32_t index = 0; index < net.parts().channels.size(); ++index)
      channels_.emplace(net.parts().channels[index], index);
    for (const Recording* recording : in_order(recordings)) {
      sources_.emplace_back(*recording);
      if (!mismatch_) mismatch_ = sources_.back().match(net, transitions);
    }
    play_.emplace(net_, starts(), one_run_);
  }

  JointJudgement judge() {
    if (mismatch_) return illegal(mismatch_->text);
    JointOutcome outcome = one_run_ ? play_as_written() : play_any_order();
    return outcome ? *outcome : of_the_end();
  }
  [[nodiscard]] std::uint64_t firings() const { return play_->firings(); }

 private:
  static JointJudgement illegal(std::string why) { return {JointVerdict::illegal, std::move(why)}; }
  static JointJudgement incomplete(std::string why) { return {JointVerdict::incomplete, std::move(why)}; }

  /// For a run of one process: the start with the number of its recording; for a simulated run: one per
  /// process.
  std::vector<JointPlay::Start> starts() {
    std::vector<JointPlay::Start> all;
    if (one_run_)
      for (const ProcessId process : processes_.names.ids())
        all.push_back({.process = process, .incarnation = 1});
    else
      for (const JointSource& source : sources_)
        all.push_back({.process = {source.recording().process->number},
                       .incarnation = source.recording().process->incarnation});
    return all;
  }

  // ------------------------------------------------------------------------------------------ events

  /// In one run a start has the number of its process, otherwise that of its recording.
  [[nodiscard]] StartId start_of(std::size_t recording, ProcessId process) const {
    return {one_run_ ? process.value : static_cast<std::uint32_t>(recording)};
  }
  [[nodiscard]] Firing firing_of(std::size_t recording, const Event& event) const {
    const TransitionId id = sources_[recording].transition(event);
    return {.transition = id, .start = start_of(recording, net_[id].process), .version = event.version};
  }

  /// Fires, or changes a peer. nullopt: done. Precondition of a firing: no obstacle.
  JointOutcome perform(std::size_t recording, const Recording::Entry& entry) {
    const std::optional<Problem> wrong = entry.event.kind() == Event::Kind::peer
                                             ? hear(recording, entry)
                                             : play_->fire(firing_of(recording, entry.event));
    if (!wrong) return {};
    return illegal(sources_[recording].place_of(entry.event) + wrong->text);
  }

  std::optional<Problem> hear(std::size_t recording, const Recording::Entry& entry) {
    const std::string_view text = entry.text;
    const std::size_t line = std::min(text.find('\n'), text.size());
    const auto channel = channels_.find(text.substr(0, line));
    std::uint64_t incarnation = 0;
    const char* end = text.data() + text.size();
    const bool is_number = line < text.size() &&
                           std::from_chars(text.data() + line + 1, end, incarnation).ptr == end &&
                           incarnation != 0;
    if (channel == channels_.end() || !is_number)
      return Problem{fmt::format("'{}' is no peer of a channel", text)};
    return play_->hear({channel->second}, start_of_lane(recording, entry.event, {channel->second}),
                       incarnation);
  }

  /// The start whose side of the channel hears.
  [[nodiscard]] StartId start_of_lane(std::size_t recording, const Event& event, ChannelId channel) const {
    const DeployedNet::Channel& ends = net_[channel];
    const bool sends = ends.sender.valid() && event.instance() != system_instance &&
                       net_.net().parts()[ends.sender].path == sources_[recording].path_of(event);
    return start_of(recording, sends ? ends.sending : ends.receiving);
  }

  enum class Turn : std::uint8_t { next, gap, back };
  static Turn follow(JointLane& lane, const Event& event) {
    const std::uint32_t due = std::exchange(lane.next_sequence, event.sequence + 1);
    if (event.sequence == due) return Turn::next;
    return is_before(event.sequence, due) ? Turn::back : Turn::gap;
  }
  // ------------------------------------------------------------------------------------ simulated clock

  JointOutcome play_as_written() {
    const Recording& run = sources_.front().recording();
    if (lacks_beginning(run)) return incomplete("its beginning is gone: nothing was checked");
    std::vector<JointLane> lanes(run.instances.size() + 1);
    std::int64_t last_ns = INT64_MIN;
    for (const Recording::Entry& entry : run.entries) {
      const Event& event = entry.event;
      if (!is_counted(event)) continue;
      const Turn turn = follow(lanes[std::min<std::size_t>(event.instance(), run.instances.size())], event);
      if (turn == Turn::back) return illegal(sources_[0].twice(event));
      if (turn == Turn::gap) return incomplete(sources_[0].missing(event));
      if (!is_played(event)) continue;
      if (event.time_ns < std::exchange(last_ns, event.time_ns))
        return illegal(sources_.front().place_of(event) + "an event is recorded there, but time went back");
      if (JointOutcome outcome = play_next(entry)) return outcome;
    }
    return {};
  }

  JointOutcome play_next(const Recording::Entry& entry) {
    if (const auto wrong = sources_.front().stranger(entry.event, net_)) return illegal(wrong->text);
    if (entry.event.kind() == Event::Kind::firing) {
      const Firing firing = firing_of(0, entry.event);
      if (const Obstruction found = play_->obstacle(firing); found.kind != Obstruction::Kind::no)
        return illegal(sources_.front().place_of(entry.event) + play_->complaint(firing, found));
    }
    return perform(0, entry);
  }

  // ---------------------------------------------------------------------------------- several processes

  JointOutcome play_any_order() {
    for (std::size_t recording = 0; recording < sources_.size(); ++recording)
      if (JointOutcome outcome = load(recording)) return outcome;
    waiting_.resize(net_.channel_count());
    play_->start_system();
    for (std::size_t recording = 0; recording < sources_.size(); ++recording)
      if (is_first(recording)) begin(recording);
    do {
      while (!ready_.empty()) {
        const std::size_t lane = ready_.front();
        ready_.pop_front();
        if (JointOutcome outcome = play_lane(lane)) return outcome;
      }
      if (JointOutcome outcome = judge_rest(/*of_whole=*/false)) return outcome;
    } while (give_up());
    return judge_rest(/*of_whole=*/true);
  }

  /// Recordings with missing events that do not go on: what they wait for may be missing. false: there are none.
  bool give_up() {
    bool any = false;
    for (std::size_t recording = 0; recording < parts_.size(); ++recording) {
      Part& part = parts_[recording];
      if (part.is_whole || !part.begun || part.unplayed == 0) continue;
      for (std::size_t lane = part.first; lane <= part.last; ++lane) lanes_[lane].left.clear();
      part.unplayed = 0;
      any = true;
      end(recording);
    }
    return any;
  }

  /// Makes its lanes: one per subsystem, and the last of the upper layers.
  JointOutcome load(std::size_t recording) {
    const Recording& run = sources_[recording].recording();
    parts_.push_back({.first = lanes_.size(), .last = lanes_.size() + run.instances.size()});
    lanes_.resize(parts_.back().last + 1);
    for (std::size_t lane = parts_.back().first; lane <= parts_.back().last; ++lane)
      lanes_[lane].recording = recording;
    if (lacks_beginning(run)) {
      note(fmt::format("the beginning of the recording of {} is gone, and nothing of it was checked",
                       run.process->name));
      parts_.back().is_whole = false;
      return {};
    }
    for (const Recording::Entry& entry : run.entries)
      if (JointOutcome outcome = take(recording, entry)) return outcome;
    finish_loading(recording);
    return {};
  }

  JointOutcome take(std::size_t recording, const Recording::Entry& entry) {
    const Event& event = entry.event;
    if (!is_counted(event)) return {};
    Part& part = parts_[recording];
    JointLane& lane = lanes_[std::min<std::size_t>(part.first + event.instance(), part.last)];
    const Turn turn = follow(lane, event);
    if (turn == Turn::back) return illegal(sources_[recording].twice(event));
    if (turn == Turn::gap) {
      lane.gap = true;
      part.is_whole = false;
      note(sources_[recording].missing(event));
    }
    if (!is_played(event) || lane.gap) return {};
    if (const auto wrong = sources_[recording].stranger(event, net_)) return illegal(wrong->text);
    if (lane.left.empty()) ++part.unplayed;
    lane.left.push_back(&entry);
    return {};
  }

  void finish_loading(std::size_t recording) {
    const Recording& run = sources_[recording].recording();
    if (run.truncated)
      note(fmt::format("the recording of {} is cut off at its end", run.process->name));
    else if (run.lost > 0)
      note(fmt::format("{} events of {} are missing", run.lost, run.process->name));
    if (run.truncated || run.lost > 0) parts_[recording].is_whole = false;
  }

  void note(const std::string& what) {
    if (missing_.empty()) missing_ = what;
  }

  /// No other given start of its process comes before; they stand side by side.
  [[nodiscard]] bool is_first(std::size_t recording) const {
    return recording == 0 || !are_of_one(recording - 1, recording);
  }
  [[nodiscard]] bool are_of_one(std::size_t recording, std::size_t next) const {
    return sources_[recording].recording().process->number == sources_[next].recording().process->number;
  }

  void begin(std::size_t recording) {
    Part& part = parts_[recording];
    part.begun = true;
    ready_.push_back(part.last);  // the agents begin first
    for (std::size_t lane = part.first; lane < part.last; ++lane) ready_.push_back(lane);
    if (part.unplayed == 0) end(recording);
  }

  /// All that is recorded of a start has been played.
  void end(std::size_t recording) {
    if (!parts_[recording].is_whole) {
      play_->assume_rest(start_of(recording, {}));
      for (std::vector<std::size_t>& lanes : waiting_) {
        std::ranges::copy(lanes, std::back_inserter(ready_));
        lanes.clear();
      }
    }
    const std::size_t next = recording + 1;
    if (next == sources_.size() || !are_of_one(recording, next)) return;
    play_->restart(start_of(next, {}));
    begin(next);
  }

  /// Plays as far as possible. A process that waits for a channel of the firing is ready again.
  JointOutcome play_lane(std::size_t number) {
    JointLane& lane = lanes_[number];
    Part& part = parts_[lane.recording];
    bool moved = false;
    while (!lane.left.empty()) {
      const Recording::Entry& entry = *lane.left.front();
      if (entry.event.kind() == Event::Kind::firing &&
          play_->obstacle(firing_of(lane.recording, entry.event)).kind != Obstruction::Kind::no)
        break;
      if (JointOutcome outcome = perform(lane.recording, entry)) return outcome;
      lane.left.pop_front();
      moved = true;
      wake(lane.recording, entry.event);
    }
    if (moved && number == part.last)
      for (std::size_t other = part.first; other < part.last; ++other) ready_.push_back(other);
    if (!lane.left.empty()) {
      wait(number);
    } else if (moved) {
      ready_.push_back(part.last);
      if (--part.unplayed == 0) end(lane.recording);
    }
    return {};
  }

  void wake(std::size_t recording, const Event& event) {
    if (event.kind() != Event::Kind::firing) return;
    const ChannelId channel = net_[sources_[recording].transition(event)].channel;
    if (!channel.valid()) return;
    std::ranges::copy(waiting_[channel.value], std::back_inserter(ready_));
    waiting_[channel.value].clear();
  }

  void wait(std::size_t number) {
    const JointLane& lane = lanes_[number];
    const ChannelId channel = net_[sources_[lane.recording].transition(lane.left.front()->event)].channel;
    if (channel.valid()) waiting_[channel.value].push_back(number);
  }

  /// The events that no further event can make legal. of_whole: also those that wait for a complete
  /// recording.
  JointOutcome judge_rest(bool of_whole) {
    const JointLane* wrong = nullptr;
    bool certain = false;
    for (const JointLane& lane : lanes_) {
      if (lane.left.empty() || !parts_[lane.recording].begun) continue;
      const Obstruction found = play_->obstacle(firing_of(lane.recording, lane.left.front()->event));
      const bool never = found.kind == Obstruction::Kind::never || never_comes(found);
      if (wrong != nullptr && (certain || !never)) continue;
      wrong = &lane;
      certain = never;
    }
    if (wrong == nullptr || (!certain && !of_whole)) return {};
    const Event& event = wrong->left.front()->event;
    const Firing firing = firing_of(wrong->recording, event);
    return illegal(sources_[wrong->recording].place_of(event) +
                   play_->complaint(firing, play_->obstacle(firing)));
  }

  /// The recording that it waits for is whole, and everything in it has been played.
  [[nodiscard]] bool never_comes(const Obstruction& waits) const {
    const Part& awaited = parts_[waits.awaited.value];
    return awaited.is_whole && awaited.unplayed == 0 && awaited.begun;
  }

  [[nodiscard]] JointJudgement of_the_end() const {
    const Recording& first = sources_.front().recording();
    if (one_run_ && first.truncated) return incomplete("the recording is cut off at its end");
    if (one_run_ && first.lost > 0)
      return incomplete(fmt::format("{} events of the run are missing", first.lost));
    if (!missing_.empty()) return incomplete(missing_);
    if (const std::string names = not_given(); !names.empty())
      return incomplete(fmt::format("no recording of {} is given: what it did is assumed", names));
    if (!play_->unknown_peer().empty())
      return incomplete(
          fmt::format("no recording of {} is given: what it did is assumed", play_->unknown_peer()));
    return {JointVerdict::legal, ""};
  }

  [[nodiscard]] std::string not_given() const {
    std::vector<bool> given(processes_.names.size(), one_run_);
    for (const JointSource& source : sources_)
      if (source.recording().process) given[source.recording().process->number] = true;
    return names_without(processes_, given);
  }

  /// The lanes of one recording.
  struct Part {
    std::size_t first = 0, last = 0;
    std::size_t unplayed = 0;  ///< lanes with events that have not been played
    bool is_whole = true, begun = false;
  };

  const ProcessMap& processes_;
  DeployedNet net_;
  bool one_run_;  // of the whole system, under the simulated clock
  std::unordered_map<std::string_view, std::uint32_t> channels_;
  std::vector<JointSource> sources_;
  std::optional<Problem> mismatch_;
  std::string missing_;
  std::optional<JointPlay> play_;
  std::vector<Part> parts_;  // per recording
  std::vector<JointLane> lanes_;
  std::deque<std::size_t> ready_;                  // lanes
  std::vector<std::vector<std::size_t>> waiting_;  // lanes, per channel
};

}  // namespace

Legality check_joint(std::span<const Recording> recordings, const net::Net& net,
                     const ProcessMap& processes) {
  const Recording& first = recordings.front();
  if (recordings.size() == 1 && !first.process && !lacks_beginning(first) && has_deaths(first))
    return check_joint(recordings_of_starts(first, DeployedNet(net, processes), processes), net, processes);
  JointOrder order(recordings, net, processes);
  auto [verdict, why] = order.judge();
  return {.verdict = verdict, .why = std::move(why), .firings = order.firings(), .marking = {}};
}

}  // namespace tessera::replay
