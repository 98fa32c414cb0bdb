#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tessera/result.hpp"
#include "tessera/time.hpp"
#include "tessera/transition_role.hpp"

namespace tessera {

/// The classes of faults in a recording.
enum class Fault : std::uint8_t {
  net = 1,         ///< the net cannot go on: no condition of `next` holds, or an error has no entry of `next`
  assertion = 2,   ///< Context::assert_that
  exception = 3,   ///< user code or a condition has thrown
  not_finite = 4,  ///< an output is infinite or not a number
  device = 5,      ///< a real receptor or effector has thrown or refused
  stale = 6,       ///< an input of an effector is too old, or its source has ended or does not respond
  stall = 7,       ///< a transition function takes longer than its watchdog
  overrun = 8,     ///< the subsystem's own work made it miss instants, and Overrun::fault forbids that
  limit = 9,       ///< a command is beyond the limits of its real effector, and `Limits::fault` is set
  crash = 10,      ///< the process has died, or called exit, in the subsystem
  overtime = 11    ///< a call took longer than `takes`, or a thread went on later than `latency`
};
/// The version of a fault event is its class, with this bit if the fault is only told: nothing fails because of it.
inline constexpr std::uint32_t told_fault = 1U << 8U;
/// The changes of the safe command of a device.
enum class SafeEvent : std::uint8_t {
  given = 1,   ///< the device has taken it, for a new reason
  ended = 2,   ///< commands of the subsystem go to the device again
  refused = 3  ///< the device has not taken it; the runtime tries again
};
/// "not finite"; empty: this version does not know the fault.
[[nodiscard]] std::string_view name_of(Fault fault);

/// The name of a recording in a folder.
inline constexpr const char* recording_file_name = "recording.tsr";
/// The first bytes of a recording. The digit is the version of the format.
inline constexpr std::string_view recording_magic = "TESSREC1";
inline constexpr std::uint32_t longest_recording_header = 1U << 28U;

/// Replaces the index of a subsystem in events of the layers above the subsystems.
inline constexpr std::uint32_t system_instance = 0xffffff;

/// The file that a run leaves: these 8 bytes, a little-endian uint32 length, that many bytes of JSON
///
///     {"system", "net_hash", "verification_hash", "verdicts", "seed", "clock", "instances": [path...],
///      "channels": [name...], "transitions": [[name, instance, step, behaviour, channel]...],
///      "parameters": [[path, value]...],
///      "behaviours": [[name...]...] per instance,
///      "values": {"limit": bytes, "buffers": [[path, instance, direction, type]...]}, those of memory last,
///      "process": {"name", "number", "incarnation": decimal}, "processes": [name...], "networked": [channel...],
///      "scene": {"hash", "bodies": [[name, agent, parent]...], "eyes": [[body, x, y, z, footprint]...]}}
///
/// For a transition, "step" is a name of a Step, "behaviour" a name and "channel" an index into "channels".
/// An absent value is left out at the end, or "".
///
/// "process" belongs to a run of one process of a deployed system; its recording has the firings of its own
/// agents and none of the system's. "processes" and "networked", the channels between processes, belong to
/// every run of a deployed system. Padding follows to a multiple of 8, then events of 24 bytes, the last of
/// which is `end`.
///
/// A recording without `end` was cut off, because the controller was killed or the disk was full; only its
/// tail is lost. If the run's clock is simulated, the file does not depend on the wall clock. A recording
/// with a limit continues in segments: each segment is a file with "segment": number in its header, and its
/// first event is `marking`.
struct Event {
  enum class Kind : std::uint8_t {
    /// subject: transition; version: that of the channel it touched (0: none). For a channel between
    /// processes, version is the low 32 bits of the number of a value (docs/use/fleets.md): for a sender, the
    /// value that it has written last, or writes; for a receiver, the value that it reads; 0: none.
    firing = 1,
    log = 2,      ///< subject: bytes of text, which follow in whole events' worth of space; version: level
    stop = 3,     ///< like log: why the run ended
    fault = 4,    ///< like log: "PLACE: what, and what was done about it"; version: the Fault, and told_fault
    overrun = 5,  ///< subject: how many instants of its rate the subsystem missed by its own work
    call = 6,     ///< a transition function begins; subject: behaviour; version: iteration
    value = 7,    ///< like log: the present value of a buffer; version: buffer + 2^24 * flags
    /// Like log: the places that hold a token where a segment begins, one per line; version: 1: not known.
    /// Not counted in `sequence`.
    marking = 8,
    safe = 9,  ///< like log: "DEVICE: what", about the safe command of a real effector; version: SafeEvent
    parameter = 10,  ///< like log: "PATH=VALUE": a subsystem has taken a new value of a parameter
    /// Like log: a frame of the poses of the bodies of the world (tessera/poses.hpp). Only with "scene". Not
    /// counted in `sequence`.
    poses = 11,
    /// Like log: "CHANNEL\nINCARNATION": the start of the process at the other end of a channel that the
    /// instance works with from now on. A receiver writes it before it reads a value of that start; a sender,
    /// before it learns that the other has taken a value.
    peer = 12,
    /// Like log: "NAME\nINCARNATION": under the simulated clock, a process of the deployment begins again
    /// (version 1) with this incarnation, or has died (version 0). Its places then hold their initial tokens.
    /// The incarnation of a first start is 1.
    process = 14,
    /// The last event of a file. subject: how many events of the run are lost; version: 1: the next segment
    /// follows. Not counted in `sequence`, and not among the entries of a Recording.
    end = 15
  };
  std::int64_t time_ns = 0;
  std::uint32_t subject = 0;
  std::uint32_t version = 0;
  std::uint32_t sequence = 0;  ///< per instance, from 0; gaps are lost events
  std::uint32_t origin = 0;    ///< instance (or system_instance) * 256 + kind

