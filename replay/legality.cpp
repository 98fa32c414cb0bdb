#include "replay/legality.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <deque>
#include <optional>
#include <string_view>
#include <unordered_map>

namespace tessera::replay {
namespace {

using net::Arc;
using net::TransitionId;
using Verdict = Legality::Verdict;

constexpr std::uint32_t none = UINT32_MAX;
constexpr std::uint32_t system_instance = 0xffffff;

std::string seconds(std::int64_t time_ns) {
  return fmt::format("{:.6f} s", static_cast<double>(time_ns) * 1e-9);
}

/// The firings of one subsystem, or of the upper layers, that are still to be played.
struct Lane {
  std::deque<const Event*> events;
  std::uint32_t next_sequence = 0;
  bool gap = false;    ///< events are missing before the first of `events`
  bool begun = false;  ///< `next_sequence` is known
};

class Play {
 public:
  Play(const Recording& recording, const net::Net& net) : recording_(recording), net_(net) {
    for (const net::Place& place : net.places()) result_.marking.push_back(place.tokens);
  }

  Legality result() {
    if (match_transitions() && begin()) {
      if (recording_.ordered())
        play_as_written();
      else
        play_merged();
    }
    return std::move(result_);
  }

 private:
  void end(Verdict verdict, std::string why) {
    result_.verdict = verdict;
    result_.why = std::move(why);
  }

  /// Numbers of the recording to numbers of the net, and the channel that each transition touches.
  bool match_transitions() {
    std::unordered_map<std::string_view, std::uint32_t> by_name;
    for (std::uint32_t index = 0; index < net_.transitions().size(); ++index)
      by_name.emplace(net_.transitions()[index].name, index);
    std::uint32_t channels = 0;
    for (const Recording::TransitionName& recorded : recording_.transitions) {
      const auto found = by_name.find(recorded.name);
      if (found == by_name.end()) {
        end(Verdict::illegal, fmt::format("the net has no transition '{}'", recorded.name));
        return false;
      }
      const TransitionId id{found->second};
      transitions_.push_back(id);
      channels_.push_back(channel_of(id));
      if (channels_.back() != none) channels = std::max(channels, channels_.back() + 1);
    }
    versions_.resize(channels, 0);
    version_known_.resize(channels, !inside_);
    return true;
  }

  /// Of a recording whose first segments are gone the marking is written where the first that is left begins.
  bool begin() {
    if (!inside_) return true;
    const auto first = std::ranges::find_if(recording_.entries, [](const Recording::Entry& entry) {
      return entry.event.kind() == Event::Kind::marking;
    });
    if (first == recording_.entries.end() || first->event.version != 0) {
      end(Verdict::incomplete, "its beginning is gone, and the marking after that is not known");
      return false;
    }
    const std::optional<std::vector<std::uint32_t>> marking = read_marking(*first);
    if (marking) result_.marking = *marking;
    return marking.has_value();
  }

  /// nullopt after that has ended the check.
  std::optional<std::vector<std::uint32_t>> read_marking(const Recording::Entry& entry) {
    if (places_.empty())
      for (std::uint32_t index = 0; index < net_.places().size(); ++index)
        places_.emplace(net_.places()[index].name, index);
    std::vector<std::uint32_t> marking(net_.places().size(), 0);
    for (std::string_view left = entry.text; !left.empty();) {
      const std::string_view name = left.substr(0, left.find('\n'));
      left.remove_prefix(std::min(left.size(), name.size() + 1));
      const auto found = places_.find(name);
      if (found == places_.end()) {
        end(Verdict::illegal, fmt::format("{}: the marking names '{}', which is no place of the net",
                                          seconds(entry.event.time_ns), name));
        return std::nullopt;
      }
      marking[found->second] = 1;
    }
    return marking;
  }

  [[nodiscard]] std::uint32_t channel_of(TransitionId id) const {
    for (const auto& arcs : {net_.preset(id), net_.postset(id)})
      for (const Arc& arc : arcs)
        if (net_[arc.place].fused()) return net_[arc.place].channel;
    return none;
  }

  [[nodiscard]] std::uint32_t next_version(std::uint32_t channel) const {
    return versions_[channel] == UINT32_MAX ? 1 : versions_[channel] + 1;
  }

