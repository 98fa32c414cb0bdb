#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "replay/deployed_net.hpp"
#include "replay/legality.hpp"
#include "replay/net_play.hpp"
#include "replay/source.hpp"

namespace tessera::replay {

/// Ends the play.
struct Judgement {
  Legality::Verdict verdict;
  std::string why;
};
/// nullopt: the play goes on.
using Outcome = std::optional<Judgement>;

/// The common part of both orders in which recordings are played on a net.
///
/// Threads: one at a time. Recordings, net and processes live longer.
class Judge {
 public:
  Judge(std::span<const Recording> recordings, const net::Net& net, const ProcessMap& processes);
  virtual ~Judge() = default;
  Judge(const Judge&) = delete;
  Judge& operator=(const Judge&) = delete;

  [[nodiscard]] Legality judge();

 protected:
  using StartId = NetPlay::StartId;
  using Firing = NetPlay::Firing;
  using Obstacle = NetPlay::Obstacle;

  /// Plays all that is given. nullopt: it is legal as far as it goes.
  [[nodiscard]] virtual Outcome play() = 0;
  /// The starts that are given, of each process in the order of their incarnations.
  [[nodiscard]] virtual std::vector<NetPlay::Start> starts() const = 0;
  /// The start of this process to which an event belongs; none: it is of the whole system.
  [[nodiscard]] virtual StartId start_of(std::size_t recording, ProcessId process) const = 0;

  [[nodiscard]] static Judgement illegal(std::string why) {
    return {Legality::Verdict::illegal, std::move(why)};
  }
  /// The run is incomplete at least. The first reason is told.
  void note(const std::string& what) {
    if (missing_.empty()) missing_ = what;
  }
  [[nodiscard]] const Recording& recording(std::size_t number) const { return sources_[number].recording(); }
  [[nodiscard]] Firing firing_of(std::size_t recording, const Event& event) const;
  [[nodiscard]] std::string complaint(std::size_t recording, const Event& event) const;
  /// Fires, or changes a peer. performed: false if something is in the way of the firing.
  [[nodiscard]] Outcome perform(std::size_t recording, const Recording::Entry& entry, bool& performed);

  /// A position in the sequence of the events of a subsystem, or of the upper layers.
  struct Sequence {
    std::uint32_t next = 0;
    bool begun = true;  ///< `next` is known
    enum class Turn : std::uint8_t { next, gap, back };
    [[nodiscard]] Turn follow(const Event& event);
  };

  const ProcessMap& processes_;
  DeployedNet net_;
  std::vector<Source> sources_;
  std::optional<NetPlay> play_;

 private:
  [[nodiscard]] std::optional<Problem> hear(std::size_t recording, const Recording::Entry& entry);
  [[nodiscard]] StartId start_that_hears(std::size_t recording, const Event& event,
                                         net::ChannelId channel) const;
  [[nodiscard]] Judgement of_the_end() const;

  std::unordered_map<std::string_view, std::uint32_t> channels_;  // by name
  std::optional<Problem> mismatch_;
  std::string missing_;  // what is missing first; empty: nothing
};

/// The order of the file: that of a run under the simulated clock.
class WrittenOrder final : public Judge {
 public:
  WrittenOrder(const Recording& run, const net::Net& net, const ProcessMap& processes);

 private:
  Outcome play() override;
  [[nodiscard]] std::vector<NetPlay::Start> starts() const override;
  [[nodiscard]] StartId start_of(std::size_t recording, ProcessId process) const override;
  [[nodiscard]] Outcome play(const Recording::Entry& entry);
  [[nodiscard]] Outcome play_marking(const Recording::Entry& entry);
  [[nodiscard]] Outcome begin_again(const Recording::Entry& entry);

  const Recording& run_;
  std::vector<Sequence> lanes_;           // per instance; the last of the upper layers
  Numbered<ProcessId, StartId> current_;  // the start of each process that runs now
  std::uint32_t begun_ = 0;               // starts so far
  std::int64_t last_ns_ = INT64_MIN;
  bool playing_;  // false: events are missing, up to the next marking
};

/// Any order that keeps those of each subsystem and of each channel. At the marking with which a segment of a
/// recording begins, all firings before it have happened and none of those after it. So it is played part by
/// part, and an incomplete part does not affect the next.
class AnyOrder final : public Judge {
 public:
  using Judge::Judge;

 private:
  /// The events of one subsystem, or of the upper layers, in one recording.
  struct Lane {
    std::deque<const Recording::Entry*> left;  ///< firings, and changes of peers, still to be played
    std::size_t recording = 0;
    Sequence sequence;
    bool gap = false;  ///< events are missing behind `left`
  };
  /// The progress in one recording.
  struct Part {
    std::size_t first = 0, last = 0;  ///< its lanes: one per subsystem, and the last of the upper layers
    std::vector<Recording::Entry>::const_iterator next{};  ///< the first entry of the next part: a marking
    std::size_t unplayed = 0;                              ///< lanes with events that have not been played
    std::uint64_t lost = 0;                                ///< missing in the sequences
    bool is_whole = true, begun = false, ended = false;
    bool guesses = false;  ///< versions of its channels may be unknown
  };

  Outcome play() override;
  [[nodiscard]] std::vector<NetPlay::Start> starts() const override;
  [[nodiscard]] StartId start_of(std::size_t recording, ProcessId process) const override;
  [[nodiscard]] bool is_first(std::size_t recording) const;
  [[nodiscard]] Outcome begin(std::size_t recording);
  [[nodiscard]] Outcome load_part(std::size_t recording);
  [[nodiscard]] Outcome take(std::size_t recording, const Recording::Entry& entry);
  void end_loading(std::size_t recording);
  void guess_versions(const Part& part);
  [[nodiscard]] Outcome begin_part(std::size_t recording);
  [[nodiscard]] Outcome end_part(std::size_t recording);
  [[nodiscard]] Outcome end(std::size_t recording);
  [[nodiscard]] Outcome play_lane(std::size_t number);
  void wake(std::vector<std::size_t>& lanes);
  [[nodiscard]] net::ChannelId channel_of(std::size_t recording, const Event& event) const;
  [[nodiscard]] Outcome judge_rest(bool of_whole) const;
  [[nodiscard]] Outcome give_up(bool& any);
  [[nodiscard]] bool waits_for_missing(const Part& part, const Event*& first) const;
  [[nodiscard]] bool is_left(const Part& part, net::ChannelId channel, std::uint32_t version) const;
  [[nodiscard]] bool never_comes(const Obstacle& waits) const;

  std::vector<Part> parts_;  // per recording
  std::vector<Lane> lanes_;
  std::deque<std::size_t> ready_;                  // lanes
  std::vector<std::vector<std::size_t>> waiting_;  // lanes, per channel
};

}  // namespace tessera::replay
