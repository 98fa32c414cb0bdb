#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "net/net.hpp"
#include "net/token_game.hpp"
#include "replay/deployed_net.hpp"
#include "tessera/result.hpp"

namespace tessera::replay {

/// The token game of a net, played with the firings of one or several processes: nothing of the runtime's own
/// firing is used.
///
/// The places of one process hold tokens as usual, and the versions of a channel within it follow each other.
/// Nobody records what the medium of a channel between processes does, so the play keeps the set of markings
/// that its shared places may have. The numbers of the values say what comes before what: a value is written
/// before it is read, and its read ends before its sender knows of it.
///
/// Threads: one at a time.
class NetPlay {
 public:
  using StartId = Id<struct StartTag>;  ///< of the starts that are given
  /// One start of a process whose recording is given.
  struct Start {
    ProcessId process{0};
    std::uint64_t incarnation = 1;
  };

  /// starts: of each process in the order of their incarnations. one_run: they are of one run in one
  /// recording. If each process starts once in it, its peers are known.
  NetPlay(const DeployedNet& net, std::vector<Start> starts, bool one_run);

  struct Firing {
    net::TransitionId transition{};
    StartId start{};            ///< of the process that fired; none: the whole system
    std::uint32_t version = 0;  ///< as recorded: of a word, or the number of a value
  };
  /// Why a firing cannot be the next.
  struct Obstacle {
    enum class Kind : std::uint8_t {
      no,     ///< nothing: it can
      never,  ///< whatever others do
      waits   ///< for another firing
    } kind = Kind::no;
    enum class Reason : std::uint8_t {
      token,          ///< `place` holds none
      version,        ///< `due` of its channel comes first
      number,         ///< it carries another number than `due`
      no_number,      ///< it carries one, or none, and should not
      read_already,   ///< the value `due`, or a newer one, was read before
      taken_already,  ///< the value was acknowledged to its sender by an earlier start of the reader
      no_peer,        ///< the recording does not name its sender
      unwritten,      ///< the value has not been written
      untaken         ///< the value has not been taken
    } reason = Reason::token;
    net::PlaceId place{};
    std::uint32_t due = 0;
    StartId awaited{};  ///< the start that has to go on
  };
  [[nodiscard]] Obstacle obstacle(const Firing& firing) const;
  /// "'robot.control.follow.t1' fired, but 'robot.control.follow.in' holds no token".
  [[nodiscard]] std::string complaint(const Firing& firing, const Obstacle& obstacle) const;
  /// Fires. Returns what is wrong afterwards. Precondition: no obstacle.
  [[nodiscard]] std::optional<Problem> fire(const Firing& firing);

  /// From here on a side of a channel hears this incarnation of the other process. Returns what is wrong.
  [[nodiscard]] std::optional<Problem> hear(net::ChannelId channel, StartId start, std::uint64_t incarnation);
  /// The transition of the system that starts all agents; no process records it.
  void start_system();
  /// The rest of what this start did is not known: whatever others need of it, it has done.
  void assume_rest(StartId start) { assumed_[start] = true; }
  /// A process begins again: what it held is gone. Its start before has been played.
  void restart(StartId start);

  /// The marking where a segment of the recording of a start begins, "PLACE\nPLACE...", differs from that of
  /// the places of its process, or names a place that is not there. nullopt: it is the same.
  /// start: none: of all processes.
  [[nodiscard]] std::optional<Problem> compare(std::string_view marking, StartId start);
  /// Continues with this marking, after events that are missing. The versions and numbers of the channels are
  /// then not known, nor are the tokens between the processes.
  [[nodiscard]] std::optional<Problem> start_from(std::string_view marking, StartId start);
  /// Is it of a channel within a process, of which no version is known?
  [[nodiscard]] bool lacks_version(net::ChannelId channel) const {
    return versions_[channel.value].is == Version::unknown;
  }
  /// The next firing of the channel carries this version, if none is missing.
  void guess_version(net::ChannelId channel, std::uint32_t version);
  /// No firing of the process was missing: its guessed versions are right.
  void confirm_versions(StartId start);

  [[nodiscard]] const net::Marking& marking() const { return marking_; }
  [[nodiscard]] std::uint64_t firings() const { return firings_; }
  /// For a start that was heard and whose recording is not given; empty: none.
  [[nodiscard]] const std::string& unknown_peer() const { return unknown_peer_; }

