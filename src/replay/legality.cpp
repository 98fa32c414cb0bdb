#include "replay/legality.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <deque>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "replay/net_play.hpp"

namespace tessera::replay {
namespace {

using Verdict = Legality::Verdict;
using Obstacle = NetPlay::Obstacle;

/// Ends the play.
struct Judgement {
  Verdict verdict;
  std::string why;
};

/// The events of one subsystem, or of the upper layers, in their order.
struct Player {
  std::deque<const Event*> firings;  ///< still to be played
  std::uint32_t next_sequence = 0;
  bool begun = true;  ///< `next_sequence` is known
  bool gap = false;   ///< events are missing behind `firings`
};

/// The common part of both kinds of recordings. Methods that return a judgement return nullopt to go on.
class Play {
 public:
  Play(const Recording& recording, NetPlay& net)
      : recording_(recording), net_(net), lanes_(recording.instances.size() + 1) {}

 protected:
  using Entries = std::vector<Recording::Entry>;
  using Outcome = std::optional<Judgement>;

  static Judgement illegal(std::string why) { return {Verdict::illegal, std::move(why)}; }
  static Judgement incomplete(std::string why) { return {Verdict::incomplete, std::move(why)}; }

  /// Finds the entry to begin with. If the first segments of a recording are gone, this is the entry after
  /// the marking with which the first remaining segment begins.
  Outcome begin(Entries::const_iterator& from) {
    from = recording_.entries.begin();
    if (!lacks_beginning(recording_)) return {};
    from = std::ranges::find_if(recording_.entries, [](const Recording::Entry& entry) {
      return entry.event.kind() == Event::Kind::marking;
    });
    if (from == recording_.entries.end() || from->event.version != 0)
      return incomplete("its beginning is gone, and the marking after that is not known");
    return start_from(*from++);
  }

  Outcome start_from(const Recording::Entry& entry) {
    std::string wrong;
    auto marking = net_.read_marking(entry, wrong);
    if (!marking) return illegal(wrong);
    net_.start_from(std::move(*marking));
    for (Player& lane : lanes_) lane = {.firings = {}, .begun = false};
    return {};
  }

  /// The marking where a segment begins is that of the end of the one before.
  Outcome compare(const Recording::Entry& entry) {
    std::string wrong;
    const auto marking = net_.read_marking(entry, wrong);
    if (!marking) return illegal(wrong);
    const net::PlaceId place = net_.difference(*marking);
    if (!place.valid()) return {};
    return illegal(fmt::format(
        "{}: a segment begins with another marking than the one before it ends with: '{}' holds {} tokens "
        "there",
        seconds_text(entry.event.time_ns), net_.place_name(place), (*marking)[place.value]));
  }

  [[nodiscard]] Player& lane_of(const Event& event) {
    return event.instance() == system_instance ? lanes_.back() : lanes_[event.instance()];
  }

  /// A firing of a subsystem that the transition does not belong to.
  [[nodiscard]] Outcome stranger(const Event& event) const {
    if (event.kind() != Event::Kind::firing) return {};
    const Recording::Transition& transition = recording_.transitions[event.subject];
    if (transition.instance == event.instance()) return {};
    return illegal(fmt::format("{}: '{}' fired in {}, which does not have it", seconds_text(event.time_ns),
                               transition.name, path_of(event)));
  }

  enum class Sequence : std::uint8_t { next, gap, back };
  /// Keeps count of the events of a lane.
  static Sequence follow(Player& lane, const Event& event) {
    const bool begun = std::exchange(lane.begun, true);
    const std::uint32_t due = std::exchange(lane.next_sequence, event.sequence + 1);
    if (!begun || event.sequence == due) return Sequence::next;
    return is_before(event.sequence, due) ? Sequence::back : Sequence::gap;
  }

  [[nodiscard]] std::string path_of(const Event& event) const {
    return event.instance() == system_instance ? "the upper layers" : recording_.instances[event.instance()];
  }
  [[nodiscard]] std::string gap_before(const Event& event) const {
    return fmt::format("{}: events of {} are missing", seconds_text(event.time_ns), path_of(event));
  }
  [[nodiscard]] std::string back_at(const Event& event) const {
    return fmt::format("{}: an event of {} is there twice, or not in its place", seconds_text(event.time_ns),
                       path_of(event));
  }

  /// The judgement of a recording without illegal firings.
  [[nodiscard]] Judgement of_the_end() const {
    if (recording_.truncated) return incomplete("the recording is cut off at its end");
    if (recording_.lost > 0)
      return incomplete(fmt::format("{} events of the run are missing", recording_.lost));
    return {Verdict::legal, ""};
  }