  [[nodiscard]] Kind kind() const { return static_cast<Kind>(origin & 0xffU); }
  [[nodiscard]] bool has_text() const {
    return kind() != Kind::firing && kind() != Kind::overrun && kind() != Kind::call && kind() != Kind::end;
  }
  /// The number of events whose space the text takes.
  [[nodiscard]] std::uint64_t pieces() const { return has_text() ? (std::uint64_t{subject} + 23) / 24 : 0; }
  [[nodiscard]] std::uint32_t instance() const { return origin >> 8; }
  /// Precondition: it is a fault.
  [[nodiscard]] Fault fault() const { return static_cast<Fault>(version & (told_fault - 1)); }
  /// Whether it is a fault because of which nothing fails.
  [[nodiscard]] bool is_told_fault() const { return kind() == Kind::fault && (version & told_fault) != 0; }
};
static_assert(sizeof(Event) == 24);
/// "firing"; empty: this version does not know the kind.
[[nodiscard]] std::string_view name_of(Event::Kind kind);

/// The flags of a value event. The event is written when a value is read into an input (a real input: only if
/// the value differs from the last), and when a transition function has changed an output or a field of the
/// memory.
struct ValueFlags {
  static constexpr std::uint32_t same = 1,  ///< as at the last event of this buffer; no bytes
      hashed = 2,    ///< more than "limit" bytes: their number and a hash, a uint64 each, replace them
      stamped = 4,   ///< input: an int64 before the bytes says when the sender wrote the value
      valid = 8,     ///< input: as in Arrival
      fresh = 16,    ///< input: newer than all before
      silent = 32,   ///< real input: the device has no value, until the next event of the buffer; no bytes
      failed = 64,   ///< real input: the device has thrown; no bytes
      queued = 128;  ///< real input out of a bag: it is read before any later value
};

/// A decoded value event of a buffer.
struct ValueEvent {
  std::uint32_t buffer = 0;
  std::uint32_t flags = 0;
  std::int64_t stamp_ns = 0;
  std::string_view
      bytes;  ///< as tessera/value_encoding.hpp describes; of a hashed value, its number of bytes and hash
  [[nodiscard]] bool has(std::uint32_t flag) const { return (flags & flag) != 0; }
};

/// A recording that has been read.
struct Recording {
  struct Transition {
    std::string name;        ///< full path
    std::uint32_t instance;  ///< or system_instance
    TransitionRole role{};
  };
  struct Entry {
    Event event;
    std::string text;  ///< of log, stop, fault, safe and parameter; the bytes of a value
  };
  enum class Direction : std::uint8_t { input, output, real_input, real_output, memory };
  /// A field of the memory is listed like a buffer, after all buffers.
  struct Buffer {
    std::string path;  ///< "robot.control.motion", "robot.control.memory.count"
    std::uint32_t instance;
    Direction direction;
    std::string type;  ///< as tessera/value_encoding.hpp describes; empty: its values cannot be recorded
  };
  std::string header;  ///< the JSON
  std::string system, net_hash, verification_hash, clock;
  std::uint64_t seed = 0;
  std::vector<std::string> instances;
  std::vector<std::string> channels;
  std::vector<Transition> transitions;
  std::vector<std::vector<std::string>> behaviours;             ///< per instance
  std::vector<std::pair<std::string, std::string>> parameters;  ///< given to the run
  std::vector<std::string> injected;                            ///< planted faults, as `--inject`
  std::optional<std::int64_t> duration_ns;                      ///< given to the run
  /// One process of a deployed system.
  struct OneProcess {
    std::string name;
    std::uint32_t number;  ///< into processes
    std::uint64_t incarnation;
  };
  std::optional<OneProcess> process;   ///< nullopt: all that is recorded ran in one process
  std::vector<std::string> processes;  ///< of the deployment; empty: there is none
  std::vector<std::string> networked;  ///< channels between processes
  /// The simulated world.
  struct Scene {
    struct Body {
      std::string name;                     ///< as in the scene
      std::string agent;                    ///< the agent that owns it; empty: none
      std::optional<std::size_t> parent{};  ///< the body that it is attached to; nullopt: none of these
    };
    /// A light sensor: the point at which it looks, in the frame of a body.
    struct Eye {
      std::size_t body = 0;  ///< of bodies
      double x_m = 0, y_m = 0, z_m = 0, footprint_m = 0;
    };
    std::string hash;          ///< of the scene, which stands beside the recording as HASH.glb
    std::vector<Body> bodies;  ///< those whose poses are recorded
    std::vector<Eye> eyes;
  };
  std::optional<Scene> scene;     ///< nullopt: recorded without poses
  std::vector<Buffer> buffers;    ///< empty: recorded without values
  std::uint64_t value_limit = 0;  ///< larger values are hashed
  /// The number of this segment in a recording with a limit, from 0. If several segments were read together:
  /// that of the first.
  std::optional<std::uint64_t> segment;
  std::vector<Entry> entries;
  bool truncated = false;  ///< the end is missing: the recording was cut off, or is still being written
  std::uint64_t lost = 0;  ///< events that are missing within the file, as `end` says
};

/// Whether the text can be the hash of a scene, and so a part of a file name: 16 hexadecimal digits.
[[nodiscard]] bool is_scene_hash(std::string_view text);
/// The file of a scene beside a recording.
[[nodiscard]] std::string scene_file(const std::string& recording, const std::string& hash);

/// "in", "out", "real_in", "real_out", "memory".
[[nodiscard]] std::string_view name_of(Recording::Direction direction);
/// Precondition: the entry is a value that the reader has found complete.
[[nodiscard]] ValueEvent value_of(const Recording::Entry& entry);

/// Reads a recording piece by piece, even while it is still being written.
class RecordingReader {
 public:
  /// Takes the next bytes of the file. Entries come into `recording` as soon as they are complete.
  void feed(std::string_view bytes);
  /// Whether the header has been read. Before that, `recording` is empty.
  [[nodiscard]] bool has_header() const { return has_header_; }
  /// Why no more entries will come: "is no recording of Tessera", "is damaged"; nullopt: more may come.
  [[nodiscard]] const std::optional<Problem>& problem() const { return problem_; }
  /// Whether the last event of the file has been read.
  [[nodiscard]] bool has_ended() const { return has_ended_; }
  /// Bytes of an entry, or of the header, that is not complete yet.
  [[nodiscard]] std::size_t pending() const { return pending_.size(); }
  /// The entries read so far. A reader of a long recording removes them as they come.
  [[nodiscard]] Recording& recording() { return recording_; }