  /// Empty: the transition may fire now. Otherwise what it lacks.
  [[nodiscard]] std::string obstacle(const Event& event) const {
    const std::uint32_t channel = channels_[event.subject];
    if ((event.version != 0) != (channel != none)) return "it is recorded with the wrong kind of version";
    if (channel != none && version_known_[channel] && event.version != next_version(channel))
      return fmt::format("it is version {} of its channel, of which {} is due", event.version,
                         next_version(channel));
    for (const Arc& arc : net_.preset(transitions_[event.subject]))
      if (result_.marking[arc.place.value] < arc.weight)
        return fmt::format("'{}' holds no token", net_[arc.place].name);
    return {};
  }

  /// false: the firing puts a second token into a place, and that ends the play.
  bool fire(const Event& event) {
    const TransitionId id = transitions_[event.subject];
    if (const std::uint32_t channel = channels_[event.subject]; channel != none) {
      versions_[channel] = event.version;
      version_known_[channel] = true;
    }
    for (const Arc& arc : net_.preset(id)) result_.marking[arc.place.value] -= arc.weight;
    for (const Arc& arc : net_.postset(id)) {
      result_.marking[arc.place.value] += arc.weight;
      if (result_.marking[arc.place.value] <= 1) continue;
      end(Verdict::illegal, fmt::format("{}: '{}' puts a second token into '{}'", seconds(event.time_ns),
                                        net_[id].name, net_[arc.place].name));
      return false;
    }
    ++result_.firings;
    return true;
  }

  [[nodiscard]] std::string complaint(const Event& event, const std::string& lacks) const {
    return fmt::format("{}: '{}' fired, but {}", seconds(event.time_ns),
                       recording_.transitions[event.subject].name, lacks);
  }

  /// Keeps count of the events of an instance: false if some are missing before this one.
  bool in_sequence(Lane& lane, const Event& event) const {
    const bool whole = event.sequence == lane.next_sequence || (inside_ && !lane.begun);
    lane.begun = true;
    lane.next_sequence = event.sequence + 1;
    return whole;
  }

  [[nodiscard]] std::string gap(const Event& event) const {
    const std::uint32_t instance = event.instance();
    return fmt::format(
        "{}: events of {} are missing", seconds(event.time_ns),
        instance < recording_.instances.size() ? recording_.instances[instance] : "the upper layers");
  }

  void play_as_written() {
    std::unordered_map<std::uint32_t, Lane> lanes;
    std::int64_t last = INT64_MIN;
    for (const Recording::Entry& entry : recording_.entries) {
      const Event& event = entry.event;
      if (event.kind() == Event::Kind::marking) {
        if (!agrees_with(entry)) return;
        continue;
      }
      if (!in_sequence(lanes[event.instance()], event)) return end(Verdict::incomplete, gap(event));
      if (event.kind() != Event::Kind::firing) continue;
      if (event.time_ns < last && recording_.clock == "simulated")
        return end(Verdict::illegal, complaint(event, "time went back"));
      last = event.time_ns;
      if (const std::string lacks = obstacle(event); !lacks.empty()) {
        // Of threads, what it follows from may be among what is missing further on.
        if (const std::string missing = first_gap(); !missing.empty())
          return end(Verdict::incomplete, missing);
        return end(Verdict::illegal, complaint(event, lacks));
      }
      if (!fire(event)) return;
    }
    if (recording_.truncated) end(Verdict::incomplete, "the recording is cut off at its end");
  }

  /// The marking where a segment begins; false after that has ended the check.
  bool agrees_with(const Recording::Entry& entry) {
    if (entry.event.version != 0) return true;  // not known
    const std::optional<std::vector<std::uint32_t>> marking = read_marking(entry);
    if (!marking) return false;
    for (std::uint32_t place = 0; place < marking->size(); ++place) {
      if ((*marking)[place] == result_.marking[place]) continue;
      end(Verdict::illegal,
          fmt::format(
              "{}: a segment begins with another marking than the one before it ends with: '{}' holds "
              "{} tokens there",
              seconds(entry.event.time_ns), net_.places()[place].name, (*marking)[place]));
      return false;
    }
    return true;
  }