  const Recording& recording_;
  NetPlay& net_;
  std::vector<Player> lanes_;  // per instance; the last of the upper layers
};

// ------------------------------------------------------------------------------------------- simulated clock

/// The order of the file is that of the firings.
class WrittenOrder : Play {
 public:
  using Play::Play;

  Judgement judge() {
    Entries::const_iterator entry;
    Outcome outcome = begin(entry);
    for (; !outcome && entry != recording_.entries.end(); ++entry) outcome = play(*entry);
    if (!outcome) outcome = gap_;
    return outcome.value_or(of_the_end());
  }

 private:
  Outcome play(const Recording::Entry& entry) {
    const Event& event = entry.event;
    if (event.kind() == Event::Kind::marking) return event.version == 0 && !gap_ ? compare(entry) : Outcome();
    if (event.kind() == Event::Kind::poses) return {};  // not counted
    if (Outcome outcome = stranger(event)) return outcome;
    const Sequence sequence = follow(lane_of(event), event);
    if (sequence == Sequence::back) return illegal(back_at(event));
    if (sequence == Sequence::gap && !gap_) gap_ = incomplete(gap_before(event));
    if (gap_ || event.kind() != Event::Kind::firing) return {};
    if (event.time_ns < std::exchange(last_ns_, event.time_ns))
      return illegal(fmt::format("{}: '{}' fired, but time went back", seconds_text(event.time_ns),
                                 recording_.transitions[event.subject].name));
    if (const Obstacle obstacle = net_.obstacle(event); obstacle.kind != Obstacle::Kind::no)
      return illegal(net_.complaint(event, obstacle));
    if (const std::optional<Problem> wrong = net_.fire(event)) return illegal(wrong->text);
    return {};
  }

  std::int64_t last_ns_ = INT64_MIN;
  Outcome gap_;  // behind it nothing is played
};

// ------------------------------------------------------------------------------------------------- threads

/// Any order is allowed that keeps those of each subsystem and of each channel. At the start of a segment,
/// all firings before it have happened and none of those after it: so it is played part by part, and an
/// incomplete part does not affect the next.
class AnyOrder : Play {
 public:
  using Play::Play;

  Judgement judge() {
    Entries::const_iterator entry;
    Outcome outcome = begin(entry);
    for (; !outcome && entry != recording_.entries.end(); ++entry)
      outcome = entry->event.kind() == Event::Kind::marking ? end_part(*entry) : take(entry->event);
    // Lost events that were not missed in between are missed at the end of a subsystem.
    if (!outcome) outcome = play_part(recording_.truncated || recording_.lost > known_lost_);
    if (outcome) return *outcome;
    return missing_.empty() ? of_the_end() : incomplete(missing_);
  }

 private:
  Outcome take(const Event& event) {
    if (event.kind() == Event::Kind::poses) return {};  // not counted
    if (Outcome outcome = stranger(event)) return outcome;
    Player& lane = lane_of(event);
    const std::uint32_t due = lane.next_sequence;
    const Sequence sequence = follow(lane, event);
    if (sequence == Sequence::back) return illegal(back_at(event));
    if (sequence == Sequence::gap) {
      lane.gap = true;
      known_lost_ += event.sequence - due;
      note_missing(gap_before(event));
    }
    if (event.kind() == Event::Kind::firing && !lane.gap) lane.firings.push_back(&event);
    return {};
  }

  void note_missing(const std::string& what) {
    if (missing_.empty()) missing_ = what;
    part_is_whole_ = false;
  }

  /// marking: of the next part. When the writer could not tell it, that is no end of a part.
  Outcome end_part(const Recording::Entry& marking) {
    if (marking.event.version != 0) return {};
    if (Outcome outcome = play_part(/*is_cut=*/false)) return outcome;
    if (!std::exchange(part_is_whole_, true)) return start_from(marking);
    net_.confirm_versions();
    return compare(marking);
  }