 private:
  static constexpr StartId not_given{UINT32_MAX - 1};  ///< a start whose recording is not given
  [[nodiscard]] static bool is_given(StartId start) { return start < not_given; }
  /// The numbers that one start of the receiver has read from one start of the sender.
  struct Read {
    StartId start{};
    std::uint32_t first = 0, ended = 0;
  };
  /// One side of a channel between processes, in one start of its process.
  struct Sending {
    bool known = true;                            ///< false: `written` is not known
    std::uint32_t written = 0, acknowledged = 0;  ///< the last numbers; 0: none
    StartId peer{};                               ///< the start that acknowledges
    std::uint64_t peer_incarnation = 0;
    std::vector<Read> reads{};  ///< of the starts of the receiver, in their order
  };
  struct Receiving {
    bool known = true;       ///< false: `last` is not known
    std::uint32_t last = 0;  ///< the number that was last read of this peer; 0: none
    StartId peer{};
    std::uint64_t peer_incarnation = 0;
  };
  struct Version {
    std::uint32_t last = 0;
    enum : std::uint8_t { unknown, guessed, known } is = known;
    [[nodiscard]] std::uint32_t due() const { return last == UINT32_MAX ? 1 : last + 1; }
  };
  struct Link {
    std::uint64_t initial = 0, markings = 0;  ///< sets: one bit per marking
    bool tracked = false;
    bool fixed_peers = false;          ///< both processes start once, in one run
    std::vector<Sending> sending;      ///< per start of the sending process, in their order
    std::vector<Receiving> receiving;  ///< per start of the receiving process
  };

  [[nodiscard]] Sending& sending(net::ChannelId channel, StartId start);
  [[nodiscard]] const Sending& sending(net::ChannelId channel, StartId start) const;
  [[nodiscard]] Receiving& receiving(net::ChannelId channel, StartId start);
  [[nodiscard]] const Receiving& receiving(net::ChannelId channel, StartId start) const;
  [[nodiscard]] Obstacle token_obstacle(const Firing& firing) const;
  [[nodiscard]] Obstacle version_obstacle(const Firing& firing) const;
  [[nodiscard]] Obstacle number_obstacle(const Firing& firing) const;
  [[nodiscard]] Obstacle read_obstacle(const Firing& firing, bool exchange) const;
  [[nodiscard]] Obstacle acknowledgement_obstacle(const Firing& firing) const;
  [[nodiscard]] bool was_left_behind(net::ChannelId channel, const Firing& firing,
                                     const Receiving& side) const;
  [[nodiscard]] bool is_read_later(const Firing& firing, const Sending& side) const;
  [[nodiscard]] Read* read_by(const Firing& firing);
  void stop_tracking(const Firing& firing);
  void count(const Firing& firing);
  [[nodiscard]] bool move_markings(const Firing& firing);
  [[nodiscard]] static std::uint64_t moved(std::uint64_t markings, std::span<const DeployedNet::Move> moves);
  [[nodiscard]] std::uint64_t reachable(net::ChannelId channel) const;
  [[nodiscard]] bool is_of(net::PlaceId place, StartId start) const;
  [[nodiscard]] bool is_within(net::ChannelId channel, StartId start) const;
  [[nodiscard]] std::optional<Problem> read_marking(std::string_view text, net::Marking& marking);
  void forget(net::ChannelId channel, StartId start);
  [[nodiscard]] std::uint64_t with_medium(net::ChannelId channel, std::uint64_t markings) const;
  [[nodiscard]] StartId find_start(ProcessId process, std::uint64_t incarnation) const;
  [[nodiscard]] bool turn(Sending& side, StartId peer, std::uint64_t incarnation) const;
  [[nodiscard]] bool turn(net::ChannelId channel, StartId start, StartId peer, std::uint64_t incarnation);
  void link_up(net::ChannelId id, bool one_run);

  const DeployedNet& net_;
  Numbered<StartId, Start> starts_;
  Numbered<StartId, bool> assumed_;            // what is not recorded of it is assumed
  Numbered<StartId, std::uint32_t> ordinals_;  // which of its process
  Numbered<ProcessId, std::vector<StartId>> of_process_;
  net::Marking marking_, after_start_;
  std::vector<Version> versions_;                               // per channel within a process
  std::vector<Link> links_;                                     // per channel
  std::unordered_map<std::string_view, std::uint32_t> places_;  // by name; empty: not needed yet
  std::uint64_t firings_ = 0;
  std::string unknown_peer_;
};

}  // namespace tessera::replay