  [[nodiscard]] std::string first_gap() const {
    std::unordered_map<std::uint32_t, Lane> lanes;
    for (const Recording::Entry& entry : recording_.entries)
      if (entry.event.kind() != Event::Kind::marking &&
          !in_sequence(lanes[entry.event.instance()], entry.event))
        return gap(entry.event);
    return "";
  }

  // ------------------------------------------------------------------------------------------- threads

  /// Up to the first gap of each lane.
  void fill_lanes() {
    lanes_.resize(recording_.instances.size() + 1);
    for (const Recording::Entry& entry : recording_.entries) {
      Lane& lane = lanes_[lane_of(entry.event)];
      if (lane.gap) continue;
      lane.gap = !in_sequence(lane, entry.event);
      if (lane.gap) {
        if (missing_.empty()) missing_ = gap(entry.event);
      } else if (entry.event.kind() == Event::Kind::firing) {
        lane.events.push_back(&entry.event);
      }
    }
    if (missing_.empty() && recording_.truncated) missing_ = "the recording is cut off at its end";
  }

  [[nodiscard]] std::size_t lane_of(const Event& event) const {
    return event.instance() == system_instance ? recording_.instances.size() : event.instance();
  }

  void play_merged() {
    fill_lanes();
    std::vector<std::vector<std::size_t>> waiting(versions_.size());  // lanes, per channel
    std::deque<std::size_t> ready;
    ready.push_back(lanes_.size() - 1);  // t_in comes first
    for (std::size_t lane = 0; lane + 1 < lanes_.size(); ++lane) ready.push_back(lane);
    while (!ready.empty()) {
      const std::size_t number = ready.front();
      ready.pop_front();
      Lane& lane = lanes_[number];
      bool moved = false;
      while (!lane.events.empty() && obstacle(*lane.events.front()).empty()) {
        const Event& event = *lane.events.front();
        if (!fire(event)) return;
        lane.events.pop_front();
        moved = true;
        if (const std::uint32_t channel = channels_[event.subject]; channel != none)
          wake(waiting[channel], ready);
      }
      // The upper layers and the subsystems wait for each other at the start and at the end only.
      if (moved && lane.events.empty()) ready.push_back(lanes_.size() - 1);
      if (moved && number + 1 == lanes_.size())
        for (std::size_t other = 0; other + 1 < lanes_.size(); ++other) ready.push_back(other);
      if (!lane.events.empty())
        if (const std::uint32_t channel = channels_[lane.events.front()->subject]; channel != none)
          waiting[channel].push_back(number);
    }
    judge_rest();
  }

  static void wake(std::vector<std::size_t>& waiting, std::deque<std::size_t>& ready) {
    for (const std::size_t lane : waiting) ready.push_back(lane);
    waiting.clear();
  }

  /// A firing that could not be played is illegal, unless what it waits for may be among what is missing.
  void judge_rest() {
    const Event* first = nullptr;
    for (const Lane& lane : lanes_)
      if (!lane.events.empty() && (first == nullptr || lane.events.front()->time_ns < first->time_ns))
        first = lane.events.front();
    if (!missing_.empty()) return end(Verdict::incomplete, missing_);
    if (first != nullptr) end(Verdict::illegal, complaint(*first, obstacle(*first)));
  }

  const Recording& recording_;
  const net::Net& net_;
  Legality result_;
  std::vector<TransitionId> transitions_;                       // per transition of the recording
  std::vector<std::uint32_t> channels_;                         // per transition of the recording; none
  std::vector<std::uint32_t> versions_;                         // per channel, of the last firing
  std::vector<bool> version_known_;                             // per channel
  std::unordered_map<std::string_view, std::uint32_t> places_;  // by name; empty: not needed yet
  /// The recording begins with a later segment than the first.
  const bool inside_ = recording_.segment.value_or(0) > 0;
  std::vector<Lane> lanes_;  // per instance; the last of the upper layers
  std::string missing_;      // empty: nothing is
};

}  // namespace

Legality check_legal(const Recording& recording, const net::Net& net) {
  return Play(recording, net).result();
}

}  // namespace tessera::replay