  Outcome play_part(bool is_cut) {
    find_versions();
    std::vector<std::vector<std::size_t>> waiting(net_.channels());  // lanes, per channel
    std::deque<std::size_t> ready;
    ready.push_back(lanes_.size() - 1);  // t_in comes first
    for (std::size_t lane = 0; lane + 1 < lanes_.size(); ++lane) ready.push_back(lane);
    while (!ready.empty()) {
      const std::size_t number = ready.front();
      ready.pop_front();
      bool moved = false;
      if (Outcome outcome = play_lane(lanes_[number], moved, waiting, ready)) return outcome;
      // The upper layers and the subsystems wait for each other at the start and at the end only.
      if (moved && lanes_[number].firings.empty()) ready.push_back(lanes_.size() - 1);
      if (moved && number + 1 == lanes_.size())
        for (std::size_t other = 0; other + 1 < lanes_.size(); ++other) ready.push_back(other);
      if (lanes_[number].firings.empty()) continue;
      const net::ChannelId channel = net_.channel_of(*lanes_[number].firings.front());
      if (channel.valid()) waiting[channel.value].push_back(number);
    }
    return judge_rest(is_cut);
  }

  /// Plays as far as possible. A subsystem that waits for a channel of the firing is ready again.
  Outcome play_lane(Player& lane, bool& moved, std::vector<std::vector<std::size_t>>& waiting,
                    std::deque<std::size_t>& ready) {
    while (!lane.firings.empty() && net_.obstacle(*lane.firings.front()).kind == Obstacle::Kind::no) {
      const Event& event = *lane.firings.front();
      if (const auto wrong = net_.fire(event)) return illegal(wrong->text);
      lane.firings.pop_front();
      moved = true;
      if (const net::ChannelId channel = net_.channel_of(event); channel.valid()) {
        std::ranges::copy(waiting[channel.value], std::back_inserter(ready));
        waiting[channel.value].clear();
      }
    }
    return {};
  }

  /// Behind a marking the first of each channel is the lowest that is there.
  void find_versions() {
    std::vector<std::uint32_t> lowest(net_.channels(), 0);  // 0: none
    for (const Player& lane : lanes_)
      for (const Event* event : lane.firings) {
        const net::ChannelId channel = net_.channel_of(*event);
        if (!channel.valid() || net_.knows_version(channel) || event->version == 0) continue;
        if (std::uint32_t& first = lowest[channel.value]; first == 0 || is_before(event->version, first))
          first = event->version;
      }
    for (std::uint32_t channel = 0; channel < lowest.size(); ++channel)
      if (lowest[channel] != 0) net_.guess_version({channel}, lowest[channel]);
  }

  /// A firing that could not be played is illegal, unless what it waits for may be among what is missing.
  Outcome judge_rest(bool is_cut) {
    const Event *first = nullptr, *never = nullptr;
    bool waits_for_missing = false;
    for (const Player& lane : lanes_) {
      if (lane.firings.empty()) continue;
      const Event* event = lane.firings.front();
      const Obstacle obstacle = net_.obstacle(*event);
      if (first == nullptr || event->time_ns < first->time_ns) first = event;
      const bool is_never = obstacle.kind == Obstacle::Kind::never;
      if (is_never && (never == nullptr || event->time_ns < never->time_ns)) never = event;
      waits_for_missing = waits_for_missing || obstacle.kind == Obstacle::Kind::token ||
                          (obstacle.kind == Obstacle::Kind::version && !is_left(*event, obstacle.due));
    }
    if (first == nullptr) return {};
    if (never == nullptr && waits_for_missing && (is_cut || !part_is_whole_)) {
      if (!recording_.truncated) note_missing(gap_before(*first));
      part_is_whole_ = false;
      return {};
    }
    const Event& wrong = never == nullptr ? *first : *never;
    return illegal(net_.complaint(wrong, net_.obstacle(wrong)));
  }

  /// Another firing of its channel, with that version, has not been played either.
  [[nodiscard]] bool is_left(const Event& firing, std::uint32_t version) const {
    return std::ranges::any_of(lanes_, [&](const Player& lane) {
      return std::ranges::any_of(lane.firings, [&](const Event* event) {
        return net_.channel_of(*event) == net_.channel_of(firing) && event->version == version;
      });
    });
  }

  std::uint64_t known_lost_ = 0;  // missing in the sequences
  std::string missing_;           // what is missing first; empty: nothing
  bool part_is_whole_ = true;     // nothing is missing since the last marking
};

}  // namespace

Legality check_legal(const Recording& recording, const net::Net& net) {
  NetPlay play(recording, net);
  const auto judge = [&]() -> Judgement {
    if (play.mismatch()) return {Verdict::illegal, play.mismatch()->text};
    return recording.clock == "simulated" ? WrittenOrder(recording, play).judge()
                                          : AnyOrder(recording, play).judge();
  };
  auto [verdict, why] = judge();
  return {.verdict = verdict, .why = std::move(why), .firings = play.firings(), .marking = play.marking()};
}

}  // namespace tessera::replay