 private:
  enum class State : std::uint8_t { header, events, damaged };
  [[nodiscard]] std::size_t take_header(std::string_view bytes);
  [[nodiscard]] std::size_t take_events(std::string_view bytes);
  void give_up(std::string problem);
  State state_ = State::header;
  bool has_header_ = false, has_ended_ = false;
  std::string pending_;
  std::optional<Problem> problem_;
  Recording recording_;
};

/// Whether the limit of the recording has dropped its first segments.
[[nodiscard]] bool lacks_beginning(const Recording& recording);
/// "its beginning is gone: it holds what happened from 812.300 s on; ...", and how a run keeps everything. Empty:
/// it has its beginning. Precondition: the first entries that are left are among `recording.entries`.
[[nodiscard]] std::string note_on_beginning(const Recording& recording);
/// The same, of one that has lost its beginning. from_ns: time of the first entry that is left; nullopt: none is.
[[nodiscard]] std::string note_on_lost_beginning(std::optional<std::int64_t> from_ns);

/// The path of a segment that is not the newest: "run.tsr" -> "run.3.tsr".
[[nodiscard]] std::string segment_path(const std::string& path, std::uint64_t number);

/// The inverse: "run.3.tsr" -> "run.tsr"; empty: `path` names no segment.
[[nodiscard]] std::string without_segment_number(const std::string& path);

/// The number in the header of a file; nullopt: the file is no segment of a recording with a limit.
[[nodiscard]] std::optional<std::uint64_t> segment_number_in(const std::string& file);

/// How a file ends, as far as its last event tells.
enum class FileEnd : std::uint8_t {
  cut,      ///< there is no last event: the file was cut off, grows, or is no recording
  goes_on,  ///< a full segment: the next one follows
  final     ///< the run has ended
};
[[nodiscard]] FileEnd end_of(const std::string& file);

/// Reads a recording. A folder stands for the recording_file_name in it. A recording with a limit gives all
/// segments that exist before the named file, even if that file itself is missing or empty; a segment that is
/// named by its number is read alone. nullopt and `error`: it is no recording.
[[nodiscard]] std::optional<Recording> read_recording(const std::string& path, std::string& error);

}  // namespace tessera
