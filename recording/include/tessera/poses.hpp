#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/time.hpp"

/// The format of the poses of bodies in a simulated world. There is one frame per `pose_period` in which a
/// body has moved, and at least once per `whole_pose_period` a *whole* frame, which does not depend on
/// earlier frames. So a reader can begin anywhere, and a lost frame affects at most one second.
///
/// A pose is x, y, z in steps of 0.1 mm and the unit quaternion w + i + j + k in steps of 1/8191. Every form
/// of frame stores exactly these rounded values. A frame begins with
///
///     uint8    its form: 0: differences; 1: whole
///     uint16   its number, little-endian: one more than that of the previous frame
///
/// and lists, per body in ascending order of index,
///
///     varint   bodies skipped since the previous one
///     uint8    which of x, y, z, w, i, j, k follow, in this order: bits 0 to 6
///     varint   for each of them: zigzag difference to the previous frame; in a whole frame, to 0
///
/// A varint has seven bits per byte, the lowest first. The highest bit of a byte says that more bytes follow.
namespace tessera {

inline constexpr Duration pose_period = std::chrono::milliseconds(40);
inline constexpr Duration whole_pose_period = std::chrono::seconds(1);
inline constexpr double pose_steps_per_metre = 10'000, pose_steps_per_unit = 8191;
inline constexpr std::int64_t farthest_pose_step = 1'000'000'000'000;  ///< of a position: 10^8 m

/// The pose of a body in the world.
struct BodyPose {
  std::array<double, 3> position_m{};
  std::array<double, 4> rotation{1, 0, 0, 0};  ///< unit quaternion: w, i, j, k
};

/// A pose in the steps of the recording format: x, y, z, w, i, j, k.
struct RoundedPose {
  std::array<std::int64_t, 7> steps{0, 0, 0, 8191, 0, 0, 0};
  friend bool operator==(const RoundedPose&, const RoundedPose&) = default;
};
/// Limits positions to 10^8 m. nullopt: a number of the pose is not finite.
[[nodiscard]] std::optional<RoundedPose> rounded(const BodyPose& pose);
[[nodiscard]] BodyPose pose_of(const RoundedPose& rounded);

/// Makes the frames of one stream of poses. The same poses give the same bytes, on every machine.
///
/// Threads: one at a time.
class PoseEncoder {
 public:
  explicit PoseEncoder(std::size_t bodies) : last_(bodies) {}

  /// poses: of all bodies. A body whose pose is not finite keeps its last pose. Empty: no body has moved, and
  /// no whole frame is due. The bytes are valid until the next call.
  [[nodiscard]] std::string_view encode(std::int64_t time_ns, std::span<const BodyPose> poses);
  [[nodiscard]] std::string_view encode(std::int64_t time_ns, std::span<const RoundedPose> poses);
  /// The poses of the last frame as a whole frame with the same number; empty: there is none yet.
  [[nodiscard]] std::string last_whole() const;
  /// The largest size of a frame of so many bodies.
  [[nodiscard]] static std::size_t longest_frame(std::size_t bodies);

 private:
  std::vector<RoundedPose> last_, rounded_;
  std::optional<std::int64_t> whole_ns_;  // time of the last whole frame
  std::uint16_t number_ = 0;
  std::string bytes_;
};

/// Decodes a stream of frames. It accepts any bytes.
///
/// Threads: one at a time.
class PoseDecoder {
 public:
  explicit PoseDecoder(std::size_t bodies) : poses_(bodies) {}

  /// false: the bytes are no frame of these bodies.
  bool take(std::string_view frame);
  /// Whether `poses` is right. It is not before the first whole frame, nor between a missing or damaged frame
  /// and the next whole one.
  [[nodiscard]] bool known() const { return known_; }
  [[nodiscard]] const std::vector<RoundedPose>& poses() const { return poses_; }

 private:
  [[nodiscard]] bool apply(std::string_view bytes, bool whole);
  std::vector<RoundedPose> poses_;
  std::optional<std::uint16_t> number_;  // of the last frame
  bool known_ = false;
};

}  // namespace tessera
