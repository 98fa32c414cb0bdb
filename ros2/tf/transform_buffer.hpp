#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ros2/tf/tf_message.hpp"
#include "ros2/tf/transform.hpp"

namespace tessera::ros2 {

/// The tree of frames of the last ten seconds, as tf2 keeps it: each frame has a parent, and its pose in the parent
/// at some stamps, or for all times (`fixed`). Two stamps are ten seconds apart by themselves, whatever the clock of
/// this machine says.
///
/// Threads: one at a time.
class TransformBuffer {
 public:
  static constexpr std::int64_t kept_ns = 10'000'000'000;

  enum class Refusal : std::uint8_t {
    none,
    no_name,     ///< of the frame or its parent
    own_parent,  ///< a frame in itself
    not_finite,  ///< a number that is none
    not_unit,    ///< a rotation that is no unit quaternion
    bad_stamp,   ///< a time that does not exist
    too_many     ///< more frames than anything real has
  };
  /// Something odd about a transform that was taken.
  enum class Oddity : std::uint8_t {
    none,
    went_back,       ///< time has jumped back: everything that is not fixed was forgotten before
    two_parents,     ///< the frame has two parents in turn
    two_publishers,  ///< two publishers give its pose in turn
    moves_and_not    ///< the frame was fixed, and is not now, or the reverse
  };
  struct Taken {
    Refusal refusal = Refusal::none;
    Oddity oddity = Oddity::none;
    std::string other{};       ///< two_parents: the other one
    std::int64_t back_ns = 0;  ///< went_back: how far
  };
  /// publisher: any number that it alone has. A slash before the name of a frame is left out, as tf2 does.
  Taken take(const StampedTransform& one, bool fixed, std::uint64_t publisher);

  struct Answer {
    enum class Outcome : std::uint8_t {
      found,
      unknown_frame,   ///< `frames` is its name
      unconnected,     ///< `frames` are the roots of both
      loop,            ///< `frames` are those of the loop
      no_common_time,  ///< `frames` has the one that is not known at that time
    };
    Outcome outcome = Outcome::found;
    Transform transform{};
    std::int64_t stamp_ns = 0;  ///< since the epoch of the stamps; 0 if it is fixed
    bool fixed = false;         ///< it holds at all times
    std::vector<std::string> frames{};
  };
  /// The pose of a frame in another one at the newest time at which all frames between them are known.
  [[nodiscard]] Answer latest(std::string_view frame, std::string_view in) const;
  /// The same at any time. Between two stamps it is interpolated; before the first and after the last one there is
  /// none.
  [[nodiscard]] Answer at(std::string_view frame, std::string_view in, std::int64_t stamp_ns) const;

  [[nodiscard]] bool is_empty() const { return all_.empty(); }
  /// All frames, by name.
  [[nodiscard]] std::vector<std::string> frames() const;
  /// How often something that is fixed has changed; and how often time has jumped back.
  [[nodiscard]] std::uint64_t fixed_changes() const { return fixed_changes_; }
  [[nodiscard]] std::uint64_t jumps() const { return jumps_; }

 private:
  using Id = std::size_t;
  struct Sample {
    std::int64_t stamp_ns = 0;
    Id parent = 0;
    Transform transform{};
  };
  struct Frame {
    std::string name;
    bool fixed = false;
    std::deque<Sample> samples{};  ///< the oldest first; fixed: one
    std::size_t late = 0;          ///< samples in a row that were much older than the newest one
    std::uint64_t publisher = 0;   ///< of the newest one
    std::size_t turns = 0;         ///< changes of parent or publisher since `turns_began_ns`
    std::int64_t turns_began_ns = 0;
  };
  /// The frames above one, with the sample that leads to the next; the last one has none.
  struct Ascent {
    std::vector<std::pair<Id, Sample>> steps{};
    Id root = 0;
    std::optional<Id> cut{};  ///< the frame that is not known at that time, where the ascent ends
    bool loops = false;
  };
  using SampleOf = std::function<std::optional<Sample>(const Frame&)>;

  [[nodiscard]] std::optional<Id> find(std::string_view name) const;
  [[nodiscard]] std::optional<Id> add(std::string_view name);
  [[nodiscard]] static Oddity note_turn(Frame& frame, const Sample& sample, std::uint64_t publisher);
  Taken take_fixed(Frame& frame, const Sample& sample);
  Taken take_moving(Id id, const Sample& sample, std::uint64_t publisher);
  void forget_moving();
  [[nodiscard]] static std::optional<Sample> sample_at(const Frame& frame, std::int64_t stamp_ns);
  [[nodiscard]] Ascent ascend(Id from, const SampleOf& sample_of) const;
  /// Both ascents, without what they have in common; or why there is no way.
  struct Way {
    Answer answer{};
    std::vector<std::pair<Id, Sample>> up{}, down{};
  };
  [[nodiscard]] Way way(std::string_view frame, std::string_view in, const SampleOf& sample_of) const;
  [[nodiscard]] std::vector<std::string> loop_in(const Ascent& ascent) const;

  std::map<std::string, Id, std::less<>> ids_;
  std::vector<Frame> all_;
  std::uint64_t fixed_changes_ = 0, jumps_ = 0;
};

}  // namespace tessera::ros2
